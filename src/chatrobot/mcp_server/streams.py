"""Carries MCP over standard input and output, and over a Unix socket: a message a line.

Lines are read by a thread of their own, so that a client that is gone is noticed while anything else is done, and an
end need not wait for a read. While stdio is served, whatever else writes to standard output lands on standard error.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import threading
import time
from collections.abc import AsyncIterator, Callable
from typing import Any, cast

from mcp.server.mcpserver import MCPServer
from mcp.server.stdio import stdio_server

STDIN, STDOUT, STDERR = 0, 1, 2
READ_BYTES = 65_536
POLL_S = 0.01
ANSWER_S = 1.0
"""By then a call whose motion is stopped has told its agent so."""
MOST_LINE_BYTES = 4_000_000
"""As much as the SDK takes in one HTTP request; a longer line is dropped."""

_PARSE_ERROR = (
    '{"jsonrpc":"2.0","id":null,"error":{"code":-32700,"message":"Parse error: no JSON in this line"}}\n'
)
"""JSON-RPC 2.0, section 5.1."""


class LineSplitter:
    """Cuts what is read into lines; one without an end takes no more memory than `MOST_LINE_BYTES`."""

    def __init__(self) -> None:
        self._held = bytearray()
        self._is_too_long = False

    def take(self, data: bytes) -> list[str]:
        """Return the lines that are complete with `data`."""
        *complete, rest = data.split(b"\n")
        lines = []
        for part in complete:
            self._hold(part)
            if not self._is_too_long:
                lines.append(self._held.decode("utf-8", errors="replace"))
            self._held.clear()
            self._is_too_long = False
        self._hold(rest)
        return lines

    def _hold(self, part: bytes) -> None:
        self._is_too_long = self._is_too_long or len(self._held) + len(part) > MOST_LINE_BYTES
        if self._is_too_long:
            self._held.clear()
        else:
            self._held += part


class LineStream:
    """Lines of one client, both ways, on two descriptors. Make it where the loop runs.

    Args:
        on_end: called by the reading thread the moment the client is gone.
    """

    def __init__(self, read_fd: int, write_fd: int, on_end: Callable[[], None]) -> None:
        self._read_fd, self._write_fd = read_fd, write_fd
        self._on_end = on_end
        self._loop = asyncio.get_running_loop()
        self._lines: asyncio.Queue[str | None] = asyncio.Queue(maxsize=64)
        self._unanswered: set[int | str] = set()
        """Ids of requests."""
        threading.Thread(target=self._read, name="mcp-client", daemon=True).start()

    async def __aiter__(self) -> AsyncIterator[str]:
        """Yield each line of JSON, until the client is gone; any other is answered at once."""
        while (line := await self._lines.get()) is not None:
            try:
                message = json.loads(line)
            except (ValueError, RecursionError):
                if line.strip():
                    await self.write(_PARSE_ERROR)
                continue
            if isinstance(message, dict):
                self._note(message)
            yield line

    def _note(self, message: dict[str, Any]) -> None:
        """Keep the id of a request until it is answered; one that is cancelled is not."""
        asked, params = message.get("id"), message.get("params")
        if message.get("method") == "notifications/cancelled" and isinstance(params, dict):
            self._unanswered = {one for one in self._unanswered if one != params.get("requestId")}
        elif "method" in message and isinstance(asked, (int, str)):
            self._unanswered.add(asked)

    async def write(self, text: str) -> None:
        """Write all of `text`; a client that is gone is noticed by who reads."""
        writing = asyncio.get_running_loop().run_in_executor(None, self._write, text.encode())
        await asyncio.shield(writing)
        message = json.loads(text)
        if "method" not in message:
            self._unanswered.discard(message["id"])

    async def answered(self, within_s: float) -> None:
        """Wait until each request has its answer, but no longer than that: whoever ends a server lets it answer."""
        ends_s = time.monotonic() + within_s
        while self._unanswered and time.monotonic() < ends_s:
            await asyncio.sleep(POLL_S)

    async def flush(self) -> None:
        """Nothing is held back."""

    def _write(self, data: bytes) -> None:
        with contextlib.suppress(OSError):
            left = memoryview(data)
            while left:
                left = left[os.write(self._write_fd, left) :]

    def _read(self) -> None:
        splitter = LineSplitter()
        with contextlib.suppress(OSError, RuntimeError):  # RuntimeError: the loop has ended before the client
            while data := os.read(self._read_fd, READ_BYTES):
                for line in splitter.take(data):
                    self._hand_on(line)
        self._on_end()
        with contextlib.suppress(RuntimeError):
            self._hand_on(None)

    def _hand_on(self, line: str | None) -> None:
        putting = self._lines.put(line)
        try:
            handed_on = asyncio.run_coroutine_threadsafe(putting, self._loop)
        except (
            RuntimeError
        ):  # the loop has ended: nobody waits for the coroutine, and Python would warn of it
            putting.close()
            raise
        handed_on.result()


@contextlib.contextmanager
def private_stdio() -> Any:
    """Give the wire's two ends; within it nobody else reads standard input or writes to standard output."""
    read_fd, write_fd = os.dup(STDIN), os.dup(STDOUT)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, STDIN)
    os.dup2(STDERR, STDOUT)
    os.close(nothing)
    try:
        yield read_fd, write_fd
    finally:
        os.dup2(read_fd, STDIN)
        os.dup2(write_fd, STDOUT)


async def serve_lines(server: MCPServer[Any], lines: LineStream) -> None:
    """Serve one client until it is gone; its calls are then cancelled."""
    inner = server._lowlevel_server  # the SDK has no public way to serve given streams
    as_file = cast(Any, lines)
    async with stdio_server(as_file, as_file) as (incoming, outgoing):
        await inner.run(incoming, outgoing, inner.create_initialization_options())
