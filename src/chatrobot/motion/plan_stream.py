"""A plan that comes in parts while it runs: each is rehearsed from where the ones before it will end, and all of them
are walked as one, so that the robot does not stop where a whole plan would not."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.motion.budgets import Account, Extent
from chatrobot.motion.planner import Planned
from chatrobot.plan.base import Step
from chatrobot.plan.context import MAX_DURATION_S
from chatrobot.plan.lowering import NOT_YET, CoreWalk, NotYet, PlannedMotion, WalkItem
from chatrobot.plan.rehearsal import Rehearsal
from chatrobot.plan.steps import MAX_LINES, count_steps

PARTS_LIMIT = MAX_LINES


class Stream:
    """The parts of one turn's plan, and the walk through those that were accepted. Belongs to the control thread.

    `is_open` while more may come; `refusal` is why a part was not accepted: those after it are dropped, those before
    it are still done. `possible` is what can be done of that part.
    """

    def __init__(self, longest_s: float, account: Account) -> None:
        self.is_open = True
        self._planning: str | None = None
        self.refusal: Reason | None = None
        self.possible = ""
        self.duration_s = self.length_m = 0.0
        self.certain = Extent()
        self.accepted: tuple[Step, ...] = ()
        self._account = account
        self._has_unknown_part = False
        self._longest_s = min(longest_s, MAX_DURATION_S)
        self._waiting: deque[str] = deque()
        self._count = 1
        self.walk: PartedWalk | None = None

    @property
    def steps(self) -> int:
        """How many were accepted."""
        return len(self.accepted)

    @property
    def waiting(self) -> tuple[str, ...]:
        """The parts that have not been rehearsed."""
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
        """The next part to rehearse; None while one is being rehearsed, or none waits."""
        if self.is_planning or not self._waiting:
            return None
        self._planning = self._waiting.popleft()
        return self._planning

    @property
    def is_planning(self) -> bool:
        """A part is being rehearsed."""
        return self._planning is not None

    def rewind(self) -> None:
        """Begin anew with the rest of what was accepted: it comes first, and those that were not rehearsed follow."""
        if self._planning is not None:
            self._waiting.appendleft(self._planning)
        self._planning, self.walk = None, None
        self.duration_s = self.length_m = 0.0
        self.certain, self.accepted = Extent(), ()

    def accept(self, planned: Planned) -> Reason | None:
        """The next part as it was rehearsed; why it is not accepted."""
        self._planning = None
        duration_s = self.duration_s + planned.duration_s
        refusal = planned.refusal
        if refusal is None and duration_s > self._longest_s:
            refusal = Reason("lasts_too_long", {"duration_s": duration_s, "max_s": self._longest_s})
        certain = self.certain.plus(planned.certain)
        # The first part that is too much is refused; a later one ends what is under way.
        refusal = refusal or (self._account.refusal if self.walk is None else self._account.end)(certain)
        if refusal is not None:
            self.possible = planned.possible if refusal == planned.refusal else ""
            self.refuse(refusal)
            return refusal
        assert planned.rehearsal is not None
        self.duration_s, self.certain = duration_s, certain
        self.length_m += planned.length_m
        self._has_unknown_part = self._has_unknown_part or planned.is_open_ended
        self.accepted += planned.rehearsal.plan.steps
        if self.walk is None:
            self.walk = PartedWalk(self, planned.rehearsal)
        else:
            self.walk.add(planned.rehearsal)
        return None

    def refuse(self, reason: Reason) -> None:
        """Nothing more is taken."""
        self.refusal = self.refusal or reason
        self.is_open = False
        self._waiting.clear()

    @property
    def is_open_ended(self) -> bool:
        """The whole way is not known."""
        return self.may_go_on or self._has_unknown_part

    @property
    def may_go_on(self) -> bool:
        """Another part may still become part of the walk."""
        return self.is_open or self.is_planning or bool(self._waiting)


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
        self._parts.append(part)
        self._end = part.end_pose
        self._total += count_steps(part.plan.steps)

    @property
    def pose(self) -> Pose:
        """Where the last motion ends."""
        return self._walk.pose if self._walk is not None else self._pose

    @property
    def end(self) -> Pose:
        """Where all that was accepted will end: as predicted, or as it did where it has been walked already."""
        return self._end if self._parts or self._walk is not None else self._pose

    def ended_at(self, pose: Pose) -> None:
        """See `CoreWalk`."""
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
        return replace(item, index=index, number=self._numbers_before + item.number, total=self._total)
