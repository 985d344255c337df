"""A program on virtual time and the simulated robot it drives, step by step in time."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.programs.events import (
    AsksTime,
    Died,
    Ended,
    Listens,
    Log,
    Output,
    ProgramEvent,
    Raised,
    TopicNoticed,
    TwistAsked,
)
from chatrobot.programs.sandboxed import SandboxedProgram

POLL_S = 0.2


class Stage(Protocol):
    """The robot and what governs it. Times are seconds since the program's start."""

    @property
    def now_s(self) -> float: ...

    @property
    def due_s(self) -> float:
        """When the next message may come."""
        ...

    def ask(self, twist: Twist) -> None:
        """The program publishes a velocity, now."""
        ...

    def listen(self, sensor: str, depth: int) -> None:
        """From now on what that sensor says is kept, the last `depth` of it."""
        ...

    def advance(self, until_s: float, *, wakes: bool = False) -> None:
        """Let time pass; with `wakes`, only until a message has come."""
        ...

    def take_messages(self) -> Sequence[Sequence[Any]]:
        """What sensors said since they were last asked: (sensor, stamp, numbers…)."""
        ...


@dataclass
class Played:
    """What a program did on virtual time. `end` is its last event, `wall_s` how long that took here.

    `cmd_vel` is what it published for the robot: (seconds since its start, velocity).
    """

    end: Ended | Raised | Died
    wall_s: float = 0.0
    cmd_vel: list[tuple[float, Twist]] = field(default_factory=list)
    log: list[Log | Output] = field(default_factory=list)
    topics: list[TopicNoticed] = field(default_factory=list)
    is_planar: bool = True
    attempts: tuple[Reason, ...] = ()

    @property
    def duration_s(self) -> float:
        """By the program's clock."""
        return (
            self.end.t_s
            if isinstance(self.end, (Ended, Raised))
            else (self.cmd_vel[-1][0] if self.cmd_vel else 0.0)
        )


def play(program: SandboxedProgram, stage: Stage, wall_limit_s: float) -> Played:
    """Start `program`, let it live with `stage` to its end, and close it.

    A program that takes longer than `wall_limit_s` here is ended: `Died` of `program_too_busy`.
    """
    began_s = time.monotonic()
    played = Played(Died(Reason("program_too_busy", {"limit_s": wall_limit_s}), ""))
    program.start()
    try:
        while program.end is None and time.monotonic() - began_s < wall_limit_s:
            for event in program.poll(POLL_S):
                _take(event, program, stage, played)
        if program.end is not None:
            report = program.exit_report()
            played.attempts = report.findings if report is not None else ()
    finally:
        program.close()
    played.wall_s = time.monotonic() - began_s
    return played


def _take(event: ProgramEvent, program: SandboxedProgram, stage: Stage, played: Played) -> None:
    if isinstance(event, Died):
        played.end = event
        return
    stage.advance(min(event.t_s, program.settings.horizon_s))
    if isinstance(event, TwistAsked):
        played.cmd_vel.append((stage.now_s, event.twist))
        played.is_planar &= event.planar
        stage.ask(event.twist)
    elif isinstance(event, AsksTime):
        stage.advance(min(event.until_s, program.settings.horizon_s), wakes=event.wakes)
        program.let_pass(stage.now_s, stage.due_s, stage.take_messages())
    elif isinstance(event, Listens):
        stage.listen(event.sensor, event.depth)
    elif isinstance(event, (Log, Output)):
        played.log.append(event)
    elif isinstance(event, TopicNoticed):
        played.topics.append(event)
    elif isinstance(event, (Ended, Raised)):
        played.end = event
