"""The ledger of measured turns: what each turn did, as odometry measured it, and what of it has been undone since.

A turn that moved is an entry: a way from the pose before it to the pose after it. `undo` walks the last entry back,
`redo` walks it forth again; either may be stopped half way, and the entry then knows the rest of both ways.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Literal, Union

from chatrobot.core.errors import PlanTextError
from chatrobot.core.events import Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.language.inverse import inverse
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import Block
from chatrobot.plan.steps import Face, Go, Plan, RawTwist, Remember, Say, Step, Wait
from chatrobot.plan.text import parse_plan

LEAST_M, LEAST_RAD = 0.01, math.radians(1.0)
"""A turn that moved the robot less than this, and drove no step, did not move it."""

Way = Union[tuple[Step, ...], None]
"""Steps from one pose to another; None where they are not known, and only the poses are."""


@dataclass(frozen=True)
class Walk:
    """What a turn did in the ledger: `undo` took the last `count` entries back, `redo` did one again."""

    kind: Literal["undo", "redo"]
    count: int = 1


@dataclass(frozen=True)
class TurnRecord:
    """One turn as it really ended. Poses are in the odom frame; `plan` is None where nothing was to move.

    `executed` and `remaining` are the parts of the plan that were driven and were not, as measured. `lost` is the
    code of the reason why nobody can tell any more how the robot gets back to where the turn began. `program`: a
    program drove, which the session keeps under that number; 0 for none. `duration_s` is None where nobody timed it.
    `told` is how its end was told, with what was measured. `corrects`: it put the turn before right.
    `wanted` is the plan of a turn that was refused.
    """

    text: str
    outcome: Outcome
    plan: Plan | None = None
    start_pose: Pose = ORIGIN
    end_pose: Pose = ORIGIN
    executed: Plan | None = None
    remaining: Plan | None = None
    walk: Walk | None = None
    lost: str = ""
    program: int = 0
    duration_s: float | None = None
    told: str = ""
    corrects: bool = False
    wanted: Plan | None = None

    @property
    def way(self) -> Way:
        """The steps that were driven."""
        return self.executed.steps if self.executed is not None else None

    @property
    def moved(self) -> bool:
        """The robot moved, or nobody measured whether it did."""
        done = self.executed or (self.plan if self.lost else None)
        off = self.end_pose.distance_to(self.start_pose), abs(self.end_pose.yaw_rad - self.start_pose.yaw_rad)
        return (done is not None and _moves(done.steps)) or off[0] > LEAST_M or off[1] > LEAST_RAD


@dataclass(frozen=True)
class Entry:
    """A turn that moved, or several as one.

    Attributes:
        way: the steps from `before` to `after`.
        back: the steps from where the robot stood last to `before`.
        forth: the same to `after`; empty where nothing has been undone.
        lost: see `TurnRecord`.
        programs: the programs among its turns, see `TurnRecord`.
        turns: how many turns it is.
    """

    before: Pose
    after: Pose
    way: Way
    back: Way
    forth: Way = ()
    lost: str = ""
    programs: tuple[int, ...] = ()
    turns: int = 1


class Ledger:
    """What can be undone and done again after `turns`, the last one last."""

    def __init__(self, turns: Iterable[TurnRecord]) -> None:
        self.done: list[Entry] = []
        self._undone: list[Entry] = []
        self._walked = False
        for record in turns:
            if record.moved or (record.walk is not None and record.plan and record.outcome == "completed"):
                self._take(record)

    def undoes(self, count: int) -> Entry:
        """The entry that an undo of the last `count` walks back.

        Raises:
            Unclear: there are not as many, or the way back is lost.
        """
        if not 1 <= count <= len(self.done):
            raise Unclear("nothing_to_undo")
        return _usable(reduce(_joined, self.done[len(self.done) - count :]))

    def redoes(self) -> Entry | None:
        """The entry that a redo walks forth: where an undo came directly before, what it took back.

        Raises:
            Unclear: the way is lost.
        """
        if not self._walked:
            return None
        if self.done and self.done[-1].forth != ():
            return _usable(self.done[-1])
        return _usable(self._undone[-1]) if self._undone else None

    def _take(self, record: TurnRecord) -> None:
        walk = record.walk
        if walk is None:
            if self.done:
                self.done[-1] = replace(self.done[-1], forth=())
            way = record.way
            programs = (record.program,) if record.program else ()
            poses = (record.start_pose, record.end_pose)
            self.done.append(Entry(*poses, way, _inverse(way), (), record.lost, programs))
            self._undone.clear()
        elif walk.kind == "undo":
            self._take_undo(walk.count, record)
        else:
            self._take_redo(record)
        self._walked = walk is not None

    def _take_undo(self, count: int, record: TurnRecord) -> None:
        if len(self.done) < count:  # what it undid has been forgotten since
            return
        first = len(self.done) - count
        entry = _with_loss(reduce(_joined, self.done[first:]), record.lost)
        del self.done[first:]
        if record.outcome == "completed":
            self._undone.append(replace(entry, back=(), forth=entry.way))
        else:
            driven = _inverse(record.way)
            self.done.append(replace(entry, back=_rest(record), forth=_chained(driven, entry.forth)))

    def _take_redo(self, record: TurnRecord) -> None:
        stack = self.done if self.done and self.done[-1].forth != () else self._undone
        if not stack:
            return
        entry = _with_loss(stack.pop(), record.lost)
        if record.outcome == "completed":
            self.done.append(replace(entry, back=_inverse(entry.way), forth=()))
        else:
            driven = _inverse(record.way)
            self.done.append(replace(entry, back=_chained(driven, entry.back), forth=_rest(record)))


def _usable(entry: Entry) -> Entry:
    if entry.lost:
        raise Unclear(entry.lost, refused=True)
    return entry


def _joined(first: Entry, then: Entry) -> Entry:
    """Two entries, one after the other, as one."""
    return Entry(
        first.before,
        then.after,
        _chained(first.way, then.way),
        _chained(then.back, first.back),
        then.forth,
        first.lost or then.lost,
        (*first.programs, *then.programs),
        first.turns + then.turns,
    )


def _with_loss(entry: Entry, lost: str) -> Entry:
    return replace(entry, lost=entry.lost or lost)


def _rest(record: TurnRecord) -> Way:
    return record.remaining.steps if record.remaining is not None else None


def _inverse(way: Way) -> Way:
    try:
        return tuple(inverse(list(way))) if way is not None else None
    except Unclear:
        return None


def _chained(first: Way, then: Way) -> Way:
    return None if first is None or then is None else (*first, *then)


def _moves(steps: Sequence[Step]) -> bool:
    return any(_drives(step) for step in steps)


def _drives(step: Step) -> bool:
    """It moves the robot, wherever that stands: `go` and `face` may find it there already."""
    if isinstance(step, Block):
        return _moves(step.steps)
    if isinstance(step, RawTwist):
        return any((step.vx_mps, step.vy_mps, step.wz_radps))
    return not isinstance(step, (Wait, Say, Remember, Go, Face))


def plan_in(text: str) -> Plan | None:
    """The plan that a text is; None where it is empty, or too large for a plan: many runs of a turn."""
    try:
        return parse_plan(text) if text else None
    except PlanTextError:
        return None


def plan_of(steps: Sequence[Step]) -> Plan | None:
    """All of the steps as one plan; None where there is none, or it would be too large for one."""
    try:
        return Plan(tuple(steps))
    except ValueError:
        return None
