"""`Not enough, I want 1.2 m in all`: what is missing to a total, the same way."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.frames import GO, Frame
from chatrobot.language.last_motion import steps_of, unit_driven_m
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.manner import Pace
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step, Turn


def to_total(whole: Frame, context: Context, pace: Pace) -> list[Step]:
    """The last motion brought to the total that is said, on the same way or back.

    Raises:
        Unclear: where the last motion was none that a total fits.
    """
    last = context.dialogue.last_motion
    steps = steps_of(last)
    assert last is not None
    moved = last.end_pose.relative_to(last.start_pose)
    step = steps[-1]
    said = set(whole.q)
    whole = _with_unit(whole, last, step)
    if "length" in whole.q and isinstance(step, Drive) and len(steps) == 1:
        done = math.hypot(moved.x_m, moved.y_m)
        if "to_start" in whole.flags or "total" in whole.flags:
            done = max(done, last.end_pose.distance_to(_run_start(context, step)))
        if "number" in said and not done / 10 <= whole.q["length"].number <= 10 * done:
            raise Unclear("no_unit", whole.text)  # `too slow, 0.2`: hardly 0.2 cm, after 30 cm
        missing = _missing(whole, whole.q["length"].number, done)
        if missing <= 0.0 and whole.verb in GO:
            raise Unclear("contradiction", whole.text)  # `go on to 1 m`, after 2 m
        if missing > 0.005:
            return [
                Drive(
                    missing, direction_rad=step.direction_rad, speed_mps=pace.speed(whole) or step.speed_mps
                )
            ]
        return [Drive(-missing, direction_rad=math.remainder(step.direction_rad + math.pi, 2 * math.pi))]
    angle = whole.q.get("angle") or whole.q.get("turns")
    if angle and isinstance(step, Turn) and len(steps) == 1:
        missing = _missing(whole, angle.number, abs(moved.yaw_rad))
        return [Turn(abs(missing), left=step.left if missing > 0 else not step.left)]
    raise Unclear("nothing_before", whole.text)


def _missing(whole: Frame, told: float, done: float) -> float:
    """What is missing: `not enough, another 30`, after 60, is no total, nor is `not enough, again 30`.

    Raises:
        Unclear: for what may be either: `not enough, again 90`, after 60.
    """
    if "more" in whole.flags or ("again" in whole.flags and told < done):
        return told
    if "again" in whole.flags:
        raise Unclear("contradiction", whole.text)
    return told - done


def _with_unit(whole: Frame, last: TurnRecord, step: Step) -> Frame:
    """`make that 60`, after a turn: degrees; after a drive: in the unit that was said."""
    number = whole.q.get("number")
    unit_m = unit_driven_m(last) if isinstance(step, Drive) else None
    if number is None or not (unit_m or isinstance(step, Turn)):
        return whole
    whole = whole.copy()
    del whole.q["number"]
    name, factor = ("length", unit_m) if unit_m else ("angle", math.radians(1.0))
    whole.q[name] = quantity(name, number.number * factor, number.text)
    return whole


def _run_start(context: Context, step: Drive) -> Pose:
    """Where the unbroken run of drives in one direction began that the last turn belongs to."""
    start = context.state.pose
    for turn in reversed(context.dialogue.turns):
        if turn.plan is None:
            continue
        same = all(isinstance(s, Drive) and s.direction_rad == step.direction_rad for s in turn.plan.steps)
        if not same:
            break
        start = turn.start_pose
    return start
