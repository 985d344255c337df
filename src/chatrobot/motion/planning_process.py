"""Rehearsals of the robots of a class, in a process beside the one that drives them: `python -m
chatrobot.motion.planning_process --fd N,M,…`, one line for each robot.

A single robot rehearses in a thread of its Motion. Where many are driven by one thread, a rehearsal there would take
the interpreter from it at each of its system calls, and one pupil's long plan would delay the ticks of all the others.
"""

from __future__ import annotations

import io
import pickle
import signal
import socket
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from multiprocessing.connection import Connection
from typing import Any

from chatrobot.core.errors import SandboxError
from chatrobot.core.geometry import Pose
from chatrobot.core.process import give_way, prefer
from chatrobot.core.reason import Reason
from chatrobot.link.processes import spawn_with_lines
from chatrobot.motion.budgets import Account
from chatrobot.motion.goal import Stream
from chatrobot.motion.planner import Planned, Planner
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.remembered_obstacles import RememberedObstacles
from chatrobot.plan.swept_path import ANY_WAY, Most
from chatrobot.robots.profile import RobotProfile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.world import Obstacle, World

NICENESS = 10
"""What drives goes first, and programs that run."""
OOM_SCORE = 500
"""Where memory runs out it goes before Motion: nothing moves by it."""


class _Pickler(pickle.Pickler):
    known: Mapping[str, object]

    def persistent_id(self, one: object) -> str | None:
        name = type(one).__name__
        return name if name in self.known and one is self.known[name] else None


class _Unpickler(pickle.Unpickler):
    known: Mapping[str, object]

    def persistent_load(self, name: str) -> object:
        return self.known[name]


class Messages:
    """One end of a line. What both ends know, the robot and the world, travels by name: a world is large."""

    def __init__(self, line: socket.socket, known: Sequence[object] = ()) -> None:
        self._connection = Connection(line.detach())
        self._known = {type(one).__name__: one for one in known}

    def send(self, message: object) -> None:
        """Send it. Raises OSError where the other end is gone."""
        packet = io.BytesIO()
        pickler = _Pickler(packet, pickle.HIGHEST_PROTOCOL)
        pickler.known = self._known
        pickler.dump(message)
        self._connection.send_bytes(packet.getbuffer())

    def close(self) -> None:
        """Close the line."""
        self._connection.close()

    def receive(self) -> Any:
        """Return the next message. Raises EOFError or OSError where the other end is gone."""
        unpickler = _Unpickler(io.BytesIO(self._connection.recv_bytes()))
        unpickler.known = self._known
        return unpickler.load()


class RemotePlanner(Planner):
    """Plans in the process beside this one; used by one thread.

    Args:
        renew: starts that process anew, where it is gone.
    """

    def __init__(
        self, profile: RobotProfile, world: World, renew: Callable[[RemotePlanner, Messages], None]
    ) -> None:
        super().__init__(profile, world)
        self._renew = renew
        self.messages: Messages
        """This robot's line to that process."""

    def plan(
        self,
        turn: int,
        plan_text: str,
        start: Pose,
        plan_start: Pose | None = None,
        seen: RememberedObstacles | None = None,
        left: Most = ANY_WAY,
    ) -> Planned:
        """Have it read and rehearsed there."""
        return self._ask(turn, (turn, plan_text, start, plan_start, seen, left))

    def plan_program(self, goal: ProgramGoal, seen: RememberedObstacles | None) -> Planned:
        """Have a program rehearsed there."""
        bare = replace(
            goal, account=Account(), stream=Stream(), planned=None
        )  # what it has driven stays here
        return self._ask(goal.turn, (bare, seen))

    def _ask(self, turn: int, question: tuple[Any, ...]) -> Planned:
        messages = self.messages
        try:
            messages.send((self.added, question))
            answer: Planned = messages.receive()
        except (OSError, EOFError):  # not asked again: it may be what ended it
            self._renew(self, messages)
            return Planned(turn, None, Reason("rehearsal_gone"))
        return answer


class PlanningProcess:
    """Starts the process, and starts it anew where it is gone: nothing moves by it, and nothing stops with it."""

    def __init__(self, profile: RobotProfile, world: World, count: int) -> None:
        self._known = (profile, world)
        self._lock = threading.Lock()
        self.planners = [RemotePlanner(profile, world, self._renew) for _ in range(count)]
        self._start()

    def kill(self) -> None:
        """End it as a crash would."""
        self._process.kill()
        self._process.wait()

    def close(self) -> None:
        """Let go of it: it ends once its last answer is given."""
        for planner in self.planners:
            planner.messages.close()

    def _start(self) -> None:
        self._process, lines = spawn_with_lines(
            "chatrobot.motion.planning_process", kind=socket.SOCK_STREAM, count=len(self.planners)
        )
        Messages(lines[0].dup()).send(self._known)
        for planner, line in zip(self.planners, lines):
            planner.messages = Messages(line, self._known)

    def _renew(self, planner: RemotePlanner, gone: Messages) -> None:
        with self._lock:
            if planner.messages is gone:
                self._start()


class RemoteProgramHost(ProgramHost):
    """Has programs rehearsed in the process beside this one; what runs live is started from here.

    Args:
        server: the warm server of all robots of this process.
    """

    def __init__(self, profile: RobotProfile, planner: RemotePlanner, server: WarmServer) -> None:
        super().__init__(profile, is_in_step=False, server=server)
        self._elsewhere = planner

    def rehearse(self, goal: ProgramGoal, _: Planner, seen: RememberedObstacles | None) -> Planned:
        """Run it on virtual time over there."""
        try:
            self.warm()  # here, and not on the control thread when it is launched
        except SandboxError as error:
            return Planned(goal.turn, None, error.reason)
        return self._elsewhere.plan_program(goal, seen)


MOST_WORLDS = 32
"""Worlds that differ by what pupils have put into them, and are kept."""


def _planner(profile: RobotProfile, world: World, added: tuple[Obstacle, ...]) -> Planner:
    planner = Planner(profile, world)
    planner.add(added)
    return planner


class _Rehearsals:
    """What is asked for, and who answers."""

    def __init__(self, profile: RobotProfile, world: World) -> None:
        self._planners = lru_cache(MOST_WORLDS)(partial(_planner, profile, world))
        self._programs = ProgramHost(profile, is_in_step=True)
        self.known = (profile, world)

    def answer(self, asked: tuple[tuple[Obstacle, ...], tuple[Any, ...]]) -> Planned:
        """Return what was asked for by a `RemotePlanner`, in the world with what was added there."""
        added, question = asked
        planner = self._planners(added)
        if isinstance(question[0], ProgramGoal):
            goal, seen = question
            return self._programs.rehearse(goal, planner, seen)
        return planner.plan(*question)

    def close(self) -> None:
        """End what runs in the sandbox."""
        self._programs.close()


def _serve(messages: Messages, answer: Callable[[tuple[Any, ...]], Planned]) -> None:
    while True:
        try:
            messages.send(answer(messages.receive()))
        except (OSError, EOFError):
            return


def main(arguments: list[str]) -> int:
    """Rehearse until nobody is there to ask; the exit code."""
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGPIPE"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    prefer(OOM_SCORE)
    give_way(NICENESS)
    lines = [socket.socket(fileno=int(number)) for number in arguments[1].split(",")]
    try:
        rehearsals = _Rehearsals(*Messages(lines[0].dup()).receive())
    except (OSError, EOFError):
        return 1
    threads = [
        threading.Thread(target=_serve, args=(Messages(line, rehearsals.known), rehearsals.answer))
        for line in lines
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    rehearsals.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
