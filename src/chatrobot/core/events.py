"""What happens, told to whoever listens: console, `--json`, recordings. Listeners only read.

Every event is a frozen dataclass with a name; `to_json` gives the object of one `--json` line. Motion's events and
the session's are one family, so that a listener needs no second vocabulary. Units are in the field names, poses
are in `odom` as the robot itself measures them (`TruePose` alone is the simulator's truth).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from chatrobot.core.event import Event as Event
from chatrobot.core.event import Proposal
from chatrobot.core.event import event_from_json as event_from_json
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import Looked as Looked
from chatrobot.core.sensed_events import Scan as Scan
from chatrobot.core.sensed_events import Telemetry as Telemetry
from chatrobot.core.sensed_events import TruePose as TruePose

Outcome = Literal["completed", "stopped", "refused", "unclear", "answered", "failed"]
EXIT_CODES: Mapping[str, int] = {
    "completed": 0, "answered": 0, "failed": 1, "unclear": 3, "refused": 4, "stopped": 5,
}  # fmt: skip
LEAST_M, LEAST_RAD = 0.005, math.radians(0.5)
"""Less than this is no motion worth telling."""


@dataclass(frozen=True)
class Interpreted(Event, name="interpreted"):
    """What was understood, and by whom."""

    by: Literal["offline", "model", "reflex"]
    plan_text: str
    reply: str


@dataclass(frozen=True)
class Ordered(Event, name="ordered"):
    """Another client of this robot asks for a plan or a program; what follows under this number is about it."""

    source: str
    plan_text: str
    program: str = ""
    rehearse_only: bool = False


@dataclass(frozen=True)
class FindingSeen(Event, name="finding"):
    """One thing rehearsal found. `step` is the index path of the step, from 1."""

    severity: Literal["refuse", "warn", "note"]
    reason: Reason
    step: tuple[int, ...] = ()
    t_s: float = 0.0


@dataclass(frozen=True)
class Rehearsed(Event, name="rehearsed"):
    """What the plan would do: `path` is (x_m, y_m, yaw_rad) along the predicted way, thinned for drawing.

    `open_ended`: nobody knows before how far it drives (a program without an end, a way up to an obstacle that is not
    known); `length_m` and `duration_s` are what was rehearsed.
    """

    ok: bool
    duration_s: float
    length_m: float
    end: Pose
    findings: tuple[FindingSeen, ...] = ()
    path: tuple[tuple[float, float, float], ...] = ()
    needs_approval: bool = False
    open_ended: bool = False


@dataclass(frozen=True)
class ProgramWritten(Event, name="program_written"):
    """A program was written, or found under its name. `marks` have the line they are about in `step`.

    `by` is who wrote this version, `version` counts from 1, `diff` is what changed since the one before; `is_new`
    where it was written in this turn. `place` is the file that holds its source, "" where none does.
    """

    program: str
    by: Literal["offline", "model", "person"]
    source: str
    description: str = ""
    version: int = 1
    diff: str = ""
    is_new: bool = False
    marks: tuple[FindingSeen, ...] = ()
    place: str = ""


@dataclass(frozen=True)
class ProgramRehearsed(Event, name="program_rehearsed"):
    """What the program did in its sandbox on virtual time, besides what `rehearsed` tells, which follows.

    `ended` says how: it `returned`, called `exit`, `raised`, `died`, was `stuck` waiting for nothing, or still ran at
    the `horizon`. `problem` is its traceback or the like, `line` where in the program that was, 0 for nowhere.
    """

    program: str
    ended: str
    top_speed_mps: float
    top_rate_radps: float
    stands_at_end: bool
    problem: str = ""
    line: int = 0
    log: tuple[str, ...] = ()


@dataclass(frozen=True)
class ProgramLog(Event, name="program_log"):
    """What a running program logged or printed, `t_s` after its start."""

    t_s: float
    level: str
    text: str


@dataclass(frozen=True)
class Started(Event, name="started", unmeasured=("pose",)):
    """The robot begins to act on this turn. `measured`: see `Finished`."""

    pose: Pose = ORIGIN
    measured: bool = True


@dataclass(frozen=True)
class Paused(Event, name="paused"):
    """The plan of this turn was stopped by a word that keeps it: the turn stays open, and `plan_text` is what is left.

    It is gone on with, from where the robot stands then, when its own source asks for that: `rehearsed` and `started`
    follow. Else `finished` ends it. `waiting` are the texts of its session that are done after it.
    """

    pose: Pose
    plan_text: str
    reason: Reason | None = None
    waiting: tuple[str, ...] = ()


@dataclass(frozen=True)
class Progress(Event, name="progress"):
    """How far a running turn is: step `step` of `of`, `fraction` of the whole predicted duration (0..1).

    `fraction` is None where the whole is not known: a program without an end, a plan that is still coming in.
    """

    step: int
    of: int
    fraction: float | None
    pose: Pose
    twist: Twist


@dataclass(frozen=True)
class Limited(Event, name="limited"):
    """The governor allows less than was asked for: `sent` is the most it will send of it."""

    rule: str
    asked: Twist
    sent: Twist
    reason: Reason | None = None


@dataclass(frozen=True)
class Said(Event, name="said"):
    """A `say` step."""

    text: str


@dataclass(frozen=True)
class Remembered(Event, name="remembered"):
    """A `remember` step: the place and where it is, in `odom`."""

    place: str
    pose: Pose


@dataclass(frozen=True)
class Streamed(Event, name="streamed"):
    """A step of a plan that still comes in, as it goes to Motion; `interpreted` has the whole plan at its end."""

    plan_text: str


@dataclass(frozen=True)
class ModelCalled(Event, name="model_called"):
    """One call of a language model has ended: what it cost. `round` counts the calls of a turn from 1.

    Tokens are the provider's count, an estimate where `counted` is False. `cost_usd` is None where no price is known.
    """

    model: str
    round: int
    prompt_tokens: int
    cached_tokens: int
    reply_tokens: int
    cost_usd: float | None
    counted: bool
    duration_s: float


@dataclass(frozen=True)
class Notice(Event, name="notice"):
    """Something a person should know that ends nothing."""

    reason: Reason
    text: str = ""


RELEASED = frozenset({"released", "none_to_release"})
"""The reasons of notices that no emergency stop is set any more, or was."""


@dataclass(frozen=True)
class Finished(Event, name="finished", unmeasured=("start", "pose", "turned_rad", "path_m")):
    """Motion's end of a turn: what odometry measured, never what was asked for.

    Odometry counts wheels, and a gyro sees only turns: wheels that spin straight on are counted as way
    (docs/simulation.md, "Wheels that spin").

    `planned_m` is the way of the whole plan, for "0.60 m of 1.00 m", and `planned_turn_rad` what it wanted to turn up
    to its end. `open_ended`: the whole is not known, and `planned_m` is what was rehearsed of it.
    `possible` is plan text: what can be done of a plan that was refused. `measured` is False where the robot has no
    odometry: poses, path and turn are then unknown, null in JSON, and `planned_m` and `planned_turn_rad` are what was
    sent.

    `executed` and `remaining` are plan text: the part of the plan that was driven, as odometry measured it, and the
    part that was not. Driving one after the other is driving the whole plan. Both are empty for a program and where
    nothing measures; `remaining` also where the plan was completed or refused.

    `duration_s` is how long it was driven, and `paused_s` how long it stood between its motions, in a wait of the plan
    or paused by somebody: neither contains the other.

    `late_s` is how late the heartbeat of whoever gave the order was at most, where that slowed the robot: the machine
    was too busy.
    """

    outcome: Outcome
    reason: Reason | None
    start: Pose
    pose: Pose
    turned_rad: float
    path_m: float
    duration_s: float
    paused_s: float
    planned_m: float = 0.0
    planned_turn_rad: float = 0.0
    steps_done: int = 0
    steps: int = 0
    measured: bool = True
    possible: str = ""
    executed: str = ""
    remaining: str = ""
    open_ended: bool = False
    late_s: float = 0.0

    def followed_by(self, run: Finished) -> Finished:
        """Tell two runs of one turn as one."""
        add = [
            "turned_rad",
            "path_m",
            "duration_s",
            "paused_s",
            "planned_m",
            "planned_turn_rad",
            "steps_done",
            "steps",
        ]
        return replace(
            run,
            start=self.start,
            **{name: getattr(self, name) + getattr(run, name) for name in add},
            measured=self.measured and run.measured,
            open_ended=self.open_ended or run.open_ended,
            late_s=max(self.late_s, run.late_s),
            executed="\n".join(filter(None, (self.executed, run.executed))),
        )

    def resumed_by(self, rest: Finished) -> Finished:
        """Tell a plan that was paused and its rest as one: what was planned in vain at the pause counts once."""
        return replace(
            self.followed_by(rest),
            planned_m=self.path_m + rest.planned_m,
            planned_turn_rad=self.turned_rad + rest.planned_turn_rad,
            steps=self.steps,
            open_ended=rest.open_ended,
        )


@dataclass(frozen=True)
class Result(Event, name="result", unmeasured=("pose", "turned_rad", "path_m")):
    """The last event of every turn; pose and distances are what odometry measured, as in `Finished`, and
    None where `measured` is False.

    `duration_s` and `paused_s` are as in `Finished`: neither contains the other. `proposal` is a plan that the reply
    asks about.
    """

    outcome: Outcome
    reply: str
    pose: Pose | None = ORIGIN
    turned_rad: float | None = 0.0
    path_m: float | None = 0.0
    duration_s: float = 0.0
    paused_s: float = 0.0
    reason: Reason | None = field(default=None)
    proposal: Proposal | None = None
    measured: bool = True

    def __post_init__(self) -> None:
        if not self.measured:  # a program is not to compute with zeros that nobody has measured
            for name in self.unmeasured:
                object.__setattr__(self, name, None)

    @property
    def has_moved(self) -> bool:
        """It was measured that the robot moved."""
        return (self.path_m or 0.0) > LEAST_M or abs(self.turned_rad or 0.0) > LEAST_RAD

    @property
    def is_question(self) -> bool:
        """The next text may answer it."""
        return self.outcome == "unclear" or self.proposal is not None
