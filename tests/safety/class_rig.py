"""A class of robots in processes of their own, and this process as the one that talks for all pupils."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from pathlib import Path

from chatrobot.compose import Setup
from chatrobot.core.events import Event
from chatrobot.web.pupils import connect_class
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage
from tests.link.leaving import abandon
from tests.processes import Heard

PATIENCE_S = 20.0


class RunningClass:
    """So many robots that stand in the empty world, and an ear on the wire of each."""

    def __init__(self, folder: Path, count: int, world: str = "empty") -> None:
        self.names = [f"pupil {place}" for place in range(1, count + 1)]
        self.events: dict[str, list[Event]] = {name: [] for name in self.names}
        self.robots = connect_class(
            Setup(world=world, folder=folder), self.names, lambda name: self.events[name].append
        )
        self._wires, self.heard = [], []
        for path in sorted(
            (Path(os.environ["XDG_RUNTIME_DIR"]) / "chatrobot").glob("sim-*.wire"), key=_place
        ):
            wire, ear = LocalWire(path), Heard(PATIENCE_S)
            wire.subscribe("cmd_vel", TwistMessage, ear)
            self._wires.append(wire)
            self.heard.append(ear)
        self.pids = {name: _pid_of(module, str(path)) for name, module in _MODULES.items()}

    def drive(self) -> None:
        """Have all of them drive for long, and wait until they do."""
        began_s = time.monotonic()
        for place, robot in enumerate(self.robots):
            self.say(place, "forward 100 m at 0.3 m/s")
            robot.connection.session.pump(0.0)
        for ear in self.heard:
            ear.wait_for_motion(began_s)

    def say(self, place: int, text: str) -> int:
        """Have that pupil say it; the turn."""
        session = self.robots[place].connection.session
        turn = session.say(text)
        session.pump(0.0)
        return turn

    def result(self, place: int, turn: int) -> str:
        """Wait for the outcome of a turn."""
        session = self.robots[place].connection.session
        ends_s = time.monotonic() + PATIENCE_S
        while turn not in session.results and time.monotonic() < ends_s:
            session.pump(0.05)
        return session.results[turn].outcome

    def strike(self, whom: str, how: str) -> float:
        """Send that signal to one of the three processes; return when."""
        began_s = time.monotonic()
        os.kill(self.pids[whom], getattr(signal, how))
        return began_s

    def seconds_to_zero(self, since_s: float) -> float:
        """Return how long the last of them took to stand."""
        return max(ear.seconds_to_zero(since_s) for ear in self.heard)

    def close(self) -> None:
        """End what this started, frozen or not."""
        for wire in self._wires:
            wire.close()
        for robot in self.robots:
            abandon(robot.connection.link)
        for pid in self.pids.values():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)
                os.kill(pid, signal.SIGKILL)


_MODULES = {"motion": "chatrobot.motion.process", "robots": "chatrobot.sim", "guard": "chatrobot.guard"}


def _place(path: Path) -> int:
    return int(path.stem.rpartition("-")[2])


def _pid_of(module: str, wire: str) -> int:
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):  # it has ended
            words = file.read_bytes().decode(errors="replace").split("\0")
            if module in words and wire in words:
                return int(file.parent.name)
    raise AssertionError(f"{module} does not run")
