"""The last motion changed: again, the other way, half of that, faster, `the same but two metres`."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from chatrobot.language.context import Dialogue
from chatrobot.language.edit_words import Edit
from chatrobot.language.edits import mirrored
from chatrobot.language.frames import DIRECTIONS, GO, SIDES, TURN, Frame
from chatrobot.language.inverse import flipped, is_sideways, leaves_of
from chatrobot.language.last_motion import atoms_said, laps, motion_meant, steps_of
from chatrobot.language.manner import Pace
from chatrobot.language.measures import whole_number
from chatrobot.language.numbers import is_chinese
from chatrobot.language.resizing import resized
from chatrobot.language.tokens import quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Face, Go, RawTwist, Repeat, Step, Turn, Wait


class Factors(NamedTuple):
    """What distances, radii and times are multiplied by, and what angles are."""

    distance: float
    angle: float


def is_change(whole: Frame) -> bool:
    """Whether a frame changes the last motion rather than naming one of its own.

    Raises:
        Unclear: for steps that are to be repeated but were never said, or until something holds.
    """
    if "same_amount" in whole.flags and "faster" not in whole.q:  # `twice as fast, same time`
        return False
    if "again" in whole.flags and ("count" in whole.q or {"until", "total"} & whole.flags):
        raise Unclear("nothing_before", whole.text)
    if whole.shape or whole.place:
        return False
    if whole.verb not in ("", "make", "again") and not _only_points_back(whole):
        return False
    if "times" in whole.q and "more" in whole.flags and not whole.has_extent:
        return True
    if "other_way" in whole.flags or "again" in whole.flags:
        return True
    return bool({"fold", "scale", "faster"} & set(whole.q)) and not whole.has_extent


def takes_from_before(frame: Frame) -> bool:
    """Whether it takes more than its side from the motion before: `then back`, 再走两遍."""
    return (
        "times" in frame.q or frame.verb == "return" or (frame.direction == "back" and not frame.has_extent)
    )


def steps_named(whole: Frame, dialogue: Dialogue) -> tuple[Step, ...]:
    """The steps of `motion_meant`; the last turn or slide alone where that is named: `do the slide again`.

    Raises:
        Unclear: nothing before was such a motion.
    """
    last = motion_meant(dialogue)
    is_kind = {"slide": is_sideways, "turn": _is_turn}.get(whole.verb)
    if is_kind is None or "again" not in whole.flags or whole.direction or whole.rot:
        return steps_of(last)
    of_kind = tuple(filter(is_kind, steps_of(last)))
    if of_kind:
        return of_kind if len(of_kind) == 1 else steps_of(last)
    plans = (turn.plan for turn in reversed(dialogue.turns) if turn.plan is not None and turn.walk is None)
    found = next((plan.steps for plan in plans if all(map(is_kind, plan.steps))), None)
    if found is None:
        raise Unclear("nothing_before", whole.text)
    return found


def _is_turn(step: Step) -> bool:
    return isinstance(step, (Turn, Arc))


def _only_points_back(whole: Frame) -> bool:
    """`turn the other way`, `go again`, `turn half of that`: a verb that names no motion of its own."""
    if {"again", "more"} <= whole.flags and whole.verb in (*GO, *TURN) and not whole.direction:
        return True  # `the same but go 20 cm further`
    if whole.verb not in (*GO, "turn", "spin", "curve"):
        return False
    if whole.has_extent:  # `turn 45 degrees the other way`
        return "other_way" in whole.flags and not (whole.direction or whole.rot)
    if whole.verb in (*GO, "turn"):
        again = "again" in whole.flags and (not whole.direction or whole.verb == "go")
        if again or ("scale" in whole.q and not whole.direction):
            return True
    return "other_way" in whole.flags and not whole.direction


def changed(before: Sequence[Step], whole: Frame, pace: Pace) -> list[Step]:
    """The steps `before` as `whole` wants them now.

    Raises:
        Unclear: where the change fits none of them, or several, or does not tell how much.
    """
    whole = _speed_said(_part_said(whole), before)
    if {"again", "bit"} <= whole.flags and not whole.q:
        raise Unclear(
            "how_far", " ".join(dict.fromkeys(whole.texts))
        )  # `again but a bit further`: by how much?
    fold = whole.q.get("fold")
    if fold is not None and is_chinese(fold.text):
        whole = whole.copy()
        del whole.q["fold"]
        name = "faster" if re.search("速|快|慢", fold.text) else "scale"
        whole.q[name] = quantity(name, fold.number, fold.text)
    whole = _round_other_way(before, whole)
    _check_other_way(before, whole)
    before = _taking(before, whole)
    before, whole = _mirrored(before, whole)
    before, whole = _of_sided_part(before, whole)
    if whole.verb in TURN and not all(isinstance(step, (Turn, Arc, Wait)) for step in leaves_of(before)):
        raise Unclear("nothing_before", whole.text)  # `the turn again`, of what drove as well
    factor = whole.q["scale"].number if "scale" in whole.q else 1.0
    if "percent" in whole.q and not whole.pace:
        factor = whole.q["percent"].number
    scale = whole.q.get("scale")
    if scale is not None and "of" in scale.text.split() and isinstance(before[0], Arc) and len(before) == 1:
        raise Unclear("which_size", scale.text)  # `half of it`, after a circle: of its radius, or of its way?
    factors = _factors(before, whole, factor)
    if "number" in whole.q or "count" in whole.q or "clock" in whole.q:
        raise Unclear("no_unit", next(whole.q[n].text for n in ("number", "count", "clock") if n in whole.q))
    ahead_rad = next((step.direction_rad for step in leaves_of(before) if isinstance(step, Drive)), 0.0)
    steps = [_step(step, whole, factors, pace, ahead_rad) for step in before]
    if factor != 1.0 and steps == list(before):  # `half the angle`, of what never turned
        raise Unclear("nothing_before", whole.text)
    count = whole.q.get("times")
    if count is not None and count.number == 1.0 and len(set(steps)) == 1:
        return steps[:1]  # `the other way once`, of what was done twice
    times = whole_number(count.number, count.text) if count is not None else 1
    sizes = [whole.q[name] for name in ("length", "angle", "turns", "time") if name in whole.q]
    if count is not None and not sizes:
        return steps * times
    out = resized(steps, Edit(amounts=sizes)) if "more" not in whole.flags or not sizes else None
    if out is None:
        raise Unclear("nothing_before", whole.text)
    return out * times


def _factors(steps: Sequence[Step], whole: Frame, factor: float) -> Factors:
    """`Twice as big`: distances and radii; the angles of a motion that only turned, or where the angle is named."""
    only_turned = all(isinstance(step, (Turn, Wait)) for step in leaves_of(steps))
    scale = whole.q.get("scale")
    if scale is not None and any(word in scale.text for word in ("angle", "角")):
        return Factors(1.0, factor)
    if only_turned or factor == 1.0:
        return Factors(factor, factor)
    return Factors(factor, 1.0)


def _round_other_way(steps: Sequence[Step], whole: Frame) -> Frame:
    """`The other way round`, after a closed shape: round it to the other side, and not backwards."""
    if "other_way" not in whole.flags or len(steps) < 2 or laps(steps, 1) is None:
        return whole
    whole = whole.copy()
    whole.flags = (whole.flags - {"other_way"}) | {"mirrored"}
    return whole


def _check_other_way(steps: Sequence[Step], whole: Frame) -> None:
    """`Drive 2 m, turn right`, then `the other way`: which of them?

    Raises:
        Unclear: for the opposite of drives and turns together.
    """
    kinds = {isinstance(step, Drive) for step in leaves_of(steps) if not isinstance(step, Wait)}
    is_opposite = "other_way" in whole.flags and "mirrored" not in whole.flags and not whole.has_extent
    if is_opposite and len(kinds) > 1:
        raise Unclear("nothing_before", whole.text)


def _taking(steps: Sequence[Step], whole: Frame) -> Sequence[Step]:
    """`10 degrees the other way`, after a drive and a turn: of the last of them, if it is the one that takes it.

    Raises:
        Unclear: it takes no such amount.
    """
    if "other_way" not in whole.flags or not whole.has_extent or len(steps) < 2:
        return steps
    takers = Drive if "length" in whole.q else (Turn, Arc) if {"angle", "turns"} & set(whole.q) else Step
    if not isinstance(steps[-1], takers):
        raise Unclear("nothing_before", whole.text)
    return steps[-1:]


def _mirrored(steps: Sequence[Step], whole: Frame) -> tuple[Sequence[Step], Frame]:
    """`Again, mirrored`: the steps with left and right exchanged, and what else is said of them.

    Raises:
        Unclear: where nothing was to a side, or another side is named than the one they go to then.
    """
    if "mirrored" not in whole.flags:
        return steps, whole
    out, whole = [flipped(step) for step in steps], whole.copy()
    if out == list(steps):
        raise Unclear("nothing_before", whole.text)
    side = whole.rot or whole.direction
    turning = [step for step in leaves_of(out) if isinstance(step, (Turn, Arc))]
    if side and (not turning or any(step.left != (side == "left") or side not in SIDES for step in turning)):
        raise Unclear("contradiction", whole.text)
    whole.rot = whole.direction = ""
    whole.flags -= {"mirrored", "other_way"}
    return out, whole


def _of_sided_part(before: Sequence[Step], whole: Frame) -> tuple[Sequence[Step], Frame]:
    """`The same but right`, of a turn and a drive: of the turn; of a slide and a drive: of the slide."""
    if whole.direction not in SIDES:
        return before, whole
    leaves = list(leaves_of(before))
    if any(isinstance(step, (Turn, Arc)) for step in leaves):
        whole = whole.copy()
        whole.rot, whole.direction = whole.rot or whole.direction, ""
    elif any(map(is_sideways, leaves)) and not all(map(is_sideways, leaves)):
        before = mirrored([*before], whole.direction == "left") or before
        whole = whole.copy()
        whole.direction = ""
    return before, whole


def _speed_said(whole: Frame, steps: Sequence[Step]) -> Frame:
    """`once more but at 0.5`, after a motion whose speed was said: a speed."""
    number = whole.q.get("number")
    paced = any(isinstance(s, (Drive, Arc)) and s.speed_mps for s in steps)
    if number is None or not paced or not 0 < number.number < 1 or whole.q.keys() != {"number"}:
        return whole
    whole = whole.copy()
    del whole.q["number"]
    whole.q["speed"] = quantity("speed", number.number, number.text)
    return whole


def _part_said(whole: Frame) -> Frame:
    """`Again but only half`: a fraction written out is a part of what was done."""
    number = whole.q.get("number")
    if number is None or not 0 < number.number < 1 or any(map(str.isdecimal, number.text)):
        return whole
    whole = whole.copy()
    del whole.q["number"]
    whole.q["scale"] = quantity("scale", number.number, number.text)
    return whole


def _step(step: Step, whole: Frame, factors: Factors, pace: Pace, ahead_rad: float) -> Step:
    if isinstance(step, Repeat):
        return Repeat(
            step.count, tuple(_step(inner, whole, factors, pace, ahead_rad) for inner in step.steps)
        )
    factor, opposite = factors.distance, "other_way" in whole.flags
    side = whole.rot or (whole.direction if whole.direction in SIDES else "")
    if isinstance(step, Drive):
        angle = step.direction_rad
        if whole.direction:  # what went back goes back from there, too
            angle = math.remainder(angle + DIRECTIONS[whole.direction] - ahead_rad, 2 * math.pi)
        elif opposite:
            angle = math.remainder(angle + math.pi, 2 * math.pi)
        distance = step.distance_m * factor if step.distance_m else None
        seconds = step.duration_s * factor if step.duration_s else None
        return dataclasses.replace(
            step,
            distance_m=distance,
            duration_s=seconds,
            direction_rad=angle,
            speed_mps=_speed(step.speed_mps, whole, pace),
        )
    if isinstance(step, Turn):
        if whole.direction and not side:
            raise Unclear("contradiction", whole.text)
        left = side == "left" if side else step.left != opposite
        angle_rad = step.angle_rad * factors.angle if step.angle_rad else None
        seconds = step.duration_s * factors.angle if step.duration_s else None
        said = dataclasses.replace(pace, rate_radps=step.rate_radps or pace.rate_radps).rate(whole)
        return dataclasses.replace(
            step, angle_rad=angle_rad, duration_s=seconds, left=left, rate_radps=said or step.rate_radps
        )
    if isinstance(step, Arc):
        left = side == "left" if side else step.left != opposite
        return dataclasses.replace(
            step,
            left=left,
            radius_m=step.radius_m * factor,
            angle_rad=step.angle_rad * factors.angle,
            speed_mps=_speed(step.speed_mps, whole, pace),
        )
    if isinstance(step, RawTwist) and not side:
        sign = -1.0 if opposite else 1.0
        return RawTwist(
            sign * step.vx_mps, sign * step.vy_mps, sign * step.wz_radps, step.duration_s * factor
        )
    if isinstance(step, (Go, Face)) and (factors != (1.0, 1.0) or opposite or side):
        raise Unclear("nothing_before", whole.text)
    return step


def _speed(old: float | None, whole: Frame, pace: Pace) -> float | None:
    if not whole.pace and not {"speed", "fold", "faster"} & set(whole.q):
        return old or pace.speed_mps  # `a bit slower next time`, then `again`
    usual = old or pace.speed_mps or pace.profile.defaults.speed_mps
    if "faster" in whole.q:
        return whole.q["faster"].number * usual
    if whole.pace == "slow":
        return usual * 0.5
    if whole.pace == "fast":
        return min(usual * 1.7, pace.profile.limits.max_speed_mps)
    return pace.speed(whole)


def a_bit_of(dialogue: Dialogue, whole: Frame, pace: Pace) -> Step:
    """`a bit more`: the last motion's way, a little; as much as before where that was a bit, too.

    Raises:
        Unclear: the last motion was more than one drive or turn.
    """
    last = dialogue.last_motion
    steps = steps_of(last)
    step = steps[-1]
    was_bit = last is not None and any(atom.value == "bit" for atom in atoms_said(last.text))
    part = 0.5 if "bit" in whole.flags and not was_bit else 1.0
    if len(steps) == 1 and isinstance(step, Drive):
        bit_m = min(pace.distance_m / 2, step.distance_m or math.inf)  # no more than there was
        return dataclasses.replace(step, distance_m=bit_m, duration_s=None)
    if len(steps) == 1 and isinstance(step, Turn):
        bit_rad = min(pace.turn_rad / 2, part * (step.angle_rad or math.inf))
        return dataclasses.replace(step, angle_rad=bit_rad, duration_s=None)
    raise Unclear("nothing_before", whole.text)
