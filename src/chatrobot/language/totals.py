"""`Not enough, I want 1.2 m in all`: what is missing to a total, the same way."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.language.context import Context
from chatrobot.language.frames import GO, Frame
from chatrobot.language.last_motion import motion_meant, steps_of, turned_rad, unit_driven_m
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.manner import Pace
from chatrobot.language.meant import is_correction
from chatrobot.language.measures import whole_number
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import NEAR_M, NEAR_RAD, once_of
from chatrobot.plan.steps import Drive, Step, Turn, Wait


def to_total(whole: Frame, context: Context, pace: Pace) -> list[Step]:
    """The last motion brought to the total that is said, on the same way or back.

    Raises:
        Unclear: where the last motion was none that a total fits.
    """
    last, meant = context.dialogue.last_motion, motion_meant(context.dialogue)
    if last is None or meant is None:
        raise Unclear("nothing_before", whole.text)
    is_undone = meant is not last  # `undo that`, `I meant 2 m`: nothing is left of it
    ordered = meant if is_undone else _ordered_first(context.dialogue.turns, last)
    steps = steps_of(ordered)
    moved = ORIGIN if is_undone else last.end_pose.relative_to(ordered.start_pose)
    step = steps[-1]
    said = set(whole.q)
    if said == {"times"} and not whole.moves:
        return _rounds_missing(whole, steps, context)
    whole = _with_unit(_half_of(whole, step), meant, step)
    is_one = len(steps) == 1
    if not is_one and (is_undone or last is not ordered or not _ends_alone(last, steps)):
        raise Unclear("nothing_before", whole.text)
    if "length" in whole.q and isinstance(step, Drive):
        done = math.hypot(moved.x_m, moved.y_m) if is_one else step.distance_m or 0.0
        if "to_start" in whole.flags or "total" in whole.flags:
            done = max(done, last.end_pose.distance_to(_run_start(context, step)))
        if "number" in said and not is_undone and not done / 10 <= whole.q["length"].number <= 10 * done:
            raise Unclear("no_unit", whole.text)  # `too slow, 0.2`: hardly 0.2 cm, after 30 cm
        missing = _missing(whole, whole.q["length"].number, done)
        if missing <= 0.0 and whole.verb in GO:
            raise Unclear("contradiction", whole.text)  # `go on to 1 m`, after 2 m
        if abs(missing) < NEAR_M:
            raise Unclear("contradiction", whole.text)  # `two, not three`, after 2 m: it is there
        if missing > 0.0:
            return [
                Drive(
                    missing, direction_rad=step.direction_rad, speed_mps=pace.speed(whole) or step.speed_mps
                )
            ]
        return [Drive(-missing, direction_rad=math.remainder(step.direction_rad + math.pi, 2 * math.pi))]
    angle = whole.q.get("angle") or whole.q.get("turns")
    if angle and isinstance(step, Turn):
        # `no, right`: it has turned to the other side since.
        is_back = is_correction(last) and (moved.yaw_rad > 0.0) != step.left
        done = abs(moved.yaw_rad) if is_one else step.angle_rad or 0.0
        if "total" in whole.flags and not is_undone:  # `30`, `30 more`, `make it 90 in total`
            done = max(done, turned_rad(context.dialogue, step.left))
        missing = _missing(whole, angle.number, done)
        if abs(missing) < NEAR_RAD:
            raise Unclear("contradiction", whole.text)
        return [Turn(abs(missing), left=(step.left != is_back) == (missing > 0))]
    raise Unclear("nothing_before", whole.text)


def _ends_alone(last: TurnRecord, steps: Sequence[Step]) -> bool:
    """Whether a motion ended as told, with a step the only one of its kind: `left, then 40 cm`, `I meant 60`."""
    return last.outcome == "completed" and sum(type(step) is type(steps[-1]) for step in steps) == 1


def back_as_far_in_all(whole: Frame, context: Context, pace: Pace) -> list[Step] | None:
    """`Go back as far as you've gone altogether`, after drives in one direction: all of them; else None.

    Raises:
        Unclear: where the last motion was no drive.
    """
    if not {"same_amount", "total"} <= whole.flags or whole.direction != "back" or whole.has_extent:
        return None
    last = context.dialogue.last_motion
    steps = steps_of(last)
    if last is None or not isinstance(steps[-1], Drive):
        raise Unclear("nothing_before", whole.text)
    way_m = last.end_pose.distance_to(_run_start(context, steps[-1]))
    if way_m <= NEAR_M:
        raise Unclear("nothing_before", whole.text)
    back_rad = math.remainder(steps[-1].direction_rad + math.pi, 2 * math.pi)
    return [Drive(way_m, direction_rad=back_rad, speed_mps=pace.speed(whole))]


def _ordered_first(turns: Sequence[TurnRecord], last: TurnRecord) -> TurnRecord:
    """The turn that the last one put right, if it did, by a motion of its kind: `1 m`, `no, 2 m`, `no, 1.5`."""
    first = last
    for turn in reversed([turn for turn in turns if turn.plan is not None and turn is not last]):
        if not is_correction(first) or type(steps_of(turn)[-1]) is not type(steps_of(first)[-1]):
            break
        first = turn
    return first


def _rounds_missing(whole: Frame, steps: Sequence[Step], context: Context) -> list[Step]:
    """加上刚才的一共做五次: the motion before as often as is missing to so many times.

    Raises:
        Unclear: where it was done as often already.
    """
    once = list(steps[: once_of(list(steps))])
    done = 0
    for turn in reversed([turn for turn in context.dialogue.turns if turn.plan is not None]):
        same = list(turn.plan.steps) if turn.plan is not None else []
        if same != once * (len(same) // len(once)):
            break
        done += len(same) // len(once)
    missing = whole_number(whole.q["times"].number, whole.q["times"].text) - done
    if missing < 1:
        raise Unclear("contradiction", whole.text)
    return once * missing


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


def _half_of(whole: Frame, step: Step) -> Frame:
    """`No, just half`: of what was ordered, and not half a metre."""
    number = whole.q.get("number")
    amount = (
        step.distance_m if isinstance(step, Drive) else step.angle_rad if isinstance(step, Turn) else None
    )
    if number is None or number.number != 0.5 or any(map(str.isdecimal, number.text)) or not amount:
        return whole
    whole = whole.copy()
    del whole.q["number"]
    name = "length" if isinstance(step, Drive) else "angle"
    whole.q[name] = quantity(name, amount / 2, number.text)
    return whole


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
        moves = [s for s in turn.plan.steps if not isinstance(s, Wait)]
        same = all(isinstance(s, Drive) and s.direction_rad == step.direction_rad for s in moves)
        if not same:
            break
        start = turn.start_pose
    return start
