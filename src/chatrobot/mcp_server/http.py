"""Carries MCP over HTTP, guarded: nobody without the token, from a foreign page, or by a foreign name gets in."""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import ipaddress
import secrets
import socket
import time
from collections.abc import Callable, Collection, Iterator, MutableMapping
from typing import Any

import uvicorn
from mcp.server import _streamable_http_modern
from mcp.server.mcpserver import MCPServer
from mcp.server.transport_security import TransportSecuritySettings
from sse_starlette.sse import EventSourceResponse
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from chatrobot.core.errors import UsageError
from chatrobot.mcp_server.calls import Line
from chatrobot.mcp_server.tools import LINE

PATH = "/mcp"
FIRST_PORT, PORTS_TRIED = 8765, 20
MOST_GUESSES, GUESSES_S = 10, 60.0
MOST_BODY_BYTES = 1_000_000
LEAST_TOKEN_CHARS = 16
LOOPBACK = ("127.0.0.1", "localhost", "::1")
LIVES_EVERY_S = 2
"""So often a response that is not complete says that it lives: httpx2 waits 5 s unless its user says otherwise."""


def new_token() -> str:
    """Return a token that nobody guesses."""
    return secrets.token_urlsafe(24)


class Guard:
    """Lets a request through to `app` only with our token, under our own name, and from no other page.

    Args:
        names: what this machine may be called in `Host`, with or without a port; an address of numbers always may,
            for no page can be made to stand for one.
        port: what a `Host` that names one has to name.
    """

    def __init__(self, app: ASGIApp, token: str, names: Collection[str], port: int) -> None:
        self._app = app
        self._token = token.encode()
        self._names = {name.casefold() for name in names}
        self._port = port
        self._wrong: dict[str, list[float]] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            refusal = self._refusal(scope)
            if refusal is not None:
                await refusal(scope, receive, send)
            else:
                await self._serve(scope, receive, send)

    def _refusal(self, scope: Scope) -> PlainTextResponse | None:
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        if not self._is_ours(host):
            return PlainTextResponse(f"This server is not called {host[:80]!r}.", 421)
        if origin is not None and origin != f"{scope['scheme']}://{host}":
            return PlainTextResponse("Pages of other origins may not call this server.", 403)
        caller = (scope.get("client") or ("",))[0]
        if len(self._guesses(caller)) >= MOST_GUESSES:
            return PlainTextResponse("Too many wrong tokens: wait a minute.", 429)
        kind, _, given = headers.get("authorization", "").partition(" ")
        if kind.casefold() != "bearer" or not hmac.compare_digest(given.strip().encode(), self._token):
            if given:
                self._wrong.setdefault(caller, []).append(time.monotonic())
            text = "This server wants its token: Authorization: Bearer TOKEN. It was printed when it started."
            return PlainTextResponse(text, 401, {"WWW-Authenticate": "Bearer"})
        return None

    def _is_ours(self, host: str) -> bool:
        name, port = _split_host(host)
        if port not in ("", str(self._port)):
            return False
        return name in self._names or (not self._names.issubset(LOOPBACK) and _is_number(name))

    def _guesses(self, caller: str) -> list[float]:
        recent = [at_s for at_s in self._wrong.get(caller, ()) if time.monotonic() - at_s < GUESSES_S]
        if recent:
            self._wrong[caller] = recent
        else:
            self._wrong.pop(caller, None)
        return recent

    async def _serve(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve it, and notice where its client is gone before the answer is complete."""
        line = Line()
        is_answered = False

        async def watch() -> Message:
            message = await receive()
            if message["type"] == "http.disconnect" and not is_answered:
                line.hang_up()
            return message

        async def pass_on(message: MutableMapping[str, Any]) -> None:
            nonlocal is_answered
            if message["type"] == "http.response.body" and not message.get("more_body", False):
                is_answered = True
            await send(message)

        await self._app({**scope, LINE: line}, watch, pass_on)


def _split_host(host: str) -> tuple[str, str]:
    """Return the name, without the brackets of an IPv6 address, and the port of a `Host`."""
    if host.startswith("["):
        name, _, rest = host[1:].partition("]")
        return name.casefold(), rest.removeprefix(":")
    name, _, port = host.partition(":")
    return name.casefold(), port


def _is_number(name: str) -> bool:
    with contextlib.suppress(ValueError):
        ipaddress.ip_address(name)
        return True
    return False


def guarded_app(server: MCPServer[Any], token: str, host: str, port: int) -> Guard:
    """Return the guarded ASGI app of the server."""
    # The SDK waits 15 s and has no option for it; one is for the protocol of 2026, the other for that of 2025.
    _streamable_http_modern._SSE_PING_INTERVAL = LIVES_EVERY_S
    EventSourceResponse.DEFAULT_PING_INTERVAL = LIVES_EVERY_S
    checked_by_guard = TransportSecuritySettings(enable_dns_rebinding_protection=False)
    app = server.streamable_http_app(
        streamable_http_path=PATH,
        max_request_body_size=MOST_BODY_BYTES,
        transport_security=checked_by_guard,
        host=host,
    )
    names: Collection[str] = LOOPBACK
    if host not in LOOPBACK:
        machine = socket.gethostname()
        names = (*LOOPBACK, host, machine, f"{machine}.local")
    return Guard(app, token, names, port)


def listen(host: str, port: int | None) -> socket.socket:
    """Open the port, or the next free one where none was asked for.

    Raises:
        UsageError: it is taken, or there is no such address here.
    """
    ports = range(FIRST_PORT, FIRST_PORT + PORTS_TRIED) if port is None else (port,)
    for number in ports:
        try:
            return _bound(host, number)
        except OSError as error:
            problem = error.strerror or str(error)
    raise UsageError(f"cannot listen on {host}:{number}: {problem}", allowed="--port 0, or another --host")


def _bound(host: str, port: int) -> socket.socket:
    family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        for option, value in _SOON_GONE:
            listener.setsockopt(socket.IPPROTO_TCP, option, value)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        listener.bind(address)
        listener.listen(64)
    except OSError:
        listener.close()
        raise
    return listener


_SOON_GONE = (
    (socket.TCP_KEEPIDLE, 1), (socket.TCP_KEEPINTVL, 1), (socket.TCP_KEEPCNT, 2), (socket.TCP_USER_TIMEOUT, 3000),
)  # fmt: skip
"""A client whose network is gone is noticed within 3 s; connections inherit these from the listening socket."""


class _Server(uvicorn.Server):
    """Leaves signals to whoever stops the robot first."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


async def serve_http(app: ASGIApp, listener: socket.socket, is_leaving: Callable[[], bool]) -> None:
    """Serve until `is_leaving`."""
    config = uvicorn.Config(
        app, log_level="warning", access_log=False, timeout_graceful_shutdown=1, ws="none"
    )
    server = _Server(config)

    async def watch() -> None:
        while not is_leaving():
            await asyncio.sleep(0.1)
        server.should_exit = True

    watching = asyncio.create_task(watch())
    try:
        await server.serve(sockets=[listener])
    finally:
        watching.cancel()
