"""The robots of a class: a simulated robot for each pupil, none of which meets another, put together into sessions.

All robots are one process, all Motions a second, one guard watches them (docs/decisions/0047). A pupil's session speaks
as `pupil`, which may not release an emergency stop; whoever teaches may.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from chatrobot.compose import Connection, OnEvent, Setup, connect, default_world
from chatrobot.core.errors import UsageError, WireError
from chatrobot.link.processes import SIMULATED, Processes
from chatrobot.link.socket_link import SocketLink
from chatrobot.robots.load import profile_argument, profile_dirs
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import Message

Kind = TypeVar("Kind", bound=Message)
FEWEST, MOST = 2, 30
TURN_S = 0.02
"""Of the thread that reads their wires for recordings and lessons."""
PUPIL = "pupil"
"""The source in whose name a pupil's session speaks."""
_TEACHER = "console"
"""Whoever opened the class sits at the local console."""


@dataclass
class PupilsRobot:
    """One pupil's robot and the session that drives it; `wire_path` is where others hear it."""

    name: str
    connection: Connection
    wire_path: Path

    def release(self) -> None:
        """Release its emergency stop, as the teacher. Motion's notice says what became of it.

        Raises:
            LinkError: Motion is gone.
        """
        link = self.connection.link
        assert isinstance(link, SocketLink), "a class lives in real time"
        link.release_as(_TEACHER)


def check_class(setup: Setup, count: int) -> None:
    """Refuse what no class can be.

    Raises:
        UsageError: it says what, and what is allowed.
    """
    if setup.on not in SIMULATED:
        raise UsageError("a class has simulated robots alone: leave --on out", where="--class")
    if setup.fast or setup.trace:
        raise UsageError(
            "a class lives in real time, and leaves no trace", where="--fast" if setup.fast else "--trace"
        )
    if not FEWEST <= count <= MOST:
        raise UsageError(f"{count} is no class", where="--class", allowed=f"{FEWEST} to {MOST} pupils")


def connect_class(
    setup: Setup, names: Sequence[str], on_event_of: Callable[[str], OnEvent]
) -> list[PupilsRobot]:
    """Start a robot for each name, and wait until all have been heard.

    Args:
        setup: what holds for each of them; what a pupil keeps goes to a folder of their own within its folder.
        on_event_of: takes a name and gives what hears the events of that robot.

    Raises:
        InputError: a profile, world or option is wrong, or cannot be one of a class.
        LinkError: Motion or the simulated robots do not start.
    """
    check_class(setup, len(names))
    world = setup.world or default_world(setup.on, open_loop=setup.open_loop)
    robot = profile_argument(setup.robot, profile_dirs(setup.folder))
    setup = replace(setup, world=world, robot=robot, source=PUPIL)
    started = Processes.start_class(
        len(names), robot, world, setup.sim, setup.budget, open_loop=setup.open_loop
    )
    robots = []
    with contextlib.ExitStack() as ended_early:
        ended_early.callback(started[0].end)
        for place, (name, processes) in enumerate(zip(names, started), 1):
            folder = setup.folder / "class" / f"pupil-{place}" if setup.folder is not None else None
            own = replace(setup, processes=processes, folder=folder)
            robots.append(PupilsRobot(name, connect(own, on_event_of(name)), processes.wire_path))
        ended_early.pop_all()
    return robots


class RobotWires:
    """One more end of the wire of each robot, all of them read by one thread, in turns: a thread for each would have
    the interpreter go from hand to hand at every message. Subscribe, then `start`.

    Callbacks come from that thread, or from whoever calls `bring_up_to_date`.

    Args:
        truth_topic: where simulated robots tell where they truly are.

    Raises:
        WireError: nobody serves one of them.
    """

    def __init__(self, robots: Iterable[PupilsRobot], truth_topic: str) -> None:
        self.truth_topic = truth_topic
        self._wires = {robot.name: LocalWire(robot.wire_path, has_thread=False) for robot in robots}
        self._locks = {name: threading.Lock() for name in self._wires}
        self._has_ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="wires", daemon=True)

    def subscribe(self, name: str, topic: str, kind: type[Kind], callback: Callable[[Kind], None]) -> None:
        """Hear what that robot is told, or says, on a topic."""
        with contextlib.suppress(WireError):  # that robot is gone, and Motion says so
            self._wires[name].subscribe(topic, kind, callback)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def bring_up_to_date(self, name: str) -> None:
        """Have everything delivered that has come from that robot by now. From any thread that holds no lock."""
        with self._locks[name]:
            if not self._wires[name].is_over:
                self._wires[name].deliver()

    def close(self) -> None:
        """Hear no more."""
        self._has_ended.set()
        if self._thread.ident is not None:
            self._thread.join()
        for wire in self._wires.values():
            wire.close()

    def _run(self) -> None:
        while not self._has_ended.wait(TURN_S):
            for name in self._wires:
                self.bring_up_to_date(name)
