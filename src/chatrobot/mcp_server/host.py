"""Serves agents within another process that has the robot, on a Unix socket of this user; and the way there.

`chatrobot web` hosts: its person and the agent then share one robot, and a plan can be approved. `chatrobot mcp` looks
for such a socket, and passes its standard input and output on to it.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import os
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.compose import Connection
from chatrobot.core.events import Result
from chatrobot.core.process import wake_promptly
from chatrobot.link.motion_link import TURNS
from chatrobot.mcp_server.robot import SOURCE, AgentRobot
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.runtime_dir import agent_socket_path

if TYPE_CHECKING:
    from chatrobot.mcp_server.streams import LineStream

MOST_CLIENTS = 8
END_S = 5.0
_ENDED = "the web console has ended"


class AgentHost:
    """Serves in a thread of its own, with an event loop of its own: nothing of the host's waits for an agent.

    Args:
        robot: the agent's; it is met when the first client comes, and left with `close`.
    """

    def __init__(self, robot: AgentRobot, profile: RobotProfile, *, is_simulated: bool) -> None:
        self._robot = robot
        self._profile = profile
        self._is_simulated = is_simulated
        self._thread = threading.Thread(target=self._run, name="agents", daemon=True)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ended: asyncio.Event | None = None
        self._clients: set[LineStream] = set()
        self.path: Path = agent_socket_path(os.getpid())

    def start(self) -> None:
        """Open the socket, and serve from now on."""
        self.path.unlink(missing_ok=True)
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(str(self.path))
        self.path.chmod(0o600)
        self._listener.listen(MOST_CLIENTS)
        self._listener.setblocking(False)
        self._thread.start()

    def note_edit(self, turn: int, plan_text: str, result: Result) -> None:
        """Have the agent told what became of its person's edit of the plan of that turn, as the person counts turns."""
        self._robot.record.note_edit(turn % TURNS, plan_text, result)

    def close(self) -> None:
        """Serve nobody any more; stop the robot where an agent moves it."""
        self.path.unlink(missing_ok=True)
        self._robot.refuse(_ENDED)
        loop, ended = self._loop, self._ended
        if loop is not None and ended is not None:
            with contextlib.suppress(RuntimeError):  # it has ended by itself
                loop.call_soon_threadsafe(ended.set)
            self._thread.join(END_S)
        self._robot.close(_ENDED)

    def _run(self) -> None:
        wake_promptly()  # a call that is cancelled stops the robot
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        self._loop, self._ended = asyncio.get_running_loop(), asyncio.Event()
        clients: set[asyncio.Task[None]] = set()
        accepting = asyncio.create_task(self._accept(clients))
        await self._ended.wait()
        from chatrobot.mcp_server.streams import ANSWER_S

        await asyncio.gather(*(lines.answered(ANSWER_S) for lines in self._clients))
        for task in (accepting, *clients):
            task.cancel()
        await asyncio.gather(accepting, *clients, return_exceptions=True)
        self._listener.close()

    async def _accept(self, clients: set[asyncio.Task[None]]) -> None:
        loop = asyncio.get_running_loop()
        while True:
            connection, _ = await loop.sock_accept(self._listener)
            if len(clients) >= MOST_CLIENTS:
                connection.close()
                continue
            task = asyncio.create_task(self._serve_one(connection))
            clients.add(task)
            task.add_done_callback(clients.discard)

    async def _serve_one(self, connection: socket.socket) -> None:
        from chatrobot.mcp_server.server import build_server
        from chatrobot.mcp_server.streams import LineStream, serve_lines
        from chatrobot.mcp_server.tools import Tools

        connection.setblocking(True)
        with connection:
            self._robot.start()
            # One server a client: it keeps what its client has agreed to. The robot, and the order of calls, is one.
            tools = Tools(self._robot)
            server = build_server(self._robot, self._profile, is_simulated=self._is_simulated, tools=tools)
            number = connection.fileno()
            lines = LineStream(number, number, lambda: None)
            self._clients.add(lines)
            try:
                await serve_lines(server, lines)
            finally:
                self._clients.discard(lines)
                tools.leave()
                with contextlib.suppress(OSError):
                    connection.shutdown(socket.SHUT_RDWR)  # ends the thread that reads


def host_agents(
    connection: Connection,
    approval_address: Callable[[], str],
    *,
    is_simulated: bool,
    is_latched: Callable[[], bool] = lambda: False,
) -> AgentHost | None:
    """Serve agents beside the person whose session `connection` is; None where the extra `mcp` is not installed.

    Close it before that connection. `approval_address` is where that person says yes to an agent's plan; `is_latched`
    tells whether that person has set the emergency stop.
    """
    if importlib.util.find_spec("mcp") is None:
        return None
    robot = AgentRobot(
        lambda on_event: connection.second_session(SOURCE, on_event),
        approval_address,
        is_latched,
        is_shared=True,
    )
    host = AgentHost(robot, connection.profile, is_simulated=is_simulated)
    host.start()
    return host
