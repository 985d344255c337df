"""The web console's servers: the page with its WebSocket, and the line that stops; each a thread with its own loop."""

from __future__ import annotations

import asyncio
import gzip
import hashlib
import json
import logging
import socket
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import parse_qs

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from chatrobot.core.errors import ChatRobotError
from chatrobot.core.process import wake_promptly
from chatrobot.web.access import Access, Pass, Refusal, address_of
from chatrobot.web.class_recordings import recording_routes
from chatrobot.web.classroom import Classroom, serve_teacher
from chatrobot.web.connection import Page, serve_room
from chatrobot.web.limits import AbortableWebSocket, LimitedProtocol, is_news
from chatrobot.web.protocol import MOST_BYTES
from chatrobot.web.room import Room
from chatrobot.web.steering import Watchdog
from chatrobot.web.stop_line import StopLine

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".webmanifest": "application/manifest+json",
}
"""What a page is made of; files of other kinds are not served."""
_MOST_ENTER_BYTES = 4096
SWITCH_S = 0.0005
"""A stop takes its turns of the interpreter from whatever computes in this process: Python's own 5 ms, three or four
times, would be the most of it."""
_START_S, _END_S = 10.0, 3.0


@dataclass(frozen=True)
class PageFile:
    """One file of the page, as it is sent."""

    body: bytes
    packed: bytes
    media_type: str
    tag: str


def page_files() -> Mapping[str, PageFile]:
    """Read all files of the page: nothing else is ever served, whatever a path says."""
    found: dict[str, PageFile] = {}
    folders = [("", resources.files("chatrobot.web") / "page")]
    while folders:
        prefix, folder = folders.pop()
        for entry in folder.iterdir():
            media_type = TYPES.get(PurePosixPath(entry.name).suffix)
            if entry.is_dir():
                folders.append((f"{prefix}{entry.name}/", entry))
            elif media_type is not None:
                body = entry.read_bytes()
                tag = f'"{hashlib.sha256(body).hexdigest()[:16]}"'
                found[f"/{prefix}{entry.name}"] = PageFile(
                    body, gzip.compress(body, mtime=0), media_type, tag
                )
    return {"/": found["/index.html"], "/teacher": found["/teacher.html"], **found}


class WebServer:
    """Serves rooms to pages. `start` it, `close` it.

    Args:
        access: who may come in.
        rooms: the robots by their names; one of the name "" is that of whoever names none.
        certificate: files of certificate and key, for TLS.
        classroom: where the rooms are those of a class.
    """

    def __init__(
        self,
        access: Access,
        rooms: Mapping[str, Room],
        certificate: tuple[str, str] | None = None,
        classroom: Classroom | None = None,
    ) -> None:
        self.access = access
        self._classroom = classroom
        self.rooms = rooms
        self._certificate = certificate
        self._files = page_files()
        self._threads: list[_ServerThread] = []
        self._watchdog = Watchdog(lambda: [room.steering for room in rooms.values()])

    def start(self, page_socket: socket.socket, stop_socket: socket.socket) -> None:
        """Serve on these, which listen already."""
        sys.setswitchinterval(SWITCH_S)
        access = self.access
        access.port, access.stop_port = page_socket.getsockname()[1], stop_socket.getsockname()[1]
        for room in self.rooms.values():
            room.stop_port = access.stop_port
        if self._classroom is not None:
            self._classroom.stop_port = access.stop_port
        page = _ServerThread("web", _Gate(access, self._application()), page_socket, self._certificate)
        stop = _ServerThread(
            "stop line", StopLine(access, self._find_stopped), stop_socket, self._certificate
        )
        self._threads = [stop, page]
        for thread in self._threads:
            thread.start()
        self._watchdog.start()

    def close(self, *, stops: bool = True) -> None:
        """Stop the robots, unless somebody else sees to them; tell the pages, and end."""
        for room in self.rooms.values():
            room.end(stops=stops)
        time.sleep(0.05)  # the pages are told
        for thread in self._threads:
            thread.server.should_exit = True  # each takes a moment to see it
        for thread in reversed(self._threads):
            thread.stop()
        self._watchdog.stop()

    def find_room(self, pass_: Pass, scope: Scope) -> Room | None:
        """Return the room of a pass; one for all rooms says which it means."""
        query = parse_qs(scope["query_string"].decode("latin-1"))
        return self.rooms.get(pass_.room or query.get("room", [""])[0])

    def _find_stopped(self, pass_: Pass, scope: Scope) -> Room | Classroom | None:
        """Return what a stop is for: a room, or all of them where a teacher names none."""
        room = self.find_room(pass_, scope)
        return room if room is not None or pass_.role != "teacher" else self._classroom

    def _application(self) -> ASGIApp:
        classroom = self._classroom
        return Starlette(
            routes=[
                Route("/me", self._me),
                Route("/enter", self._enter, methods=["POST"]),
                WebSocketRoute("/ws", self._page),
                WebSocketRoute("/class", self._teachers_page),
                *(recording_routes(self.access, classroom.recordings) if classroom is not None else ()),
                Route("/{path:path}", self._file),
            ]
        )

    async def _file(self, request: Request) -> Response:
        file = self._files.get(request.url.path)
        if file is None:
            return Response("there is no such page\n", 404, media_type="text/plain")
        headers = {"ETag": file.tag, "Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
        if request.headers.get("if-none-match") == file.tag:
            return Response(status_code=304, headers=headers)
        if "gzip" in request.headers.get("accept-encoding", ""):
            return Response(file.packed, 200, {**headers, "Content-Encoding": "gzip"}, file.media_type)
        return Response(file.body, 200, headers, file.media_type)

    async def _me(self, request: Request) -> Response:
        """Tell a page whether it may come in, which a WebSocket could not."""
        return self._told(self.access.admit(request.scope))

    async def _enter(self, request: Request) -> Response:
        """Take the token that came in the fragment of the link, and give a cookie for it."""
        body = b""
        async for piece in request.stream():
            body += piece
            if len(body) > _MOST_ENTER_BYTES:
                return _refusal(Refusal(413, "that is too long for a token"))
        is_json = request.headers.get("content-type", "").partition(";")[0].strip() == "application/json"
        token = _token_in(body) if is_json else ""
        if not token:
            return _refusal(Refusal(400, 'say {"token": "…"} as application/json'))
        admitted = self.access.check_token(token, address_of(request.scope))
        response = self._told(admitted)
        if isinstance(admitted, Pass):
            response.headers["set-cookie"] = self.access.cookie(admitted)
        return response

    def _told(self, admitted: Pass | Refusal) -> Response:
        if isinstance(admitted, Refusal):
            return _refusal(admitted)
        return JSONResponse(
            {
                "role": admitted.role,
                "room": admitted.room,
                "seat": admitted.seat,
                "local": admitted.is_local,
            },
            headers=_UNKEPT,
        )

    async def _page(self, websocket: WebSocket) -> None:
        admitted = self.access.admit(websocket.scope)
        if isinstance(admitted, Refusal):
            await websocket.send_denial_response(_refusal(admitted))
            return
        room = self.find_room(admitted, websocket.scope)
        if room is None:
            await websocket.send_denial_response(_refusal(Refusal(404, "there is no such robot")))
            return
        await websocket.accept()
        await serve_room(websocket, room, Page(websocket, admitted)).serve()

    async def _teachers_page(self, websocket: WebSocket) -> None:
        admitted = self.access.admit(websocket.scope)
        if isinstance(admitted, Refusal):
            await websocket.send_denial_response(_refusal(admitted))
        elif self._classroom is None or admitted.role != "teacher":
            refusal = Refusal(403, "this page is the teacher's: open the link that the server printed")
            await websocket.send_denial_response(_refusal(refusal))
        else:
            await websocket.accept()
            await serve_teacher(websocket, self._classroom, Page(websocket, admitted)).serve()


_UNKEPT = {"Cache-Control": "no-store"}


def _refusal(refusal: Refusal) -> Response:
    return JSONResponse({"text": refusal.text}, refusal.status, headers=_UNKEPT)


def _token_in(body: bytes) -> str:
    try:
        data: Any = json.loads(body)
    except (ValueError, RecursionError):
        return ""
    token = data.get("token") if isinstance(data, dict) else None
    return token if isinstance(token, str) else ""


class _Gate:
    """Before everything else: is it our own page that asks? And on every answer the headers that keep it so."""

    def __init__(self, access: Access, inner: ASGIApp) -> None:
        self._access = access
        self._inner = inner

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._inner(scope, receive, send)
            return
        extra = [
            (name.lower().encode(), value.encode()) for name, value in self._access.headers(scope).items()
        ]

        async def send_guarded(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                message = {**message, "headers": [*message.get("headers", ()), *extra]}
            await send(message)

        refusal = self._access.check_place(scope, self._access.port)
        if refusal is None:
            await self._inner(scope, receive, send_guarded)
        elif scope["type"] == "http":
            await _refusal(refusal)(scope, receive, send_guarded)
        else:
            await WebSocket(scope, receive, send_guarded).send_denial_response(_refusal(refusal))


class _ServerThread:
    """A server of uvicorn in a thread of its own; it hears no signals."""

    def __init__(
        self, name: str, app: Any, listening: socket.socket, certificate: tuple[str, str] | None
    ) -> None:
        certfile, keyfile = certificate or (None, None)
        logger = logging.getLogger("uvicorn.error")
        logger.setLevel(logging.ERROR)  # what strangers send wrongly is no news
        logger.addFilter(is_news)
        config = uvicorn.Config(
            app,
            http=LimitedProtocol,
            ws=AbortableWebSocket,
            loop="asyncio",
            lifespan="off",
            log_config=None,
            access_log=False,
            proxy_headers=False,  # who stands before us may not say who asks
            server_header=False,
            date_header=False,
            ws_max_size=MOST_BYTES,
            ws_per_message_deflate=False,
            ws_ping_interval=5.0,
            ws_ping_timeout=10.0,
            timeout_graceful_shutdown=1,
            ssl_certfile=certfile,
            ssl_keyfile=keyfile,
        )
        self.server = uvicorn.Server(config)
        self._socket = listening
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self.loop: asyncio.AbstractEventLoop = asyncio.new_event_loop()

    def start(self) -> None:
        """Begin, and wait until it serves.

        Raises:
            ChatRobotError: it does not.
        """
        self._thread.start()
        ends_s = time.monotonic() + _START_S
        while not self.server.started:
            if not self._thread.is_alive() or time.monotonic() > ends_s:
                raise ChatRobotError(f"the server of the {self._thread.name} does not start")
            time.sleep(0.005)

    def stop(self) -> None:
        """End it, and wait for that."""
        self.server.should_exit = True
        self._thread.join(_END_S)

    def _run(self) -> None:
        wake_promptly()
        asyncio.set_event_loop(self.loop)
        try:
            self.loop.run_until_complete(self.server.serve([self._socket]))
        finally:
            self.loop.close()
