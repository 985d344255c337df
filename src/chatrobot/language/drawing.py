"""A shape and its measures → steps. `outlines` knows the geometry, this what may be left out of a shape."""

from __future__ import annotations

import math
from collections.abc import Callable

from chatrobot.language import outlines
from chatrobot.language.measures import Measures
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step


def drawn(found: Measures) -> list[Step]:
    """The steps of the shape that is measured.

    Raises:
        Unclear: where a measure is missing or contradicts another, or the robot cannot draw it so.
    """
    if found.sliding and not found.can_go_sideways:
        raise Unclear("cannot_go_sideways", found.text, refused=True)
    if found.area_m2:
        found.lengths.append(_length_of_area(found))
    draw = _DRAWN.get("polygon" if found.shape.startswith("polygon") else found.shape)
    if draw is None:
        raise Unclear("unclear_motion", found.text)
    return _some_sides(draw(found), found)


def _length_of_area(found: Measures) -> tuple[float, list[str]]:
    """The side or radius, m, that a shape of that area has; of a rectangle the other side.

    Raises:
        Unclear: its area does not tell its size, or that is told as well.
    """
    area_m2, told = found.area_m2, found.plain()
    sides = 3 if found.shape == "triangle" else 4 if found.shape == "square" else 0
    if found.shape.startswith("polygon_"):
        sides = int(found.shape[len("polygon_") :])
    if found.shape == "rectangle" and len(told) == 1:
        return area_m2 / told[0], []
    if found.shape == "circle" and not told:
        return math.sqrt(area_m2 / math.pi), ["radius"]
    if sides and not told:  # of a regular polygon, n / 4 * side^2 / tan(pi / n)
        return math.sqrt(4 * area_m2 * math.tan(math.pi / sides) / sides), ["side"]
    raise Unclear("which_size", found.text)


def _some_sides(steps: list[Step], found: Measures) -> list[Step]:
    """`Three sides of a square`: with the turns between them, and none after the last.

    Raises:
        Unclear: where the shape has not as many, or sides that slide.
    """
    drives = [i for i, step in enumerate(steps) if isinstance(step, Drive)]
    if found.some_sides in (0, len(drives)):
        return steps
    if found.some_sides > len(drives) or len(drives) * 2 != len(steps):
        raise Unclear("bad_count", found.text)
    return steps[: drives[found.some_sides - 1] + 1]


def _polygon(found: Measures) -> list[Step]:
    said = found.count("side", "point")
    sides = 4 if found.shape == "square" else int(found.shape[len("polygon_") :] or said)
    if not 3 <= sides <= 100:
        raise Unclear("which_size", found.text)
    if len(set(found.plain())) > 1 and sides == 4:
        return _rectangle(found)
    diagonal = found.with_role("diagonal")
    if diagonal and sides != 4:
        raise Unclear("which_size", found.text)
    side = diagonal / math.sqrt(2) if diagonal else _side(found, sides)
    if sides == 4 and found.sliding:
        return outlines.square_without_turning(side, found.left, found.speed)
    return outlines.polygon(sides, side, found.left, found.speed)


def _rectangle(found: Measures) -> list[Step]:
    values, around = found.plain(), found.with_role("circumference")
    if around is not None:
        values = [value for value, roles in found.lengths if "circumference" not in roles]
        values += [around / 2 - value for value in values if value < around / 2]
    if len(values) != 2:
        raise Unclear("which_size", found.text)
    first, second = values
    if found.sliding:
        return outlines.rectangle_without_turning(first, second, found.left, found.speed)
    return outlines.rectangle(first, second, found.left, found.speed)


def _triangle(found: Measures) -> list[Step]:
    values = found.plain()
    around = found.with_role("circumference")
    if around is not None:
        values = [around / 3] * 3
    if found.shape == "right_triangle" and len(values) == 1:
        values = [values[0], values[0]]  # 等腰
    if found.shape == "right_triangle" and len(values) == 2:
        values = [values[0], values[1], math.hypot(values[0], values[1])]
    elif found.shape == "triangle" and len(values) == 2 and 2 in found.counts.values():
        legs = next((v for v, roles in found.lengths if "side" in roles), values[1])
        values = [next((v for v in values if v != legs), legs), legs, legs]
    elif found.shape == "triangle" and len(values) < 2:
        values = [values[0] if values else found.default_m] * 3
    if len(values) != 3:
        raise Unclear("which_size", found.text)
    if found.shape == "right_triangle":
        a, b, c = sorted(values)
        if abs(a * a + b * b - c * c) > 0.05 * c * c:
            raise Unclear("contradiction", found.text)
        values = [a, b, c]
    return outlines.triangle((values[0], values[1], values[2]), found.left, found.speed)


def _lawn(found: Measures) -> list[Step]:
    passes = found.count("pass", "leg", "lap", "step")
    spacing = found.with_role("apart") or found.with_role("diameter")
    length = next((v for v, roles in found.lengths if not {"apart", "diameter"} & set(roles)), None)
    if not passes or spacing is None or length is None:
        raise Unclear("which_size", found.text)
    return outlines.lawn(passes, length, spacing, found.left, found.speed)


def _stairs(found: Measures) -> list[Step]:
    count = found.count("stair", "step", "leg", "point") or found.times
    values = found.plain()
    if not values or not found.can_go_sideways:
        raise Unclear("which_size", found.text)
    found.times = 1
    side = math.pi / 2 if found.left else -math.pi / 2
    step: list[Step] = [
        Drive(values[0], speed_mps=found.speed),
        Drive(values[-1], direction_rad=side, speed_mps=found.speed),
    ]
    return step * count


def _spiral(found: Measures) -> list[Step]:
    if len(found.lengths) < 3:  # `from 20 cm to 1 m` tells no leg between
        raise Unclear("unclear_motion", found.text)
    return outlines.polyline(found.plain(), found.angle_rad or math.pi / 2, found.left, found.speed)


def _star(found: Measures) -> list[Step]:
    return outlines.star(_side(found), found.left, found.speed)


def _plus(found: Measures) -> list[Step]:
    return outlines.plus(_side(found), found.speed)


def _rhombus(found: Measures) -> list[Step]:
    acute = math.pi / 3 if found.angle_rad is None else min(found.angle_rad, math.pi - found.angle_rad)
    if not 0 < acute <= math.pi / 2:
        raise Unclear("contradiction", found.text)
    return outlines.rhombus(_side(found), acute, found.left, found.speed)


def _parallelogram(found: Measures) -> list[Step]:
    pair = found.plain()
    if len(pair) != 2 or found.angle_rad is None or not 0 < found.angle_rad < math.pi:
        raise Unclear("which_size", found.text)
    return outlines.parallelogram(pair[0], pair[1], found.angle_rad, found.left, found.speed)


def _zigzag(found: Measures) -> list[Step]:
    legs = found.count("leg", "step", "move", "side") or 4
    return outlines.zigzag(legs, _side(found), found.left, found.speed, found.back)


def _letter_u(found: Measures) -> list[Step]:
    values = found.plain()
    if len(values) == 2:
        return outlines.letter_u(values[0], values[1], found.left, found.speed)
    if len(values) == 1:
        side = _side(found)
        return outlines.letter_u(side, side, found.left, found.speed)
    raise Unclear("unclear_motion", found.text)


def _racetrack(found: Measures) -> list[Step]:
    radius = found.with_role("radius") or (found.with_role("diameter") or 0.0) / 2
    straight = next((v for v, roles in found.lengths if not {"radius", "diameter"} & set(roles)), None)
    if not radius or straight is None:
        raise Unclear("which_size")
    return outlines.racetrack(straight, radius, found.left, found.speed)


def _eight(found: Measures) -> list[Step]:
    sizes = [(v, roles) for v, roles in found.lengths if {"radius", "diameter"} & set(roles)]
    radii = [v / 2 if "diameter" in roles else v for v, roles in sizes]
    first = radii[0] if radii else _radius(found)
    return outlines.eight(first, radii[1] if len(radii) > 1 else first, found.left, found.speed)


def _s_bend(found: Measures) -> list[Step]:
    found.times = 1
    return outlines.s_bend(_radius(found), found.angle_rad or math.pi / 2, found.left, found.speed)


def _circle(found: Measures) -> list[Step]:
    radius = _radius(found)
    said = found.angle_rad and found.angle_rad / (2 * math.pi)  # `30 degrees of a circle`
    rounds = {"circle": found.rounds * (said or 1.0), "half_circle": 0.5, "quarter_circle": 0.25}[found.shape]
    if said and found.shape != "circle" and not math.isclose(said, rounds):
        raise Unclear("contradiction", found.text)  # `half a circle, 45 degrees`
    if rounds < 1 and not found.side_said:
        raise Unclear("which_side", found.shape.replace("_", " "))
    speed, sweep = found.speed, 2 * math.pi * rounds
    if found.seconds and speed is None:
        speed = radius * sweep / found.seconds
    return [Arc(radius, sweep, left=found.left, backward=found.back, speed_mps=speed)]


def _side(found: Measures, sides: int = 0) -> float:
    around = found.with_role("circumference")
    if around is not None and sides:
        return around / sides
    side = found.with_role("side", "leg", "long", "tile")
    if side is None and found.lengths:
        side = found.lengths[0][0]
    return found.default_m if side is None else side


def _radius(found: Measures) -> float:
    radius = found.with_role("radius")
    diameter, around = found.with_role("diameter"), found.with_role("circumference")
    if radius is None and diameter is not None:
        radius = diameter / 2
    if radius is None and around is not None:
        radius = around / (2 * math.pi)
    if radius is None:
        if found.lengths:
            raise Unclear("which_size", f"{found.lengths[0][0]:g} m")
        radius = found.default_m
    return radius


_DRAWN: dict[str, Callable[[Measures], list[Step]]] = {
    "square": _polygon, "polygon": _polygon, "rectangle": _rectangle, "triangle": _triangle,
    "right_triangle": _triangle, "rhombus": _rhombus, "parallelogram": _parallelogram, "star": _star,
    "plus": _plus, "zigzag": _zigzag, "stairs": _stairs, "lawn": _lawn, "spiral": _spiral, "letter_u": _letter_u,
    "circle": _circle, "half_circle": _circle, "quarter_circle": _circle, "eight": _eight, "sbend": _s_bend,
    "racetrack": _racetrack,
}  # fmt: skip
