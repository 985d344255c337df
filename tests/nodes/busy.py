"""The three nodes beside processes that keep every core busy: lines that are driven, and blows in between."""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import psutil

from chatrobot.core.geometry import Twist
from tests.nodes.node_rig import NodeRig

BUSY = 8
THAWED_S = 0.5
"""So long after a thaw nothing may move."""
TOO_BUSY = ("motion_late", "beat_late")
"""Reasons for which the robot is stopped where its processes get no turn in time."""
TRIES = 5
TINY = 0.02
"""What holding a heading asks besides."""
TUTORIAL = "linear.x = {},linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = {}"


class Line(NamedTuple):
    """What is typed, and the velocities that it asks for one after the other, each for so long."""

    text: str
    twists: tuple[Twist, ...]
    duration_s: float

    @property
    def path_m(self) -> float:
        return sum(twist.speed_mps for twist in self.twists) * self.duration_s

    @property
    def turn_rad(self) -> float:
        return sum(twist.wz_radps for twist in self.twists) * self.duration_s


TUTORIAL_LINES = [
    Line(TUTORIAL.format(vx, wz), (Twist(vx, 0.0, wz),), 1.0)
    for vx, wz in ((0.5, 0.0), (-0.5, 0.0), (0.0, 0.6), (0.4, -0.6), (-0.4, 0.6), (0.0, -0.6))
]
"""One-second lines of the tutorial's form; after all six the robot is about where it was."""

SHORT_S = 0.2
SHORT = {
    "forward for 0.2 s at 0.2 m/s": Twist(0.2, 0.0, 0.0),
    "back for 0.2 s at 0.2 m/s": Twist(-0.2, 0.0, 0.0),
    "turn left for 0.2 s at 0.4 rad/s": Twist(0.0, 0.0, 0.4),
    "turn right for 0.2 s at 0.4 rad/s": Twist(0.0, 0.0, -0.4),
}
SHORT_LINES = [Line(text, (twist,), SHORT_S) for text, twist in SHORT.items()]
FOUR_AT_ONCE = Line(", then ".join(SHORT), tuple(SHORT.values()), SHORT_S)


@contextlib.contextmanager
def busy_processes(count: int = BUSY) -> Iterator[None]:
    """So many that never wait, each with a share of the processors of its own."""
    command = [sys.executable, "-c", "while True: pass"]
    processes = [subprocess.Popen(command, start_new_session=True) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


@dataclass
class Driven:
    """What became of a line. `problems`: ended before its time, went too little, reversed.

    `is_halted`: the robot was stopped rather than driven blindly, and the reply says that the machine is too busy.
    """

    line: Line
    reply: str
    late_s: float
    is_halted: bool
    problems: list[str]

    def __str__(self) -> str:
        return f"{self.line.text!r}: {', '.join(self.problems)}; it said {self.reply!r}"


def drive_line(rig: NodeRig, line: Line) -> Driven:
    """Type it, and see what the robot is told and what is said of it."""
    said_s = rig.nodes["input"].say(line.text)
    result = rig.result(said_s)
    control = rig.nodes["control"]
    assert control.process.poll() is None, f"control has ended: {control.lines[-30:]}"
    _, finished = rig.events.wait_for(lambda event: event["event"] == "finished", said_s)
    told = [message for _, message in rig.velocities.since(said_s)]
    is_halted = result["outcome"] == "failed" and result["reason"]["code"] in TOO_BUSY
    problems = []
    if not is_halted and result["outcome"] != "completed":
        problems.append(f"{result['outcome']} ({result['reason']})")
    elif not is_halted and (
        result["path_m"] < 0.95 * line.path_m - 0.005 or abs(result["turned_rad"] - line.turn_rad) > 0.1
    ):
        problems.append(f"{result['path_m']:.3f} m, {result['turned_rad']:.3f} rad")
    for axis, name in enumerate(Twist._fields):
        asked = _signs(twist[axis] for twist in line.twists)
        signs = _signs(message[axis] for message in told)
        if asked and signs != (asked[: len(signs)] if is_halted else asked):
            problems.append(f"{name} reversed")
    return Driven(line, result["reply"], finished["late_s"], is_halted, problems)


def _signs(values: Iterable[float]) -> list[bool]:
    """Which way it goes, one after the other."""
    return [forward for forward, _ in itertools.groupby(value > 0.0 for value in values if abs(value) > TINY)]


def drive_lines(rig: NodeRig, lines: Sequence[Line]) -> list[Driven]:
    """Drive each, and again where the robot was stopped for a busy machine: at most `TRIES` times."""
    driven = []
    for line in lines:
        tries = [drive_line(rig, line)]
        while tries[-1].is_halted and not tries[-1].problems and len(tries) < TRIES:
            tries.append(drive_line(rig, line))
        if tries[-1].is_halted:
            tries[-1].problems.append(f"halted {len(tries)} times")
        driven += tries
    return driven


# --- blows ---


def pid_of(rig: NodeRig, whom: str) -> int:
    if whom in rig.nodes:
        return rig.nodes[whom].process.pid
    parent, module = {
        "guard": (rig.nodes["control"], "chatrobot.guard"),
        "robot's end": (rig.robot, "chatrobot.sim"),
    }[whom]
    children = psutil.Process(parent.process.pid).children(recursive=True)
    (pid,) = [child.pid for child in children if module in child.cmdline()]
    return pid


def freeze(rig: NodeRig, whom: str) -> float:
    """Seconds from SIGSTOP mid-motion to the zero after which nothing moved; then it thaws, and nothing may move."""
    pid = pid_of(rig, whom)
    rig.drive()
    struck_s = time.monotonic()
    os.kill(pid, signal.SIGSTOP)
    took_s = rig.velocities.seconds_to_zero(struck_s)
    thawed_s = time.monotonic()
    os.kill(pid, signal.SIGCONT)
    time.sleep(THAWED_S)
    moved = [message for _, message in rig.velocities.since(thawed_s) if any(message)]
    assert len(moved) <= (1 if whom == "control" else 0), f"{whom} thawed, and the robot went on: {moved}"
    rig.rest()
    return took_s


def kill(rig: NodeRig, whom: str) -> float:
    """Seconds from SIGKILL mid-motion to the zero after which nothing moved."""
    pid = pid_of(rig, whom)
    rig.drive()
    struck_s = time.monotonic()
    os.kill(pid, signal.SIGKILL)
    return rig.velocities.seconds_to_zero(struck_s)
