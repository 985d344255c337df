"""The line that stops: a server with a thread, an event loop and a port of its own, which do nothing else.

Whatever the page's own server is busy with, a word here is out before it is answered.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Protocol

from starlette.types import Receive, Scope, Send

from chatrobot.core.errors import LinkError
from chatrobot.web.access import EMERGENCY_BUTTON, STOP_BUTTON, Access, Pass


class Stopped(Protocol):
    """What is stopped: a room, or all of a class."""

    def stop(self, why: str) -> None:
        """Stop now."""

    def emergency_stop(self, why: str) -> None:
        """Stop now, and stay stopped until it is released."""


FindStopped = Callable[[Pass, Scope], "Stopped | None"]
_UNSUPPORTED, _POLICY = 1003, 1008


class StopLine:
    """An ASGI application with one WebSocket, `/stop`. Anybody who may see a robot may stop it.

    Args:
        find_room: the room that a pass, and what it asks for, leads to.
    """

    def __init__(self, access: Access, find_room: FindStopped) -> None:
        self._access = access
        self._find_room = find_room

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one connection."""
        if scope["type"] != "websocket":
            if scope["type"] == "http":
                await send({"type": "http.response.start", "status": 404, "headers": []})
                await send({"type": "http.response.body", "body": b""})
            return
        await receive()
        room = self._admit(scope)
        if room is None:
            await send({"type": "websocket.close", "code": _POLICY})
            return
        await send({"type": "websocket.accept"})
        pass_: Pass = scope["pass"]
        while (received := await receive())["type"] == "websocket.receive":
            text = received.get("text")
            if text is None or not self._access.is_valid(pass_):
                await send({"type": "websocket.close", "code": _UNSUPPORTED if text is None else _POLICY})
                return
            await send({"type": "websocket.send", "text": json.dumps(_obey(room, pass_, text))})

    def _admit(self, scope: Scope) -> Stopped | None:
        if scope["path"] != "/stop" or self._access.check_place(scope, self._access.stop_port) is not None:
            return None
        admitted = self._access.admit(scope)
        if not isinstance(admitted, Pass):
            return None
        scope["pass"] = admitted
        return self._find_room(admitted, scope)


def _obey(room: Stopped, pass_: Pass, text: str) -> dict[str, Any]:
    """Stop, if that is what `text` says; the answer."""
    try:
        said = json.loads(text)
        do = said.get("do") if isinstance(said, dict) else None
    except (ValueError, RecursionError):
        do = None
    try:
        if do == "stop":
            room.stop(pass_.pressed(STOP_BUTTON))
        elif do == "emergency_stop":
            room.emergency_stop(pass_.pressed(EMERGENCY_BUTTON))
        else:
            return {"is": "refused", "why": "malformed", "text": "this line hears stop and emergency_stop"}
    except LinkError as error:
        return {"is": "gone", "what": "motion", "text": str(error)}
    return {"is": "stopped", "do": do}
