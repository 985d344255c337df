"""The processes that a session stands on. This module is light: they are started while the rest is still loaded."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget, limit_text
from chatrobot.wire.runtime_dir import runtime_dir

SIMULATED = ("auto", "sim")
"""`--on auto` never picks a real robot unasked."""


@dataclass
class MotionProcess:
    """Motion in a session of its own, so that no terminal signal reaches it, and our ends of the lines to it.

    `line` is a person's; an agent may speak on `second_line`. `is_shared`: the Motions of other robots are in the same
    process, which goes on when this line is left.
    """

    process: subprocess.Popen[bytes]
    line: socket.socket
    second_line: socket.socket | None = None
    is_shared: bool = False

    @classmethod
    def start(
        cls,
        wires: Sequence[str],
        profile: str,
        world: str,
        budget: MotionBudget = NOT_CHOSEN,
        *,
        open_loop: bool = False,
    ) -> list[MotionProcess]:
        """Start one process for the robots on those wires, all of one profile. A single one has a second line.

        `budget` is the motion budget as the command line chose it, `open_loop` that it chose open loop.
        """
        is_shared = len(wires) > 1
        process, lines = spawn_with_lines(
            "chatrobot.motion.process",
            *("--profile", profile, "--world", world),
            *("--max-distance", limit_text(budget.max_distance_m)),
            *("--max-time", limit_text(budget.max_time_s)),
            *("--open-loop", "yes" if open_loop else ""),
            *(word for wire in wires for word in ("--wire", wire)),
            kind=socket.SOCK_SEQPACKET,
            count=len(wires) if is_shared else 2,
        )
        return (
            [cls(process, line, is_shared=True) for line in lines]
            if is_shared
            else [cls(process, lines[0], lines[1])]
        )

    def close(self) -> None:
        """Close our ends of the lines."""
        for line in (self.line, self.second_line):
            if line is not None:
                line.close()


@dataclass
class Processes:
    """A simulated robot in real time, and the Motion that waits for it. `is_taken`: a session stands on them."""

    wire_path: Path
    robot: subprocess.Popen[bytes]
    motion: MotionProcess
    is_taken: bool = False

    @classmethod
    def start(
        cls, profile: str, world: str, sim: str, budget: MotionBudget, *, open_loop: bool = False
    ) -> Processes:
        """Both at once: Motion loads while the robot does."""
        return cls.start_class(1, profile, world, sim, budget, open_loop=open_loop)[0]

    @classmethod
    def start_class(
        cls, count: int, profile: str, world: str, sim: str, budget: MotionBudget, *, open_loop: bool = False
    ) -> list[Processes]:
        """Start so many robots, none of which meets another: one process for all robots, one for all Motions."""
        name = uuid.uuid4().hex[:12]
        paths = [
            runtime_dir() / f"sim-{name}{f'-{place}' if count > 1 else ''}.wire" for place in range(count)
        ]
        wires = [str(path) for path in paths]
        robot = spawn(
            "chatrobot.sim",
            *(word for wire in wires for word in ("--socket", wire)),
            *("--profile", profile, "--world", world, "--sim", sim),
        )
        motions = MotionProcess.start(wires, profile, world, budget, open_loop=open_loop)
        return [cls(path, robot, motion) for path, motion in zip(paths, motions)]

    def end(self) -> None:
        """Nobody needs them: nothing has been asked of them, so nothing moves."""
        self.motion.process.kill()
        self.robot.terminate()
        self.motion.close()


def spawn(module: str, *arguments: str, pass_fds: Sequence[int] = ()) -> subprocess.Popen[bytes]:
    """Start `python -m MODULE ARGUMENTS` in a session of its own, so that no signal of a terminal reaches it.

    Spawned, never forked: a forked child would hold descriptors of ours, and nobody would see them end. A thread waits
    for its end, whenever that is: else what has ended stays a zombie for as long as we live.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", module, *arguments],
        pass_fds=pass_fds,
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    threading.Thread(target=process.wait, name="reaper", daemon=True).start()
    return process


def spawn_with_line(
    module: str, *arguments: str, kind: socket.SocketKind
) -> tuple[subprocess.Popen[bytes], socket.socket]:
    """The same with a line to talk over: our end of a socket pair. The child is told its own by `--fd`."""
    process, (line,) = spawn_with_lines(module, *arguments, kind=kind, count=1)
    return process, line


def spawn_with_lines(
    module: str, *arguments: str, kind: socket.SocketKind, count: int
) -> tuple[subprocess.Popen[bytes], list[socket.socket]]:
    """The same with several lines: `--fd 5,6`."""
    pairs = [socket.socketpair(socket.AF_UNIX, kind) for _ in range(count)]
    numbers = [theirs.fileno() for _, theirs in pairs]
    try:
        told = ",".join(map(str, numbers))
        return spawn(module, *arguments, "--fd", told, pass_fds=numbers), [ours for ours, _ in pairs]
    finally:
        for _, theirs in pairs:
            theirs.close()
