"""`Undo that`, `undo the last two`, the same way back, `redo`: turns that walk the ledger of earlier turns."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.language.context import Context
from chatrobot.language.frames import Frame
from chatrobot.language.inverse import inverse
from chatrobot.language.ledger import Walk, Way
from chatrobot.language.manner import Pace
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import with_each
from chatrobot.plan.lowering import ideal_end
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, Step, Turn
from chatrobot.robots.profile import RobotProfile

PACES = frozenset({"speed", "percent", "fold", "faster"})
"""Quantities that say how fast."""

NEAR_M, NEAR_RAD = 0.01, math.radians(0.6)
"""Steps that end within this of the pose they are to lead to lead there."""
FAR_M, FAR_RAD = 0.3, math.radians(20.0)
"""Steps that end farther off than this do not lead there at all."""


@dataclass(frozen=True)
class Walked:
    """The steps of a turn that walks the ledger; `walk` is None where they are a part of an entry."""

    steps: tuple[Step, ...]
    walk: Walk | None

    def at_pace(self, whole: Frame, pace: Pace) -> Walked:
        """The same, as fast as `whole` says.

        Raises:
            Unclear: for a drive that lasted so long: is it to last as long, or to go as far?
        """
        if not (whole.pace or PACES & set(whole.q)):
            return self
        return replace(
            self,
            steps=tuple(with_each(step, lambda each: _at_pace(each, whole, pace)) for step in self.steps),
        )


def _at_pace(step: Step, whole: Frame, pace: Pace) -> Step:
    if isinstance(step, (Drive, Turn)) and step.duration_s is not None:
        raise Unclear("unclear_motion", whole.text)
    if isinstance(step, (Drive, Arc, Go)):
        return replace(step, speed_mps=pace.speed(whole))
    return replace(step, rate_radps=pace.rate(whole)) if isinstance(step, (Turn, Face)) else step


def undone(
    whole: Frame, context: Context, profile: RobotProfile, *, kind: type[Turn] | type[Drive] | None
) -> Walked:
    """`undo that`; `undo both`, `undo the last three`: so many turns that moved, the last one first.

    `kind`: it is said to have been a turn, or a drive.

    Raises:
        Unclear: where so many did not move, were nothing of that kind, or nobody knows the way back any more.
    """
    counts = [whole.q[name] for name in ("number", "count", "times") if name in whole.q]
    both = any(text.split()[-1] in ("both", "two") for text in whole.texts)
    count = counts[0].number if counts else 2.0 if both else 1.0
    if (
        not 1 <= count < math.inf
        or count != int(count)
        or set(whole.q) - {"number", "count", "times"} - PACES
    ):
        raise Unclear("unclear_motion", whole.text)
    turns: int | list[Step] = int(count)
    if "last_part" in whole.flags:  # of several steps one is taken back
        turns = [step for entry in context.dialogue.ledger.done for step in entry.way or ()][-1:]
        turns = 1 if len(context.dialogue.ledger.undoes(1).way or ()) == 1 else turns
    few = 1 == len(context.dialogue.ledger.done) < count
    if "last_leg" in whole.flags:  # a side with the turn behind it
        done = list(context.dialogue.ledger.undoes(1).way or ())
        legs = [k for k, step in enumerate(done) if isinstance(step, (Drive, Arc))]
        turns = done[legs[-1] :] if len(legs) > 1 else 1
    if "one_round" in whole.flags:
        turns = _one_round(context, whole.text)
    if "last_step" in whole.flags or (counts and counts[0].role == "step") or few:
        turns = _last_steps(int(count), context, whole.text)
    if not isinstance(turns, int):
        taken_back(context, profile, 1)
        return Walked(tuple(inverse(turns)), None)
    back = taken_back(context, profile, turns)
    way = context.dialogue.ledger.undoes(turns).way
    alike = way is not None and all(kind is None or isinstance(step, kind) for step in way)
    if kind is not None and not (alike and (kind is Turn or len(way or ()) == 1)):
        of_kind: list[Step] = [step for step in way or () if isinstance(step, kind)]
        if way and turns == 1 and of_kind == [way[-1]]:  # `undo the turn`, which came last
            return Walked(tuple(inverse(of_kind)), None)
        raise Unclear("unclear_motion", whole.text)
    return back


def taken_back(context: Context, profile: RobotProfile, count: int) -> Walked:
    """The way back to the pose before the last `count` turns that moved.

    Raises:
        Unclear: there were not as many, or nobody knows the way back any more.
    """
    entry = context.dialogue.ledger.undoes(count)
    _check_seen(context)
    return Walked(_leading_to(entry.before, entry.back, context.state.pose, profile), Walk("undo", count))


def redone(context: Context, profile: RobotProfile) -> Walked | None:
    """What an undo directly before took back, done again; None where there was no undo.

    Raises:
        Unclear: nobody knows the way any more.
    """
    entry = context.dialogue.ledger.redoes()
    if entry is None:
        return None
    _check_seen(context)
    return Walked(_leading_to(entry.after, entry.forth, context.state.pose, profile), Walk("redo"))


def all_taken_back(context: Context, profile: RobotProfile) -> Walked:
    """`Undo everything`: the way back to where the first turn that moved began.

    Raises:
        Unclear: where nothing was done, or nobody knows the way back any more.
    """
    return taken_back(context, profile, len(context.dialogue.ledger.done))


def last_two(context: Context, said: str, *, steps: bool) -> list[Step]:
    """The last two turns; with `steps`, the last two steps, if these are the same or there is but one turn.

    Raises:
        Unclear: where there were not as many, or it could mean either.
    """
    plans = [turn.plan for turn in context.dialogue.turns if turn.plan is not None]
    turns = [step for plan in plans[-2:] for step in plan.steps]
    if steps and (len(plans) < 2 or len(turns) > 2) and plans and len(plans[-1].steps) == 2:
        if len(plans) > 1:
            raise Unclear("unclear_motion", said)
        return turns
    if len(plans) == 1 and len(turns) == 2:
        return turns
    if len(plans) < 2:
        raise Unclear("nothing_before", said)
    return turns


def _check_seen(context: Context) -> None:
    if not context.state.has_said_so:
        raise Unclear("cannot_undo_unmeasured", refused=True)


def _leading_to(target: Pose, way: Way, here: Pose, profile: RobotProfile) -> tuple[Step, ...]:
    """`way` where it leads from `here` to `target`, with what it lacks; else a `go to`."""
    go = Go.to_pose(target)
    end = ideal_end(Plan(way), profile, here) if way else None
    if way is None or end is None:
        return (go,)
    off_m, off_rad = end.distance_to(target), abs(wrap_angle(end.yaw_rad - target.yaw_rad))
    if off_m > FAR_M or off_rad > FAR_RAD:
        return (go,)
    is_near = off_m <= NEAR_M and off_rad <= NEAR_RAD
    # A base that steers would drive a whole circle for a centimetre aside.
    return way if is_near or not profile.can_turn_on_the_spot else (*way, go)


def _one_round(context: Context, said: str) -> list[Step]:
    """`Undo one of those`: what the last motion did several times, once.

    Raises:
        Unclear: it did nothing several times.
    """
    steps = list(context.dialogue.ledger.undoes(1).way or ())
    once = once_of(steps) if steps else 0
    if once == len(steps):
        raise Unclear("unclear_motion", said)
    return steps[len(steps) - once :]


def once_of(steps: list[Step]) -> int:
    """How many of the steps come before they begin anew; all of them where they do not."""
    return next(n for n in range(1, len(steps) + 1) if steps == steps[:n] * (len(steps) // n))


def _last_steps(count: int, context: Context, said: str) -> int | list[Step]:
    """刚才两步: how many turns these are, where they are whole turns; else the steps themselves.

    Raises:
        Unclear: there are not as many, or as many turns would be something else.
    """
    ways = [entry.way or () for entry in context.dialogue.ledger.done]
    done = [step for way in ways for step in way]
    if len(done) < count:
        raise Unclear("nothing_to_undo")
    if len(ways) >= count:
        if [step for way in ways[-count:] for step in way] != done[-count:]:
            raise Unclear("unclear_motion", said)
        return count
    turns = (k for k in range(1, len(ways) + 1) if sum(map(len, ways[-k:])) == count)
    return next(turns, done[-count:])
