"""`chatrobot mcp` in a process of its own, the SDK's own client before it, and an ear on the robot's wire behind it."""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import anyio
import httpx2
from mcp import Client
from mcp.client.stdio import StdioServerParameters, stdio_client
from mcp.client.streamable_http import streamable_http_client
from mcp_types import CallToolResult

from chatrobot.core.errors import WireError
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import Text, TwistMessage
from tests.processes import Heard, TalkingProcess

T = TypeVar("T")
PATIENCE_S = 60.0


def command(folder: Path, *arguments: str) -> list[str]:
    """The command line of a server with folders of its own; in an empty world, unless `arguments` choose one."""
    world = () if "--world" in arguments else ("--world", "empty")
    return [
        sys.executable,
        "-m",
        "chatrobot",
        "mcp",
        "--config-dir",
        str(folder / "config"),
        *world,
        *arguments,
    ]


def environment(folder: Path) -> dict[str, str]:
    """An environment in which its sockets are in that folder."""
    return {**os.environ, "XDG_RUNTIME_DIR": str(folder), "PYTHONUNBUFFERED": "1"}


@dataclass
class Wire:
    """The robot's wire, as any other process on it hears and uses it."""

    folder: Path
    velocities: Heard = field(default_factory=Heard)

    def open(self) -> None:
        """Wait for the robot, and listen."""
        self._wire = poll(self._connect)
        self._wire.subscribe("cmd_vel", TwistMessage, self.velocities)

    def say(self, text: str) -> float:
        """Say something as a person does who stands beside the robot; return when."""
        now_s = time.monotonic()
        self._wire.publish("user_input", Text(text))
        return now_s

    @property
    def has_motion(self) -> bool:
        """A Motion process still serves."""
        return any((self.folder / "chatrobot").glob("motion-*.stop"))

    def close(self) -> None:
        """Leave it."""
        self._wire.close()

    def _connect(self) -> LocalWire | None:
        path = next((self.folder / "chatrobot").glob("sim-*.wire"), None)
        with contextlib.suppress(WireError):
            return LocalWire(path) if path is not None else None
        return None


def poll(attempt: Callable[[], T | None], patience_s: float = PATIENCE_S) -> T:
    """Try until something comes of it."""
    ends_s = time.monotonic() + patience_s
    while time.monotonic() < ends_s:
        found = attempt()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError("it did not come about")


@dataclass
class Agent:
    """An agent's client of a server, and the robot's wire behind the server."""

    client: Client
    wire: Wire
    progress: list[tuple[float, float | None, str | None]] = field(default_factory=list)

    async def call(self, tool: str, **arguments: Any) -> CallToolResult:
        """Call a tool; progress is kept."""

        async def hear(progress: float, total: float | None, message: str | None) -> None:
            self.progress.append((progress, total, message))

        result = await self.client.call_tool(tool, arguments, progress_callback=hear)
        assert isinstance(result, CallToolResult)
        return result

    async def data(self, tool: str, **arguments: Any) -> dict[str, Any]:
        """Call a tool; its structured content."""
        result = await self.call(tool, **arguments)
        assert result.structured_content is not None
        return dict(result.structured_content)

    async def stands(self) -> bool:
        """The robot measures itself standing, and no velocity is sent any more."""
        await anyio.sleep(0.5)
        seen = await self.data("observe")
        now_s = time.monotonic()
        await anyio.sleep(0.3)
        return not seen["moving"] and not any(any(twist) for _, twist in self.wire.velocities.since(now_s))

    async def cancel_in_motion(self, **arguments: Any) -> float:
        """Begin to instruct, cancel once the robot moves; return when it was cancelled (monotonic)."""
        began_s = time.monotonic()
        ended = []

        async def instruct() -> None:
            ended.append(await self.call("instruct", **arguments))

        async with anyio.create_task_group() as group:
            group.start_soon(instruct)
            await anyio.to_thread.run_sync(self.wire.velocities.wait_for_motion, began_s)
            await anyio.sleep(0.3)
            cancelled_s = time.monotonic()
            group.cancel_scope.cancel()
        assert not ended, "the call ended before it was cancelled"
        return cancelled_s


def text_of(result: CallToolResult) -> str:
    """The words of a result."""
    return "\n".join(part.text for part in result.content if part.type == "text")


@contextlib.asynccontextmanager
async def over_stdio(folder: Path, *arguments: str, mode: str = "auto") -> AsyncIterator[Agent]:
    """An agent over stdio."""
    words = command(folder, *arguments)
    server = StdioServerParameters(command=words[0], args=words[1:], env=environment(folder))
    async with Client(stdio_client(server), mode=mode) as client:
        wire = Wire(folder)
        await anyio.to_thread.run_sync(wire.open)
        try:
            yield Agent(client, wire)
        finally:
            wire.close()


class HttpServer(TalkingProcess):
    """`chatrobot mcp --http`, with the address and the token that it printed."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        super().__init__(command(folder, "--http", *arguments), environment(folder), stderr=None)
        line = self.wait_for_line("MCP server: ", PATIENCE_S)
        words = line.split()
        self.url = next(word for word in words if word.startswith("http"))
        self.token = words[-1]
        self.port = int(self.url.split(":")[2].split("/")[0])

    def close(self) -> None:
        """End it."""
        self.process.terminate()
        self.process.wait(PATIENCE_S)


@contextlib.asynccontextmanager
async def over_http(
    url: str, token: str, wire: Wire, mode: str = "auto", patience_s: float = PATIENCE_S
) -> AsyncIterator[Agent]:
    """An agent over HTTP."""
    headers = {"Authorization": f"Bearer {token}"}
    async with (
        httpx2.AsyncClient(headers=headers, timeout=patience_s) as http,
        Client(streamable_http_client(url, http_client=http), mode=mode) as client,
    ):
        yield Agent(client, wire)


def json_lines(text: str) -> list[dict[str, Any]]:
    """Each line as JSON: one that is none makes this fail."""
    return [json.loads(line) for line in text.splitlines()]
