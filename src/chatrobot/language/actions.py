"""One frame → the steps it means."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from chatrobot.core.geometry import Pose
from chatrobot.language.arcs import about, arc, is_left
from chatrobot.language.frames import DIAGONALS, GO, SIDES, STILL, TURN, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.numbers import is_chinese
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.language.undoing import inverse
from chatrobot.plan.steps import Drive, Face, Go, Step, Turn, Wait

DIRECTIONS = {
    "forward": 0.0, "left": math.pi / 2, "back": math.pi, "right": -math.pi / 2,
    "forward_left": math.pi / 4, "forward_right": -math.pi / 4,
    "back_left": 3 * math.pi / 4, "back_right": -3 * math.pi / 4,
}  # fmt: skip
MAX_EXTENT = {"length": 1000.0, "angle": 200.0 * math.pi, "turns": 200.0 * math.pi, "time": 3600.0}


@dataclass
class State:
    """What the frames before have left: for ellipsis (`thirty more`) and for the way back."""

    steps: list[Step] = field(default_factory=list)
    direction: str = "forward"
    unit_m: float | None = None
    length: Atom | None = None
    angle: Atom | None = None
    left: bool | None = None
    last: str = ""
    home: Pose | None = None
    unsaid: list[Frame] = field(default_factory=list)


def act(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """The steps of a frame; `state` is brought up to date.

    Raises:
        Unclear: where something needed is missing or impossible.
    """
    frame = _with_units(frame, state)
    _check_extents(frame)
    if _OUTLINES & set(frame.roles):
        raise Unclear("unknown_part", frame.text)
    if (
        "there" in frame.flags
        and frame.verb not in STILL
        and "clock" not in frame.q
        and not (frame.direction or frame.rot)
    ):
        raise Unclear("which_place", frame.text)
    if "until" in frame.flags and not frame.has_extent and frame.verb != "face":
        raise Unclear("condition", frame.text)
    if _goes_back(frame, state):
        return _return(Frame(verb="return", pace=frame.pace), state, pace)
    if "to_start" in frame.flags and frame.direction and "length" in frame.q:
        frame = frame.copy()
        frame.flags.discard("to_start")  # the way to it is told in full
    if "asked_distance" in frame.flags:
        return []  # only worked out; what is done with it comes after
    if "heading" in frame.q:
        steps = _by_compass(frame, state, pace)
    elif "clock" in frame.q:
        steps = _clock(frame, pace)
    elif frame.verb in STILL:
        steps = _still(frame)
    elif frame.verb == "return" and {"length", "angle", "turns"} & set(frame.q) and not frame.direction:
        steps = _partly_back(frame, state, pace)
    elif frame.verb == "return" or (
        "to_start" in frame.flags
        and frame.verb in (*GO, "", "uturn")
        and not (frame.direction and "length" in frame.q)
    ):
        steps = _return(frame, state, pace)
    elif frame.verb == "face" or ("original_heading" in frame.flags):
        steps = _face(frame, state, pace)
    elif frame.verb == "uturn":
        steps = about(frame, pace)
    elif frame.is_arc:
        steps = arc(frame, pace)
    elif _is_turn(frame, state):
        steps = _turn(frame, state, pace)
    else:
        steps = _drive(frame, state, pace)
    return steps


def _with_units(frame: Frame, state: State) -> Frame:
    """A number without a unit, where only one unit can be meant: `thirty more`, `turn left 90`."""
    length = frame.q.get("length")
    if length is not None and length.role:
        state.unit_m = float(length.role)
    if "same_amount" in frame.flags and not frame.has_extent:
        before = state.angle if frame.turning else state.length
        if before is None:
            raise Unclear("nothing_before", frame.text)
        frame = frame.copy()
        frame.q[before.value] = before
        frame.flags.discard("again")
    state.length = frame.q.get("length", state.length)
    state.angle = frame.q.get("angle", frame.q.get("turns", state.angle))
    if {"computed", "asked_distance"} & frame.flags and {"speed", "time"} <= set(frame.q):
        frame = frame.copy()
        covered = frame.q.pop("speed").number * frame.q.pop("time").number
        frame.q["length"] = quantity("length", covered, f"{covered:g} m")
        state.length = frame.q["length"]
    before = state.angle if frame.turning else state.length
    scale = frame.q.get("scale")
    if scale is not None and before is not None and frame.moves and not frame.has_extent:
        frame = frame.copy()
        del frame.q["scale"]
        frame.q[before.value] = quantity(before.value, before.number * scale.number, scale.text)
        return frame
    number = frame.q.get("number")
    if number is None:
        return frame
    if (
        frame.verb == "return"
        and state.last == "turn"
        and not any(isinstance(step, Drive) for step in state.steps)
    ):
        before = state.angle
    if "转返" in frame.texts and state.last != "turn":
        raise Unclear("which_side", frame.text)
    if number.text == "一半" and before is not None and not frame.has_extent:
        frame = frame.copy()
        del frame.q["number"]
        frame.q[before.value] = quantity(before.value, before.number / 2, number.text)
        return frame
    dimension = ""
    if "units_said" in frame.flags and not _means_degrees(frame, number.number):
        dimension = "angle" if frame.turning else "length"
        factor = math.pi / 180 if frame.turning else 0.01 if "units_cm" in frame.flags else 1.0
    elif _means_degrees(frame, number.number) or (
        state.last == "turn"
        and state.angle is not None
        and not frame.has_extent
        and (frame.turning or frame.direction in SIDES or ("more" in frame.flags and not frame.moves))
        and 1 <= number.number <= 1080
        and frame.verb not in GO
    ):
        dimension, factor = "angle", math.pi / 180
    elif state.unit_m and not frame.has_extent and _goes_on_in_unit(frame, number.number, state):
        dimension, factor = "length", state.unit_m
    if not dimension:
        return frame
    frame = frame.copy()
    del frame.q["number"]
    frame.q[dimension] = quantity(dimension, number.number * factor, number.text)
    return frame


def _goes_on_in_unit(frame: Frame, value: float, state: State) -> bool:
    """`forward 50 cm, …, back 20`: the unit said before, if that gives a distance of the same order."""
    if frame.turning or frame.is_arc or value < 1:
        return False
    on = "more" in frame.flags and (state.last == "drive" or frame.verb in GO)
    sideways = frame.verb in ("slide", "shift") or frame.direction in DIAGONALS.values()
    along = frame.direction in ("forward", "back") or (frame.verb in GO and not frame.direction)
    before = state.length.number if state.length is not None else 0.0
    return (on or sideways or along) and before / 10 <= value * (state.unit_m or 0.0) <= 5 * before


def _means_degrees(frame: Frame, value: float) -> bool:
    """`turn left 90`, `left 90`, `do a 180`: a multiple of 15 at a turn is degrees."""
    turning = frame.turning or (not frame.verb and frame.direction in SIDES)
    spinning = frame.verb == "make" and not frame.direction and value % 90 == 0
    return (turning or spinning) and not frame.has_extent and 15 <= value <= 1080 and value % 15 == 0


def _goes_back(frame: Frame, state: State) -> bool:
    """`…, then back`: the way back, where there is a way to go back."""
    sideways = bool(state.steps) and state.last == "drive" and state.direction in SIDES
    verbs = ("", "go", "slide", "shift") if sideways else ("", "go")
    bare = frame.verb in verbs and frame.direction == "back" and not frame.q and "bit" not in frame.flags
    return bare and bool(state.steps) and frame.texts[-1:] == ["back"]


def _check_extents(frame: Frame) -> None:
    for name, amount in frame.q.items():
        value = amount.number
        if name in MAX_EXTENT and (not math.isfinite(value) or not 0.0 < value <= MAX_EXTENT[name]):
            raise Unclear("bad_number", amount.text)
    if "number" in frame.q:
        raise Unclear("no_unit", frame.q["number"].text)


_SLOTS = {
    "still": {"time"},
    "turn": {"angle", "turns", "time", "rate", "percent", "fold", "faster", "times"},
    "drive": {"length", "time", "speed", "percent", "fold", "faster", "times"},
    "heading": {"length", "time", "speed", "percent", "fold", "faster", "times", "angle"},
}
_REFERRING = {
    "halfway",
    "other_way",
    "short_of",
    "from_now_on",
    "same_way",
    "to_start",
    "original_heading",
    "left_right",
    "right_left",
    "at_point",
    "from_heading",
}


_COUNTED = {"tile", "step"}
"""What is counted: as a word without its count it says nothing."""

_OUTLINES = {"short", "apart", "circumference", "ends", "straights", "diagonal"}
"""Measures that only a drawn shape has."""


def _all_used(frame: Frame, kind: str) -> None:
    """No slot may be left over: what is not acted on was not understood."""
    left_over = [q for name, q in frame.q.items() if name not in _SLOTS[kind]]
    if left_over:
        raise Unclear("unclear_motion", f"{frame.text}")
    if "each" in frame.flags and "time" in frame.q and kind != "still" and len(frame.q) > 1:
        raise Unclear("unclear_motion", frame.text)
    if _COUNTED & set(frame.roles):
        raise Unclear("unclear_motion", frame.text)  # `a few of those units`: how many, of what?
    if _REFERRING & frame.flags or (kind in ("drive", "heading") and (frame.rot or frame.direction2)):
        raise Unclear("unclear_motion", frame.text)


def _still(frame: Frame) -> list[Step]:
    _all_used(frame, "still")
    if "time" in frame.q:
        return [Wait(frame.q["time"].number)]
    if frame.verb == "halt":
        return []
    if "bit" in frame.flags or frame.text:
        return [Wait(1.0)]
    raise Unclear("how_long", frame.text)


def _is_turn(frame: Frame, state: State) -> bool:
    if frame.verb in TURN or (frame.rot and frame.verb not in GO):
        return True
    if frame.rot and {"in_place", "around"} & frame.flags and "length" not in frame.q:
        return True
    if "bearing" in frame.flags and {"length", "time"} & set(frame.q) and "angle" in frame.q:
        return False
    if "angle" in frame.q or "turns" in frame.q:
        return frame.direction not in DIAGONALS.values() and "diagonal" not in frame.flags
    if "rate" in frame.q:
        return True
    if frame.verb in ("slide", "shift") or "sideways" in frame.flags or "no_turn" in frame.flags:
        return False
    if frame.direction in SIDES and "length" not in frame.q and "diagonal" not in frame.flags:
        return not (frame.verb in GO and "time" in frame.q)
    return not frame.moves and frame.has_extent and "time" in frame.q and state.last == "turn"


def _turn(frame: Frame, state: State, pace: Pace) -> list[Step]:
    if "length" in frame.q or "speed" in frame.q:
        raise Unclear("length_for_turn", frame.text)
    if "from_heading" in frame.flags:
        return [_from_heading(frame, state, pace)]
    _all_used(frame, "turn")
    rate = pace.rate(frame)
    seconds = frame.q.get("time")
    angle = _whole_angle(frame)
    left = is_left(frame)
    if left is None and not frame.moves:
        left = state.left
    if left is None and state.last == "turn" and "more" in frame.flags:
        left = state.left
    state.last = "turn"
    around = "around" in frame.flags and seconds is None
    left = True if left is None and around else left
    whole = frame.verb == "spin" or (frame.verb == "turn" and ("in_place" in frame.flags or bool(frame.rot)))
    if whole and angle is None and ("times" in frame.q or (around and frame.verb == "spin")):
        angle_rad: float | None = 2 * math.pi
    elif angle is not None:
        angle_rad = angle.number
    else:
        angle_rad = None
    if left is None and rate is not None and rate > pace.profile.limits.max_rate_radps:
        left = True  # too fast to either side: the rehearsal says so
    if left is None:
        if angle_rad is None or not _same_either_way(angle_rad):
            raise Unclear("which_side", frame.text)
        left = True
    state.left = left
    if angle_rad is None and seconds is not None:
        return [Turn(duration_s=seconds.number, left=left, rate_radps=rate)]
    if angle_rad is None:
        small = "bit" in frame.flags
        angle_rad = pace.profile.defaults.turn_rad * (0.5 if small else 1.0)
        if "rate" in frame.q and frame.q["rate"].role:
            angle_rad = frame.q["rate"].number
    if seconds is not None:
        rate = angle_rad / seconds.number
    return [Turn(angle_rad, left=left, rate_radps=rate)]


def _from_heading(frame: Frame, state: State, pace: Pace) -> Face:
    """从最开始的方向算，左转四十度: the heading to have, not how far to turn."""
    plain = frame.copy()
    plain.flags.discard("from_heading")
    _all_used(plain, "turn")
    angle, left = _whole_angle(plain), is_left(plain)
    if angle is None or left is None or set(plain.q) - {"angle", "turns", "rate"}:
        raise Unclear("unclear_motion", frame.text)
    yaw = angle.number if left else -angle.number
    state.last = "turn"
    if state.home is None:
        return Face(math.remainder(yaw, 2 * math.pi), frame="start", rate_radps=pace.rate(plain))
    yaw += state.home.yaw_rad
    return Face(math.remainder(yaw, 2 * math.pi), frame="odom", rate_radps=pace.rate(plain))


def _whole_angle(frame: Frame) -> Atom | None:
    """`One turn and 90 degrees` is their sum; `one turn, 360 degrees` says it twice."""
    angle, turns = frame.q.get("angle"), frame.q.get("turns")
    if (
        angle is None
        or turns is None
        or abs(angle.number - turns.number) < 1e-6
        or not is_chinese(turns.text)
    ):
        return angle or turns
    if angle.number >= 2 * math.pi or turns.number < 2 * math.pi:
        raise Unclear("contradiction", f"{turns.text} {angle.text}")
    return quantity("angle", turns.number + angle.number, f"{turns.text} {angle.text}")


def _same_either_way(angle_rad: float) -> bool:
    half_turns = angle_rad / math.pi
    return half_turns >= 1 and abs(half_turns - round(half_turns)) < 1e-6


def _drive(frame: Frame, state: State, pace: Pace) -> list[Step]:
    bearing = "bearing" in frame.flags and "angle" in frame.q
    _all_used(frame, "heading" if bearing or frame.direction in DIAGONALS.values() else "drive")
    if bearing and frame.direction not in SIDES:
        raise Unclear("which_side", frame.text)
    direction = frame.direction
    diagonal = "diagonal" in frame.flags
    if diagonal and direction not in DIAGONALS.values():
        raise Unclear("which_diagonal", frame.text)
    aimed = any(text.endswith(("到", " to")) for text in frame.texts)
    if not direction and not frame.has_extent and aimed:
        raise Unclear("which_place", frame.text)
    if not direction:
        if frame.verb == "slide" or "sideways" in frame.flags:
            raise Unclear("which_side", frame.text)
        if (frame.verb in GO and frame.verb != "shift") or "more" in frame.flags or not frame.verb:
            direction = state.direction if state.last == "drive" and not frame.verb else "forward"
        elif frame.has_extent and frame.verb:
            direction = "forward"
    if not direction:
        raise Unclear("which_way", frame.text)
    if "sideways" in frame.flags and direction in ("forward", "back"):
        raise Unclear("contradiction", frame.text)
    if not frame.has_extent and not frame.direction and frame.joined == "none":
        raise Unclear("which_way", frame.text)
    if not frame.moves and set(frame.q) == {"time"} and state.last != "drive":
        raise Unclear("unclear_motion", frame.text)
    ellipsis = "again" in frame.flags or ("more" in frame.flags and state.last == "drive")
    if not frame.moves and not frame.has_extent and not ellipsis:
        raise Unclear("unclear_motion", frame.text)
    _check_sideways(direction, pace)
    state.last, state.direction = "drive", direction
    angle = DIRECTIONS[direction]
    if "angle" in frame.q and direction in DIAGONALS.values():
        angle = _heading_angle(direction, frame.q["angle"].number)
    if bearing:
        angle = math.copysign(frame.q["angle"].number, angle)
    speed = pace.speed(frame)
    length, seconds = frame.q.get("length"), frame.q.get("time")
    if length is None and "speed" in frame.q and frame.q["speed"].role and seconds is None:
        return [Drive(frame.q["speed"].number, direction_rad=angle, speed_mps=speed)]
    if length is not None:
        if seconds is not None and "speed" not in frame.q:
            speed = length.number / seconds.number
        elif (
            seconds is not None
            and abs(frame.q["speed"].number * seconds.number - length.number) > 0.1 * length.number
        ):
            raise Unclear("contradiction", frame.text)
        return [Drive(length.number, direction_rad=angle, speed_mps=speed)]
    if seconds is not None:
        return [Drive(duration_s=seconds.number, direction_rad=angle, speed_mps=speed)]
    distance = pace.profile.defaults.distance_m * (0.5 if "bit" in frame.flags else 1.0)
    state.unsaid.append(frame)
    return [Drive(distance, direction_rad=angle, speed_mps=speed)]


def _heading_angle(direction: str, angle: float) -> float:
    if not 0 < angle < math.pi / 2:
        raise Unclear("bad_number", f"{math.degrees(angle):g}°")
    front, side = direction.split("_")
    signed = angle if front == "forward" else math.pi - angle
    return signed if side == "left" else -signed


def _check_sideways(direction: str, pace: Pace) -> None:
    if direction not in ("forward", "back") and not pace.profile.can_go_sideways:
        raise Unclear("cannot_go_sideways", direction, refused=True)


def _clock(frame: Frame, pace: Pace) -> list[Step]:
    hour = frame.q["clock"].number
    if not 0 < hour <= 12:
        raise Unclear("bad_number", frame.q["clock"].text)
    angle = -hour * math.pi / 6
    angle = angle + 2 * math.pi if angle <= -math.pi - 1e-9 else angle
    if "length" in frame.q or "time" in frame.q or frame.verb in ("slide", "shift"):
        _check_sideways("left", pace)
        length, seconds = frame.q.get("length"), frame.q.get("time")
        distance = length.number if length else None if seconds else pace.profile.defaults.distance_m
        time_s = seconds.number if seconds and not length else None
        return [Drive(distance, duration_s=time_s, direction_rad=angle, speed_mps=pace.speed(frame))]
    if abs(angle) < 1e-9:
        raise Unclear("already_facing", frame.text)
    return [Turn(abs(angle), left=angle > 0, rate_radps=pace.rate(frame))]


def _by_compass(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """To a point of the compass, facing it; going backward, away from what it faces."""
    heading = frame.q["heading"].number
    plain = frame.copy()
    del plain.q["heading"]
    going = plain.has_extent or plain.verb in GO or plain.direction == "back"
    backward = going and plain.direction == "back"
    yaw = math.remainder(heading + (math.pi if backward else 0.0), 2 * math.pi)
    face = Face(yaw, frame="start", rate_radps=pace.rate(plain) if not going else None)
    if not going or {"angle", "turns"} & set(plain.q):
        if {"angle", "turns", "length"} & set(plain.q):
            raise Unclear("contradiction", frame.text)
        return [face]
    if plain.direction not in ("", "forward", "back") or "sideways" in plain.flags:
        raise Unclear("contradiction", frame.text)
    plain.verb = "go"
    plain.direction = plain.direction or "forward"
    return [face, *_drive(plain, state, pace)]


def _face(frame: Frame, state: State, pace: Pace) -> list[Step]:
    if set(frame.q) - {"angle", "turns", "rate", "percent", "faster"}:
        raise Unclear("unclear_motion", frame.text)
    if ("original_heading" in frame.flags or "to_start" in frame.flags) and not frame.has_extent:
        if state.home is not None and not state.steps:
            return [Face(state.home.yaw_rad, frame="odom", rate_radps=pace.rate(frame))]
        return [Face(0.0, frame="start", rate_radps=pace.rate(frame))]
    if frame.direction in SIDES:
        angle = frame.q.get("angle") or frame.q.get("turns")
        size = (
            angle.number
            if angle
            else pace.profile.defaults.turn_rad * (0.5 if {"bit", "more"} & frame.flags else 1)
        )
        return [Turn(size, left=frame.direction == "left", rate_radps=pace.rate(frame))]
    if frame.direction == "back":
        return [Turn(math.pi, rate_radps=pace.rate(frame))]
    if frame.direction in DIAGONALS.values():
        angle_rad = DIRECTIONS[frame.direction]
        return [Turn(abs(angle_rad), left=angle_rad > 0, rate_radps=pace.rate(frame))]
    raise Unclear("which_side", frame.text)


def _return(frame: Frame, state: State, pace: Pace) -> list[Step]:
    if set(frame.q) & {"length", "time"} and state.last == "drive" and not frame.direction:
        return _some_way_back(frame, state, pace)
    if set(frame.q) - {"speed", "percent", "fold", "faster"}:
        raise Unclear("unclear_motion", frame.text)
    if frame.direction or (frame.has_extent and frame.verb != "return"):
        raise Unclear("unclear_motion", frame.text)
    speed = pace.speed(frame)
    if "same_way" in frame.flags:
        return inverse(state.steps, speed)
    drives: list[Step] = [step for step in state.steps if not isinstance(step, Wait)]
    if drives and all(isinstance(step, Drive) and step.distance_m for step in drives):
        return inverse(list(drives), speed)
    if state.home is not None and not drives:
        return [Go(state.home.x_m, state.home.y_m, frame="odom", speed_mps=speed)]
    return [Go(0.0, 0.0, frame="start", speed_mps=speed)]


def _partly_back(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """退回来二十厘米: against the last motion, by so much."""
    if "length" in frame.q:
        angle = DIRECTIONS[state.direction] if state.last == "drive" else 0.0
        opposite = math.remainder(angle + math.pi, 2 * math.pi)
        return [Drive(frame.q["length"].number, direction_rad=opposite, speed_mps=pace.speed(frame))]
    if state.left is None or state.last != "turn":
        raise Unclear("which_side", frame.text)
    amount = frame.q.get("angle") or frame.q["turns"]
    return [Turn(amount.number, left=not state.left, rate_radps=pace.rate(frame))]


def _some_way_back(frame: Frame, state: State, pace: Pace) -> list[Step]:
    """`…, then come back 50 cm`: so much of the last drive, undone."""
    opposite = math.remainder(DIRECTIONS[state.direction] + math.pi, 2 * math.pi)
    names = [n for n, a in DIRECTIONS.items() if abs(math.remainder(a - opposite, 2 * math.pi)) < 1e-6]
    back = frame.copy()
    back.verb, back.direction = "go", names[0]
    back.flags -= {"to_start", "again"}
    return _drive(back, state, pace)
