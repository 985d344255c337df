"""What a clause leaves out because it was said before: `thirty more`, `the same again`, `turn left 90`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from chatrobot.core.geometry import Pose
from chatrobot.language.frames import DIAGONALS, GO, SIDES, TURN, Frame
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Drive, Step, Turn, Wait

RATE = "rate"
"""The role of a bare number after `at`: how fast, and never how far."""
_SLIDING = frozenset({"no_turn", "sideways"})
_MOST_M, _LEAST_DEG = 2.0, 5.0
"""A bare number is so many metres at most, and so many degrees at least."""
_LEAST_MORE = 10.0
"""Of a bare number below it, `three more`, nobody can tell whether it counts rounds or units."""
_THE_SAME = ("the same", "do the same", "same", "likewise")


@dataclass
class State:
    """What the clauses before have left: for what is left out after them, and for the way back."""

    steps: list[Step] = field(default_factory=list)
    direction: str = "forward"
    unit_m: float | None = None
    chosen_m: float | None = None
    """The unit that numbers without one were said to be in, metres."""
    length: Atom | None = None
    sizes: dict[str, float] = field(default_factory=dict)
    """The side or the radius of the shape that was driven before, if all of them were alike, metres."""
    angle: Atom | None = None
    of_before: dict[str, Atom] = field(default_factory=dict)
    """How far the last drive went and the last turn turned, though others came after it."""
    left: bool | None = None
    last: str = ""
    home: Pose | None = None
    unsaid: list[Frame] = field(default_factory=list)


def completed(frame: Frame, state: State) -> Frame:
    """The frame with what it takes from the clauses before; `state` is told the amounts it says itself.

    Raises:
        Unclear: where nothing that could be meant was said.
    """
    length = frame.q.get("length")
    if length is not None and length.role:
        state.unit_m = float(length.role)
    _check_goes_on_sliding(frame, state)
    frame = _with_same_amount(_the_same_to(frame, state), state)
    state.length = frame.q.get("length", state.length)
    state.angle = frame.q.get("angle", frame.q.get("turns", state.angle))
    frame = _with_computed_length(frame, state)
    scale, before = frame.q.get("scale"), _amount_before(frame, state)
    if scale is not None and before is not None and frame.moves and not frame.has_extent:
        return _with(frame, "scale", quantity(before.value, before.number * scale.number, scale.text))
    return _with_unit(frame, state) if "number" in frame.q else frame


def _check_goes_on_sliding(frame: Frame, state: State) -> None:
    """`Slide right 1 m, then left`: to slide or to turn, and how far?

    Raises:
        Unclear: where a side alone comes after a slide.
    """
    slid = state.last == "drive" and state.direction in SIDES
    alone = frame.direction in SIDES and not (
        frame.verb or frame.rot or frame.q or frame.flags or frame.shape
    )
    if slid and alone and frame.joined != "start":
        raise Unclear("how_far", frame.text)


def _amount_before(frame: Frame, state: State) -> Atom | None:
    return state.angle if frame.turning else state.length


def _with(frame: Frame, name: str, amount: Atom) -> Frame:
    """The frame with `amount` in place of the quantity `name`."""
    frame = frame.copy()
    del frame.q[name]
    frame.q[amount.value] = amount
    return frame


def _the_same_to(frame: Frame, state: State) -> Frame:
    """`slide left 1 m and the same to the right`: as far, in the manner of the motion before.

    Raises:
        Unclear: where that motion was to no side, so that to turn or to slide could be meant.
    """
    said = any(text.startswith(_THE_SAME) for text in frame.texts)
    if not said or not frame.sided or frame.has_extent or frame.verb not in ("", "make") or not state.steps:
        return frame
    last, frame = next((s for s in reversed(state.steps) if not isinstance(s, Wait)), None), frame.copy()
    if isinstance(last, Turn):
        frame.verb = "turn"
    elif isinstance(last, Drive) and math.sin(last.direction_rad) ** 2 > 0.9:
        frame.verb = "slide"
    else:
        raise Unclear("unclear_motion", frame.text)
    if _amount_before(frame, state) is not None:
        frame.flags.add("same_amount")
    return frame


def _with_same_amount(frame: Frame, state: State) -> Frame:
    there = {"forward": "back", "back": "forward"}.get(frame.direction, "")
    and_back = (
        "again" in frame.flags and bool(state.steps) and state.last == "drive" and state.direction == there
    )
    if not (and_back or "same_amount" in frame.flags) or frame.has_extent:  # `back 40 cm and forward again`
        return frame
    before = _amount_before(frame, state) or state.of_before.get("angle" if frame.turning else "length")
    if before is None:
        raise Unclear("nothing_before", frame.text)
    frame = frame.copy()
    frame.q[before.value] = before
    frame.flags.discard("again")
    return frame


def _with_computed_length(frame: Frame, state: State) -> Frame:
    """`as far as 0.2 m/s for 5 s takes you`: the length it comes to."""
    asked = {"computed", "asked_distance"} & frame.flags
    if not (asked and {"speed", "time"} <= set(frame.q)):
        return frame
    frame = frame.copy()
    covered_m = frame.q.pop("speed").number * frame.q.pop("time").number
    frame.q["length"] = state.length = quantity("length", covered_m, f"{covered_m:g} m")
    return frame


def _with_unit(frame: Frame, state: State) -> Frame:
    """The frame's bare number with its unit, where only one unit can be meant."""
    number = frame.q["number"]
    if number.role == RATE:
        return frame
    if "转返" in frame.texts and state.last != "turn":
        raise Unclear("which_side", frame.text)
    if number.text == "一半" and not frame.has_extent:
        undone = frame.verb == "return" and state.last == "turn"
        turned = undone and not any(isinstance(step, Drive) for step in state.steps)
        before = state.angle if turned else _amount_before(frame, state)
        if before is not None:
            return _with(frame, "number", quantity(before.value, before.number / 2, number.text))
    unit = _meant_unit(frame, number.number, state)
    if unit is None:
        return frame
    dimension, factor = unit
    return _with(frame, "number", quantity(dimension, number.number * factor, number.text))


def _meant_unit(frame: Frame, value: float, state: State) -> tuple[str, float] | None:
    """The dimension a bare number has in this frame, and the SI value of one of it."""
    counts_rounds = "more" in frame.flags and not frame.moves and value < _LEAST_MORE
    if counts_rounds and state.last in ("turn", "drive") and state.unit_m != 1.0:
        raise Unclear("unclear_motion", frame.text)
    if counts_rounds and state.last == "turn":
        raise Unclear("no_unit", frame.q["number"].text)  # `3 m ahead, a quarter turn, another 1.5`
    degrees = _means_degrees(frame, value) and not _goes_on_aside(frame, state)
    if "units_said" in frame.flags and not degrees:
        if frame.turning:
            return "angle", math.radians(1.0)
        return "length", 0.01 if "units_cm" in frame.flags else 1.0
    if frame.verb == "wait" and set(frame.q) == {"number"} and not (frame.direction or frame.roles):
        return "time", 1.0  # `hold it there for five`
    if _is_about(frame, value, state):
        return "angle", math.radians(1.0)
    if degrees or _goes_on_in_degrees(frame, value, state):
        return "angle", math.radians(1.0)
    if state.chosen_m and not (frame.has_extent or frame.turning or frame.roles) and _goes_somewhere(frame):
        return "length", state.chosen_m
    if state.unit_m and not frame.has_extent and _goes_on_in_unit(frame, value, state):
        return "length", state.unit_m
    return _unit_by_sense(frame, value, state)


def _unit_by_sense(frame: Frame, value: float, state: State) -> tuple[str, float] | None:
    """`turn left 20`, `go forward 2`: degrees for a turn, metres for a drive of at most two where no unit was said."""
    if (
        frame.has_extent
        or frame.shape
        or frame.place
        or frame.roles
        or set(frame.q) - {"number", "speed", "rate"}
    ):
        return None
    turns = frame.verb in TURN and frame.sided
    if not any(map(str.isdecimal, frame.q["number"].text)):  # written out, more may follow: 前进半…
        return ("turns", 2 * math.pi) if turns and 0 < value < 0.5 else None  # `turn left by a quarter`
    if turns and _LEAST_DEG <= value <= 1080:
        return "angle", math.radians(1.0)
    along = frame.direction in ("forward", "back") or (frame.verb == "slide" and frame.direction in SIDES)
    return ("length", 1.0) if along and 0 < value <= _MOST_M and not (state.unit_m or frame.flags) else None


def _goes_somewhere(frame: Frame) -> bool:
    along = frame.direction in ("forward", "back") or (frame.verb in GO and not frame.direction)
    return along or frame.verb in ("slide", "return") or bool(_SLIDING & frame.flags)


def _is_about(frame: Frame, value: float, state: State) -> bool:
    """`forward 2 m, 180, forward 2 m`: where lengths are in metres, a half turn or full ones."""
    alone = len(frame.texts) == 1 and set(frame.q) == {"number"} and frame.joined != "start"
    return alone and value in (180.0, 360.0, 720.0) and state.last == "drive" and state.unit_m == 1.0


def _goes_on_aside(frame: Frame, state: State) -> bool:
    """`30 left`, or in another turn `now right, but 60`, after a slide: as likely a distance as a turn."""
    slid = state.last == "drive" and state.direction in SIDES
    number = frame.q["number"]
    goes_on = number.text == frame.texts[0] or (frame.joined == "start" and number.number % 45 != 0)
    return slid and not frame.verb and goes_on


def _goes_on_in_degrees(frame: Frame, value: float, state: State) -> bool:
    """`turn left 40 degrees, then right 50`: after a turn by an angle."""
    on = "more" in frame.flags and not frame.moves
    turning = (frame.turning or frame.direction in SIDES or on) and not _SLIDING & frame.flags
    after_turn = state.last == "turn" and state.angle is not None
    return after_turn and not frame.has_extent and turning and 1 <= value <= 1080 and frame.verb not in GO


def _goes_on_in_unit(frame: Frame, value: float, state: State) -> bool:
    """`forward 50 cm, …, back 20`: the unit said before, if that gives a distance of the same order."""
    if frame.turning or frame.is_arc or value < 1:
        return False
    on = "more" in frame.flags and (state.last == "drive" or frame.verb in GO)
    sideways = (
        frame.verb in ("slide", "shift")
        or bool(_SLIDING & frame.flags)
        or frame.direction in DIAGONALS.values()
    )
    along = frame.direction in ("forward", "back") or (frame.verb in (*GO, "return") and not frame.direction)
    before = state.length.number if state.length is not None else 0.0
    slid = bool(state.steps) and state.last == "drive" and state.direction in SIDES
    goes_on = slid and frame.direction in SIDES and not frame.verb  # `40 cm to the left, 40 to the right`
    sideways |= goes_on and math.isclose(value * (state.unit_m or 0.0), before)
    most = before if frame.verb == "return" else 5 * before
    return (on or sideways or along) and before / 10 <= value * (state.unit_m or 0.0) <= most


def _means_degrees(frame: Frame, value: float) -> bool:
    """`turn left 90`, `left 90`, `do a 180`: a multiple of 15 at a turn is degrees."""
    turning = frame.turning or (not frame.verb and frame.direction in SIDES and not _SLIDING & frame.flags)
    turning |= frame.is_arc and frame.sided and "radius" in frame.q  # `curve left 90 with a radius of 1 m`
    spinning = frame.verb == "make" and not frame.direction and value % 90 == 0
    return (turning or spinning) and not frame.has_extent and 15 <= value <= 1080 and value % 15 == 0


def with_rates(atoms: Sequence[Atom]) -> list[Atom]:
    """`To the right at 15`: a bare number after `at` is how fast, and no way or angle."""
    before = ["", *(atom.text for atom in atoms)]
    bare = [
        text == "at" and (a.kind, a.value, a.role) == ("q", "number", "") for text, a in zip(before, atoms)
    ]
    return [a._replace(role=RATE) if is_bare else a for a, is_bare in zip(atoms, bare)]
