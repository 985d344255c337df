"""Split a plan at the point that was reached: what of it was executed, and what remains.

Driving both parts, one after the other, is driving the whole. Undo reverses the first, resume drives the second.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.base import Block, Plan, Step, count_steps
from chatrobot.plan.context import Impossible, LoweringContext
from chatrobot.plan.lowering import lower
from chatrobot.plan.primitive import BlockPrimitive, for_step
from chatrobot.plan.primitives.drive import Go
from chatrobot.plan.primitives.no_motion import Remember, Repeat, Say, Wait
from chatrobot.plan.primitives.twist import RawTwist
from chatrobot.plan.trajectory import CoreMotion, Emit, Pause, RampedTwist


@dataclass(frozen=True)
class Reached:
    """Tells how far a plan was driven.

    Steps are numbered as in `PlannedMotion`: from 1, repeats counted each time.

    Attributes:
        steps_done: steps that were driven to their end.
        is_under_way: the step after those was begun.
        motions_done: core motions of that step that were driven to their end.
        share: how much of the core motion after those was driven, 0 to 1.
        step_start: the pose at which that step began.
        ended_early: steps that their condition ended, and how much of each was driven, 0 to 1.
    """

    steps_done: int = 0
    is_under_way: bool = False
    motions_done: int = 0
    share: float = 0.0
    step_start: Pose = ORIGIN
    ended_early: Mapping[int, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Parts:
    """The two parts of a plan. None: that part is empty, or it needs more lines than a plan may have."""

    executed: Plan | None
    remaining: Plan | None


def split(steps: Sequence[Step], reached: Reached, context: LoweringContext) -> Parts:
    """Split the plan of these `steps`.

    The frame `start` is resolved in both parts, because either may begin elsewhere.

    Args:
        context: `pose` is where the robot stands now, `plan_start` where the plan began.
    """
    executed, remaining = _Split(reached, context).all(steps)
    start = context.plan_start
    try:
        done = _plan(_resolved(executed, start))
    except ValueError:  # too many lines: the way is lost, not its end
        done = Plan((Go.to_pose(context.pose),))
    try:
        return Parts(done, _plan(_resolved(remaining, start)))
    except ValueError:
        return Parts(done, None)


def _plan(steps: Sequence[Step]) -> Plan | None:
    return Plan(tuple(steps)) if steps else None


def _resolved(steps: Iterable[Step], plan_start: Pose) -> list[Step]:
    found: list[Step] = []
    for step in steps:
        if isinstance(step, Repeat):
            found.append(replace(step, steps=tuple(_resolved(step.steps, plan_start))))
            continue
        primitive = for_step(step)
        found.append(step if isinstance(primitive, BlockPrimitive) else primitive.resolve(step, plan_start))
    return found


Divided = tuple[tuple[Step, ...], tuple[Step, ...]]


class _Split:
    """Walks the plan once. `_number` counts the steps that it has come past."""

    def __init__(self, reached: Reached, context: LoweringContext) -> None:
        self._reached = reached
        self._context = context
        self._early = sorted(reached.ended_early)
        self._number = 0

    def all(self, steps: Sequence[Step]) -> Divided:
        done: list[Step] = []
        rest: list[Step] = []
        for step in steps:
            step_done, step_rest = self._step(step)
            done += step_done
            rest += step_rest
        return tuple(done), tuple(rest)

    def _step(self, step: Step) -> Divided:
        whole = self._whole(count_steps((step,)))
        if whole is not None:
            return ((step,), ()) if whole else ((), (step,))
        if isinstance(step, Block):
            return self._block(step)
        self._number += 1
        if self._number <= self._reached.steps_done:
            share = self._reached.ended_early[self._number]
            return self._divided(step, share)[0], ()  # its condition came true: nothing of it is left
        return self._divided(step, self._reached.share)

    def _whole(self, count: int) -> bool | None:
        """Return True where the next `count` steps were all done, False where none was begun; None: neither."""
        reached, after = self._reached, self._number + count
        if after <= reached.steps_done and not self._some_early(self._number, after):
            self._number = after
            return True
        if self._number > reached.steps_done or (
            self._number == reached.steps_done and not reached.is_under_way
        ):
            self._number = after
            return False
        return None

    def _some_early(self, first_number: int, last_number: int) -> bool:
        return bisect_right(self._early, first_number) < bisect_right(self._early, last_number)

    def _block(self, block: Block) -> Divided:
        count = count_steps(block.steps)
        rounds: list[Divided] = []
        for _ in range(block.times):
            whole = self._whole(count)
            if whole is None:
                rounds.append(self.all(block.steps))
            else:
                rounds.append((block.steps, ()) if whole else ((), block.steps))
        return _joined(block, [done for done, _ in rounds]), _joined(block, [rest for _, rest in rounds])

    def _divided(self, step: Step, share: float) -> Divided:
        primitive = for_step(step)
        if isinstance(primitive, BlockPrimitive):
            raise TypeError(f"{type(step).__name__} is a block")
        done, rest = primitive.divide(step, share, self._context)
        if done is None and rest is None:
            return self._divided_motions(step, share)
        return (done,) if done is not None else (), (rest,) if rest is not None else ()

    def _divided_motions(self, step: Step, share: float) -> Divided:
        """Divide a step whose primitive does not: its core motions become steps of their own."""
        motions = lower(step, replace(self._context, pose=self._reached.step_start))
        if isinstance(motions, Impossible):
            return (), (step,)
        done, under_way = motions[: self._reached.motions_done], motions[self._reached.motions_done :]
        first: Divided = ((), ())
        if under_way and not isinstance(under_way[0], Emit):  # what is told is told at once
            found = _as_steps(under_way[:1])
            first, under_way = self._divided(found[0], share), under_way[1:]
        return (*_as_steps(done), *first[0]), (*first[1], *_as_steps(under_way))


def _joined(block: Block, rounds: Sequence[tuple[Step, ...]]) -> tuple[Step, ...]:
    """Join the rounds of a block; those that are whole are one block again."""
    joined: list[Step] = []
    for is_whole, group in groupby(rounds, key=lambda steps: steps == block.steps):
        alike = list(group)
        if is_whole and len(alike) == block.times:
            joined.append(block)
        elif is_whole and len(alike) > 1:
            joined.append(Repeat(len(alike), block.steps))
        else:
            joined += [step for steps in alike for step in steps]
    return tuple(joined)


def _as_steps(motions: Iterable[CoreMotion]) -> list[Step]:
    return [step for step in map(_as_step, motions) if step is not None]


def _as_step(motion: CoreMotion) -> Step | None:
    """Return the step that is this one motion; None for what a third party tells."""
    if isinstance(motion, RampedTwist):
        return RawTwist(*motion.twist, duration_s=motion.hold_s)
    if isinstance(motion, Pause):
        return Wait(motion.duration_s)
    kinds = {"say": Say, "remember": Remember}
    return kinds[motion.kind](motion.text) if isinstance(motion, Emit) and motion.kind in kinds else None
