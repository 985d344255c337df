"""From a plan to core motions, lazily, step by step, chained at their ideal ends.

Rehearsal and executor walk the same walk, so what was rehearsed is what is driven. Each motion starts at the ideal
end of the one before: what the loop missed in one step is made good in the next instead of adding up.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol, Union

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.plan.base import Block, Plan, Step, count_steps
from chatrobot.plan.context import MAX_DURATION_S, Impossible, Lowered, LoweringContext, too_long
from chatrobot.plan.primitive import BlockPrimitive, for_step
from chatrobot.plan.trajectory import CoreMotion, RampedTwist
from chatrobot.robots.profile import RobotProfile


def lower(step: Step, context: LoweringContext) -> Lowered:
    """Return the core motions of one step (not of a block: `CoreWalk` walks those), or why it is impossible.

    Raises:
        TypeError: for a block.
    """
    primitive = for_step(step)
    if isinstance(primitive, BlockPrimitive):
        raise TypeError(f"{type(step).__name__} is a block: walk it with CoreWalk")
    if primitive.needs_pose and context.profile.open_loop:
        return Impossible(Reason("needs_odometry"))
    lowered = primitive.lower(step, context)
    if isinstance(lowered, Impossible):
        return lowered
    for motion in lowered:
        if isinstance(motion, RampedTwist) and not motion.hold_s <= MAX_DURATION_S:
            return Impossible(too_long(motion.hold_s))
    return lowered


@dataclass(frozen=True)
class PlannedMotion:
    """One core motion in its place in the plan.

    `index` is the path of the step: (2, 0) is the first step inside the third. `number` of `total` counts steps
    with repeats done, from 1. `first` and `last` mark the ends of the step; a step that needs no motion at all
    (facing where it faces already) has one item with `motion` None. Poses are ideal ones, in the odom frame.
    """

    index: tuple[int, ...]
    number: int
    total_steps: int
    step: Step
    motion: CoreMotion | None
    start: Pose
    end: Pose
    first: bool
    last: bool


CoreItem = Union[PlannedMotion, Impossible]


class NotYet:
    """Stands for an item that is still to come."""


NOT_YET: Final = NotYet()
WalkItem = Union[CoreItem, NotYet]


class Walk(Protocol):
    """Yields what an executor drives; `CoreWalk` is the one through a whole plan."""

    @property
    def pose(self) -> Pose:
        """Return where the last motion ends, or the first one will begin."""
        ...

    def __next__(self) -> WalkItem:
        """Return what comes next; raises StopIteration at the end."""
        ...

    def ended_at(self, pose: Pose) -> None:
        """Go on from `pose`: the last motion really ended there."""
        ...


class CoreWalk(Iterator[CoreItem]):
    """Iterates over the motions of a plan; ends after the first `Impossible`.

    The next step is lowered only when it is asked for, from `pose`.
    """

    def __init__(self, plan: Plan, context: LoweringContext) -> None:
        self.pose = context.pose
        self._context = context
        self._total = count_steps(plan.steps)
        self._items = self._walk(plan)

    def __next__(self) -> CoreItem:
        return next(self._items)

    def ended_at(self, pose: Pose) -> None:
        """Go on from `pose`: the last motion was cut short (its condition came true) or led elsewhere."""
        self.pose = pose

    def _walk(self, plan: Plan) -> Iterator[CoreItem]:
        for number, (index, step) in enumerate(_expanded(plan.steps, ()), start=1):
            motions = lower(step, replace(self._context, pose=self.pose))
            if isinstance(motions, Impossible):
                yield replace(motions, index=index, number=number)
                return
            yield from self._motions(index, number, step, motions)

    def _motions(
        self, index: tuple[int, ...], number: int, step: Step, motions: Sequence[CoreMotion]
    ) -> Iterator[CoreItem]:
        if not motions:
            yield PlannedMotion(index, number, self._total, step, None, self.pose, self.pose, True, True)
        for position, motion in enumerate(motions):
            start = self.pose
            self.pose = end = motion.end(start)
            first, last = position == 0, position == len(motions) - 1
            yield PlannedMotion(index, number, self._total, step, motion, start, end, first, last)


def ideal_end(plan: Plan, profile: RobotProfile, start: Pose) -> Pose | None:
    """Return where `plan` ends when it is driven exactly from `start`; None where a step of it is impossible.

    Ways around obstacles are left out: they change no end.
    """
    walk = CoreWalk(plan, LoweringContext(profile, start, start))
    return None if any(isinstance(item, Impossible) for item in walk) else walk.pose


def _expanded(steps: Sequence[Step], path: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], Step]]:
    for position, step in enumerate(steps):
        index = (*path, position)
        if isinstance(step, Block):
            for _ in range(step.times):
                yield from _expanded(step.steps, index)
        else:
            yield index, step
