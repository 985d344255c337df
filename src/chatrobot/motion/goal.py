"""A goal: one turn's plan on its way through Motion, received, rehearsed, approved, run, in one part or more.

Each part is rehearsed from where those before it will end, and all are walked as one, so that the robot does not stop
between the parts of a plan that still comes while it runs.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field, replace

from chatrobot.core.events import Finished, Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.link.envelope import Envelope, seconds
from chatrobot.link.motion_link import Approval
from chatrobot.motion.budgets import Account, Extent
from chatrobot.motion.planner import Planned
from chatrobot.plan.base import Step
from chatrobot.plan.context import MAX_DURATION_S
from chatrobot.plan.known_world import Floats
from chatrobot.plan.lowering import NOT_YET, CoreWalk, NotYet, PlannedMotion, WalkItem
from chatrobot.plan.rehearsal import Rehearsal
from chatrobot.plan.steps import MAX_LINES, count_steps
from chatrobot.plan.swept_path import Most

PARTS_LIMIT = MAX_LINES


class Stream:
    """Holds the parts of one goal, and the walk through those that were accepted. Belongs to the control thread.

    `is_open` while more may come; `refusal` is why a part was not accepted: those after it are dropped, those before
    it are still done. `possible` is what can be done of that part. A program is one part, without a walk.
    """

    def __init__(self, *, is_open: bool = False) -> None:
        self.is_open = is_open
        self._planning: str | None = None
        self._waiting: deque[str] = deque()
        self._count = 1
        self.refusal: Reason | None = None
        self.possible = ""
        self.rewind()

    def rewind(self) -> None:
        """Begin anew with the rest of what was accepted: it comes first, and those that were not rehearsed follow."""
        if self._planning is not None:
            self._waiting.appendleft(self._planning)
        self._planning = None
        self.walk: PartedWalk | None = None
        self.duration_s = self.length_m = 0.0
        self.certain = Extent()
        self.accepted: tuple[Step, ...] = ()
        self.paths: list[Floats] = []
        """The way of each part that was accepted, [n, 4]: a time, x, y and yaw a row."""
        self._has_unknown_part = False

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the parts that have not been rehearsed."""
        return tuple(self._waiting)

    def add(self, plan_text: str, more: bool) -> None:
        """Take in a part, which may be empty; nothing after the last one counts."""
        if not self.is_open:
            return
        self.is_open = more
        if plan_text.strip():
            self._count += 1
            self._waiting.append(plan_text)
        if self._count > PARTS_LIMIT:
            self.refuse(Reason("plan_too_large", {"steps": self._count}))

    def take(self) -> str | None:
        """Return the next part to rehearse; None while one is being rehearsed, or none waits."""
        if self._planning is not None or not self._waiting:
            return None
        self._planning = self._waiting.popleft()
        return self._planning

    def accept(self, planned: Planned, account: Account, longest_s: float) -> Reason | None:
        """Append the next part as it was rehearsed; return why it is not accepted."""
        self._planning = None
        duration_s, certain = self.duration_s + planned.duration_s, self.certain.plus(planned.certain)
        longest_s = min(longest_s, MAX_DURATION_S)
        refusal = planned.refusal
        if refusal is None and duration_s > longest_s:
            refusal = Reason("lasts_too_long", {"duration_s": duration_s, "max_s": longest_s})
        # The first part that is too much is refused; a later one ends what is under way.
        refusal = refusal or (account.refusal if self.walk is None else account.end)(certain)
        if refusal is not None:
            self.possible = planned.possible if refusal == planned.refusal else ""
            self.refuse(refusal)
            return refusal
        self.duration_s, self.certain = duration_s, certain
        self.length_m += planned.length_m
        if planned.shown is not None:
            self.paths.append(planned.shown.path)
        self._has_unknown_part = self._has_unknown_part or planned.is_open_ended
        if planned.rehearsal is not None:
            self.accepted += planned.rehearsal.plan.steps
            if self.walk is None:
                self.walk = PartedWalk(self, planned.rehearsal)
            else:
                self.walk.add(planned.rehearsal)
        return None

    def refuse(self, reason: Reason) -> None:
        """Take nothing more, for that reason."""
        self.refusal = self.refusal or reason
        self.is_open = False
        self._waiting.clear()

    @property
    def is_open_ended(self) -> bool:
        """True where the whole way is not known."""
        return self.may_go_on or self._has_unknown_part

    @property
    def may_go_on(self) -> bool:
        """True while another part may still become part of the walk."""
        return self.is_open or self._planning is not None or bool(self._waiting)


class PartedWalk:
    """Walks part after part; `NOT_YET` where the next one is still to come. Made with the first part."""

    def __init__(self, stream: Stream, first: Rehearsal) -> None:
        self._stream = stream
        self._parts: deque[Rehearsal] = deque()
        self._walk: CoreWalk | None = None
        self._pose = first.context.pose
        self._end = self._pose
        self._numbers_before = self._steps_before = 0
        self._walked = (0, 0)
        self._total = 0
        self.add(first)

    def add(self, part: Rehearsal) -> None:
        """Append a part to the end of the walk."""
        self._parts.append(part)
        self._end = part.end_pose
        self._total += count_steps(part.plan.steps)

    @property
    def pose(self) -> Pose:
        """Return where the last motion ends."""
        return self._walk.pose if self._walk is not None else self._pose

    @property
    def end(self) -> Pose:
        """Return where all that was accepted will end, or did where it has been walked already."""
        return self._end if self._parts or self._walk is not None else self._pose

    def ended_at(self, pose: Pose) -> None:
        """Go on from `pose`, where the last motion ended."""
        if self._walk is not None:
            self._walk.ended_at(pose)
        else:
            self._pose = pose

    def __next__(self) -> WalkItem:
        while True:
            item = next(self._walk, None) if self._walk is not None else None
            if isinstance(item, PlannedMotion):
                return self._counted(item)
            if item is not None:
                return item
            if not self._begin_part():
                return self._nothing()

    def _nothing(self) -> NotYet:
        if self._stream.may_go_on:
            return NOT_YET
        raise StopIteration

    def _begin_part(self) -> bool:
        if self._walk is not None:
            self._pose, self._walk = self._walk.pose, None
        if not self._parts:
            return False
        part = self._parts.popleft()
        steps, numbers = self._walked
        self._steps_before += steps
        self._numbers_before += numbers
        self._walked = (len(part.plan.steps), count_steps(part.plan.steps))
        # From where the part before it really ended: its condition may have come true early.
        self._walk = CoreWalk(part.plan, replace(part.context, pose=self._pose))
        return True

    def _counted(self, item: PlannedMotion) -> PlannedMotion:
        """Numbered as a step of the whole."""
        index = (self._steps_before + item.index[0], *item.index[1:])
        return replace(item, index=index, number=self._numbers_before + item.number, total_steps=self._total)


@dataclass
class Goal:
    """`epoch` is the stop epoch it was received in: a later stop makes it void. `start` is where it begins.

    `longest_s` is what the source may take: a plan that rehearsal expects to last longer is refused. `stream` holds
    its parts: one that begins with `plan_text`, and those that follow while it runs. `planned` is the first of them.
    `account` is what its text may drive, and has driven. Where the goal is the rest of a plan that was paused,
    `plan_start` is where the whole began and `so_far` what was measured of it.
    """

    turn: int
    lease: str
    plan_text: str
    approve: bool
    rehearse_only: bool
    epoch: int
    received_s: float
    longest_s: float = math.inf
    start: Pose = ORIGIN
    planned: Planned | None = None
    approval: Approval | None = None
    stream: Stream = field(default_factory=Stream)
    pauses: int | None = None
    account: Account = field(default_factory=Account)
    plan_start: Pose | None = None
    so_far: Finished | None = None

    @classmethod
    def of(cls, envelope: Envelope, epoch: int, now_s: float, account: Account | None = None) -> Goal:
        """Make the goal that a `plan` envelope asks for."""
        payload = envelope.payload
        approve, rehearse_only = bool(payload.get("approve")), bool(payload.get("rehearse_only"))
        return cls(
            turn=envelope.turn,
            lease=envelope.lease,
            plan_text=str(payload.get("plan_text", "")),
            approve=approve,
            rehearse_only=rehearse_only,
            epoch=epoch,
            received_s=now_s,
            longest_s=seconds(payload.get("longest_s"), math.inf),
            stream=Stream(is_open=bool(payload.get("more")) and not (approve or rehearse_only)),
            pauses=payload.get("pauses"),
            account=account or Account(),
        )

    @property
    def refusal(self) -> Reason | None:
        """Return why what was planned may not run."""
        return self.stream.refusal

    @property
    def length_m(self) -> float:
        """Return the length of the whole way, as it was rehearsed."""
        return self.stream.length_m

    @property
    def is_open_ended(self) -> bool:
        """True where the whole way is not known."""
        return self.stream.is_open_ended

    @property
    def left(self) -> Most:
        """Return what its budget leaves for what comes next."""
        return self.account.left(self.stream.certain)

    def take(self, planned: Planned) -> Reason | None:
        """Append the next part as it was rehearsed; return why it may not run."""
        self.planned = self.planned or planned
        return self.stream.accept(planned, self.account, self.longest_s)

    def forget_rehearsal(self) -> None:
        """Be rehearsed anew: it was only tried."""
        self.planned = None
        self.stream.rewind()

    @property
    def asks(self) -> bool:
        """Tell whether what was planned waits for a yes."""
        return self.approve and self.refusal is None and not self.rehearse_only

    def unmoved(self, outcome: Outcome, reason: Reason | None, pose: Pose) -> Finished:
        """Return its end where nothing moved."""
        is_blocked = outcome == "refused" and reason == self.stream.refusal
        # The way that was still to be driven, where a part of it was driven before a pause.
        left_m = max(0.0, self.so_far.planned_m - self.so_far.path_m) if self.so_far is not None else 0.0
        unmoved = Finished(self.turn, outcome, reason, pose, pose, 0.0, 0.0, 0.0, 0.0, planned_m=left_m)
        possible = self.stream.possible if is_blocked else ""
        remaining = self._unread if outcome == "stopped" and not self.rehearse_only else ""
        return self.whole(replace(unmoved, possible=possible, remaining=remaining))

    def whole(self, finished: Finished) -> Finished:
        """Return its end together with what was done before it was paused."""
        return self.so_far.resumed_by(finished) if self.so_far is not None else finished

    @property
    def _unread(self) -> str:
        """All the plan text that came."""
        return "\n".join(part.strip("\n") for part in (self.plan_text, *self.stream.waiting))


def handed_over(source: str, to: str) -> Reason:
    """Say that somebody else drives."""
    return Reason("handed_over", {"source": source, "to": to})
