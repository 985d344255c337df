"""A named shape and the measures said with it → steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from chatrobot.language import outlines
from chatrobot.language.actions import act
from chatrobot.language.ellipsis import State
from chatrobot.language.frames import DIAGONALS, GO, SIDES, STILL, TURN, Frame
from chatrobot.language.manner import Pace
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import MAX_REPEAT, Arc, Drive, Step

_ROUND = ("circle", "half_circle", "quarter_circle", "eight", "sbend", "racetrack")
_TITLES = frozenset({"letter_l", "letter_u", "letter_z", "stairs", "plus", "zigzag", "square", "rectangle"})
"""Shapes whose moves may be spelt out after their name."""


@dataclass
class Measures:
    """What is said about a shape: lengths with the roles they were said with, in order."""

    lengths: list[tuple[float, list[str]]] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    times: int = 1
    rounds: float = 1.0
    left: bool = True
    side_said: bool = False
    back: bool = False
    sliding: bool = False
    angle_rad: float | None = None
    seconds: float | None = None
    speed: float | None = None

    def with_role(self, *roles: str) -> float | None:
        """The first length that was said with one of these roles."""
        return next((v for v, said in self.lengths if set(said) & set(roles)), None)

    def plain(self) -> list[float]:
        """The lengths in order, whatever their role."""
        return [value for value, _ in self.lengths]


def draw(frames: list[Frame], i: int, pace: Pace) -> tuple[int, list[Step]]:
    """The steps of the shape named in `frames[i]`, and the index of the first frame that is no part of it.

    Raises:
        Unclear: where a measure is missing or the shape is none this module can draw.
    """
    end = i + 1
    while end < len(frames) and _is_part(frames[i], frames[end]):
        end += 1
    parts = frames[i:end]
    spelt = _spelt_out(parts, pace) if parts[0].shape in _TITLES else None
    if spelt is not None:
        return end, spelt
    measures = _measure(parts, pace)
    if parts[0].shape != "circle":
        measures.times *= _whole(measures.rounds)
    steps = _drawn(parts[0].shape, measures, pace, parts[0].text)
    return end, steps * measures.times


def _is_part(head: Frame, frame: Frame) -> bool:
    if head.shape == "plus" and ("way" in [q.role for q in frame.q.values()] or frame.verb == "return"):
        return True
    if head.shape == "spiral" and "between" in frame.flags and "angle" in frame.q:
        return True
    if frame.flags & {"between", "after_each", "to_start", "original_heading"} or frame.verb in (
        *STILL,
        "return",
        "face",
        "uturn",
        "remember",
    ):
        return False
    if frame.shape and frame.shape not in ("half_circle", "quarter_circle", "circle"):
        return False
    if head.shape in _TITLES and frame.has_extent and (frame.direction or frame.verb in GO):
        return True
    lone_side = frame.direction in SIDES and not frame.q and frame.verb in ("", "curve", "turn")
    if head.shape == "sbend" and (frame.shape == "quarter_circle" or lone_side):
        return True
    if frame.joined == "then":
        return False
    if frame.verb in TURN:
        by_the_way = frame.text.split()[0].endswith("ing") or {"all", "each"} & frame.flags or frame.roles
        return bool((lone_side or frame.rot) and not frame.has_extent and by_the_way)
    return not (
        frame.verb in GO
        and frame.has_extent
        and not frame.roles
        and "each" not in frame.flags
        and "count" not in frame.q
    )


def _spelt_out(parts: list[Frame], pace: Pace) -> list[Step] | None:
    """`a letter L: two metres forward, then one metre to the right`; stairs may say how often."""
    moves = [
        p
        for p in parts
        if p.direction and "length" in p.q and not (p.shape and p.shape != "letter_l" and p.roles)
    ]
    if len(moves) < 2 or any("count" in p.q and "length" in p.q for p in parts):
        return None
    if any(p.q and p not in moves and not {"count", "times"} & set(p.q) for p in parts):
        return None
    state = State()
    steps = []
    for move in moves:
        bare = move.copy()
        bare.shape, bare.verb, bare.roles = "", "" if bare.verb == "make" else bare.verb, []
        bare.q.pop("count", None)
        steps += act(bare, state, pace)
    rounds = [p.q[n].number for p in parts for n in ("count", "times") if n in p.q]
    return steps * _whole(rounds[0]) if rounds else steps


def _whole(value: float) -> int:
    if not math.isfinite(value) or value != int(value) or not 1 <= value <= MAX_REPEAT / 10:
        raise Unclear("bad_count", f"{value:g}")
    return int(value)


def _measure(parts: list[Frame], pace: Pace) -> Measures:
    found = Measures()
    for part in parts:
        for name, quantity in part.q.items():
            value = quantity.number
            if name in ("length", "angle", "time") and not (math.isfinite(value) and 0 < value <= 1000):
                raise Unclear("bad_number", quantity.text)
            if name == "length":
                roles = list(part.roles) + (["side"] if "each" in part.flags or "all" in part.flags else [])
                roles += ["circumference"] if "total" in part.flags else []
                found.lengths.append((value, roles))
            elif name == "number" and parts[0].shape in ("eight", "racetrack", "sbend"):
                continue  # "its two circles"
            elif name == "count":
                found.counts[quantity.role] = _whole(value)
                if quantity.role in ("lap", "loop"):
                    found.times *= _whole(value)
            elif name in ("times", "number") and _is_its_parts(parts[0], part, quantity.number):
                continue
            elif name in ("times", "number"):
                _multiply(found, part, name, value)
            elif name == "angle":
                found.angle_rad = value
            elif name == "time":
                found.seconds = value
        if {"radius", "diameter"} & set(part.roles) and "again" in part.flags and "length" not in part.q:
            raise Unclear("which_size", part.text)  # `of the same radius`
        if parts[0].shape == "sbend" and part.shape == "half_circle":
            found.angle_rad = math.pi
        if {"left_right", "right_left"} & part.flags:
            found.left, found.side_said = "left_right" in part.flags, True
        side = part.rot or part.direction2 or (part.direction if part.direction in SIDES else "")
        if not side and part.direction in DIAGONALS.values():
            side = part.direction.split("_")[1]
        if side and not (parts[0].shape == "sbend" and found.side_said):
            found.left, found.side_said = side == "left", True
        found.back = found.back or part.direction == "back"
        found.sliding = found.sliding or bool({"no_turn", "sideways"} & part.flags) or part.verb == "slide"
        found.speed = pace.speed(part) or found.speed
    return found


def _is_its_parts(head: Frame, part: Frame, value: float) -> bool:
    """8字，两个圈的半径…: the two circles that an eight has anyway."""
    both = abs(value - 2) < 1e-9 or abs(value - 4 * math.pi) < 1e-6
    return head.shape in ("eight", "sbend") and both and bool({"radius", "diameter"} & set(part.roles))


def _multiply(found: Measures, part: Frame, name: str, value: float) -> None:
    if part.shape == "polygon" and name == "number":
        found.counts["side"] = _whole(value)
    elif part.shape == "circle" or (name == "times" and part.q["times"].value == "turns"):
        rounds = value / (2 * math.pi) if part.q[name].value == "turns" else value
        if 0 < rounds < 1 or (rounds < 10 and rounds * 4 == int(rounds * 4)):
            found.rounds *= rounds
        else:
            found.times *= _whole(rounds)
    else:
        found.times *= _whole(value)


def _radius(found: Measures, pace: Pace) -> float:
    radius = found.with_role("radius")
    diameter, around = found.with_role("diameter"), found.with_role("circumference")
    if radius is None and diameter is not None:
        radius = diameter / 2
    if radius is None and around is not None:
        radius = around / (2 * math.pi)
    if radius is None:
        if found.lengths:
            raise Unclear("which_size", f"{found.lengths[0][0]:g} m")
        radius = pace.profile.defaults.distance_m
    return radius


def _side(found: Measures, pace: Pace, sides: int = 0) -> float:
    around = found.with_role("circumference")
    if around is not None and sides:
        return around / sides
    side = found.with_role("side", "leg", "long", "tile")
    if side is None and found.lengths:
        side = found.lengths[0][0]
    return pace.profile.defaults.distance_m if side is None else side


def _drawn(shape: str, found: Measures, pace: Pace, text: str) -> list[Step]:
    left, speed = found.left, found.speed
    if found.sliding and not pace.profile.can_go_sideways:
        raise Unclear("cannot_go_sideways", text, refused=True)
    if shape in _ROUND:
        return _round(shape, found, pace)
    if shape == "square" or shape.startswith("polygon"):
        sides = (
            4
            if shape == "square"
            else int(shape[8:] or found.counts.get("side", 0) or found.counts.get("point", 0))
        )
        if not 3 <= sides <= 100:
            raise Unclear("which_size", text)
        if len(set(found.plain())) > 1 and sides == 4:
            return _rectangle(found, text)
        diagonal = found.with_role("diagonal")
        side = diagonal / math.sqrt(2) if diagonal and sides == 4 else _side(found, pace, sides)
        if diagonal and sides != 4:
            raise Unclear("which_size", text)
        if found.seconds and speed is None:
            speed = None
        if sides == 4 and found.sliding:
            return outlines.square_without_turning(side, left, speed)
        return outlines.polygon(sides, side, left, speed)
    if shape == "rectangle":
        return _rectangle(found, text)
    if shape in ("triangle", "right_triangle"):
        return _triangle(shape, found, pace, text)
    if shape == "lawn":
        return _lawn(found, text)
    if shape == "spiral" and len(found.lengths) > 1:
        return outlines.polyline(found.plain(), found.angle_rad or math.pi / 2, left, speed)
    if shape == "stairs":
        return _stairs(found, pace, text)
    side = _side(found, pace)
    legs = (
        found.counts.get("leg")
        or found.counts.get("step")
        or found.counts.get("move")
        or found.counts.get("side")
    )
    if shape == "star":
        return outlines.star(side, left, speed)
    if shape == "plus":
        return outlines.plus(side, speed)
    if shape == "rhombus":
        acute = math.pi / 3 if found.angle_rad is None else min(found.angle_rad, math.pi - found.angle_rad)
        if not 0 < acute <= math.pi / 2:
            raise Unclear("contradiction", text)
        return outlines.rhombus(side, acute, left, speed)
    if shape == "parallelogram":
        pair = found.plain()
        if len(pair) != 2 or found.angle_rad is None or not 0 < found.angle_rad < math.pi:
            raise Unclear("which_size", text)
        return outlines.parallelogram(pair[0], pair[1], found.angle_rad, left, speed)
    if shape == "zigzag":
        return outlines.zigzag(legs or 4, side, left, speed, found.back)
    if shape == "letter_u" and len(found.lengths) == 2:
        return outlines.letter_u(found.plain()[0], found.plain()[1], left, speed)
    if shape == "letter_u" and len(found.lengths) == 1:
        return outlines.letter_u(side, side, left, speed)
    raise Unclear("unclear_motion", text)


def _round(shape: str, found: Measures, pace: Pace) -> list[Step]:
    left, speed = found.left, found.speed
    if shape == "racetrack":
        radius = found.with_role("radius") or (found.with_role("diameter") or 0.0) / 2
        straight = next((v for v, roles in found.lengths if not {"radius", "diameter"} & set(roles)), None)
        if not radius or straight is None:
            raise Unclear("which_size")
        return outlines.racetrack(straight, radius, left, speed)
    if shape == "eight":
        radii = [
            v / 2 if "diameter" in roles else v
            for v, roles in found.lengths
            if {"radius", "diameter"} & set(roles)
        ]
        first = radii[0] if radii else _radius(found, pace)
        return outlines.eight(first, radii[1] if len(radii) > 1 else first, left, speed)
    radius = _radius(found, pace)
    if shape == "sbend":
        found.times = 1
        return outlines.s_bend(radius, found.angle_rad or math.pi / 2, left, speed)
    sweep = {"circle": 2 * math.pi * found.rounds, "half_circle": math.pi, "quarter_circle": math.pi / 2}[
        shape
    ]
    if (shape != "circle" or found.rounds < 1) and not found.side_said:
        raise Unclear("which_side", shape.replace("_", " "))
    if found.seconds and speed is None:
        speed = radius * sweep / found.seconds
    return [Arc(radius, sweep, left=left, backward=found.back, speed_mps=speed)]


def _rectangle(found: Measures, text: str) -> list[Step]:
    values = found.plain()
    if len(values) != 2:
        raise Unclear("which_size", text)
    second = values[1]
    first = values[0]
    if found.sliding:
        return outlines.rectangle_without_turning(first, second, found.left, found.speed)
    return outlines.rectangle(first, second, found.left, found.speed)


def _triangle(shape: str, found: Measures, pace: Pace, text: str) -> list[Step]:
    values = found.plain()
    around = found.with_role("circumference")
    if around is not None:
        values = [around / 3] * 3
    if shape == "right_triangle" and len(values) == 1:
        values = [values[0], values[0]]  # 等腰
    if shape == "right_triangle" and len(values) == 2:
        values = [values[0], values[1], math.hypot(values[0], values[1])]
    elif shape == "triangle" and len(values) == 2 and 2 in found.counts.values():
        legs = next((v for v, roles in found.lengths if "side" in roles), values[1])
        values = [next((v for v in values if v != legs), legs), legs, legs]
    elif shape == "triangle" and len(values) < 2:
        values = [values[0] if values else pace.profile.defaults.distance_m] * 3
    if len(values) != 3:
        raise Unclear("which_size", text)
    if shape == "right_triangle":
        a, b, c = sorted(values)
        if abs(a * a + b * b - c * c) > 0.05 * c * c:
            raise Unclear("contradiction", text)
        values = [a, b, c]
    return outlines.triangle((values[0], values[1], values[2]), found.left, found.speed)


def _lawn(found: Measures, text: str) -> list[Step]:
    passes = (
        found.counts.get("pass")
        or found.counts.get("leg")
        or found.counts.get("lap")
        or found.counts.get("step")
    )
    spacing = found.with_role("apart") or found.with_role("diameter")
    length = next((v for v, roles in found.lengths if not {"apart", "diameter"} & set(roles)), None)
    if not passes or spacing is None or length is None:
        raise Unclear("which_size", text)
    return outlines.lawn(passes, length, spacing, found.left, found.speed)


def _stairs(found: Measures, pace: Pace, text: str) -> list[Step]:
    count = (
        next((found.counts[n] for n in ("stair", "step", "leg", "point") if n in found.counts), 0)
        or found.times
    )
    values = found.plain()
    if not values or not pace.profile.can_go_sideways:
        raise Unclear("which_size", text)
    found.times = 1
    side = math.pi / 2 if found.left else -math.pi / 2
    step: list[Step] = [
        Drive(values[0], speed_mps=found.speed),
        Drive(values[-1], direction_rad=side, speed_mps=found.speed),
    ]
    return step * count
