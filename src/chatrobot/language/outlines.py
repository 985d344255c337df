"""Steps of a path drawn on the floor, from its measures in metres and radians.

`left` is the side it turns to.
"""

from __future__ import annotations

import math

from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_QUARTER = math.pi / 2


def polygon(sides: int, side_m: float, left: bool, speed: float | None) -> list[Step]:
    """A regular polygon, closed, ending in the heading it began with."""
    edge: list[Step] = [Drive(side_m, speed_mps=speed), Turn(2 * math.pi / sides, left=left)]
    return edge * sides


def square_without_turning(side_m: float, left: bool, speed: float | None) -> list[Step]:
    """Ahead, sideways, back, sideways."""
    side = _QUARTER if left else -_QUARTER
    return [Drive(side_m, direction_rad=angle, speed_mps=speed) for angle in (0.0, side, math.pi, -side)]


def rectangle(long_m: float, short_m: float, left: bool, speed: float | None) -> list[Step]:
    """Two pairs of sides."""
    turn = Turn(_QUARTER, left=left)
    return [Drive(long_m, speed_mps=speed), turn, Drive(short_m, speed_mps=speed), turn] * 2


def rectangle_without_turning(long_m: float, short_m: float, left: bool, speed: float | None) -> list[Step]:
    """The same, sliding."""
    side = _QUARTER if left else -_QUARTER
    ways = ((long_m, 0.0), (short_m, side), (long_m, math.pi), (short_m, -side))
    return [Drive(length, direction_rad=angle, speed_mps=speed) for length, angle in ways]


def triangle(sides_m: tuple[float, float, float], left: bool, speed: float | None) -> list[Step]:
    """Any triangle, by the law of cosines; at each corner it turns by the outer angle."""
    steps: list[Step] = []
    for k in range(3):
        a, b, c = sides_m[k], sides_m[(k + 1) % 3], sides_m[(k + 2) % 3]
        cosine = (a * a + b * b - c * c) / (2 * a * b)
        if not -1.0 < cosine < 1.0:
            raise Unclear("contradiction", " / ".join(f"{s:g} m" for s in sides_m))
        steps += [Drive(a, speed_mps=speed), Turn(math.pi - math.acos(cosine), left=left)]
    return steps


def rhombus(side_m: float, acute_rad: float, left: bool, speed: float | None) -> list[Step]:
    """Four equal sides; `acute_rad` is the smaller of its two angles."""
    edge = Drive(side_m, speed_mps=speed)
    return [edge, Turn(acute_rad, left=left), edge, Turn(math.pi - acute_rad, left=left)] * 2


def parallelogram(
    first_m: float, second_m: float, corner_rad: float, left: bool, speed: float | None
) -> list[Step]:
    """Sides in turn; `corner_rad` is the inner angle at the start."""
    half: list[Step] = [
        Drive(first_m, speed_mps=speed), Turn(math.pi - corner_rad, left=left),
        Drive(second_m, speed_mps=speed), Turn(corner_rad, left=left),
    ]  # fmt: skip
    return half * 2


def polyline(sides_m: list[float], turn_rad: float, left: bool, speed: float | None) -> list[Step]:
    """Sides of these lengths with the same turn between one and the next."""
    steps: list[Step] = [Drive(sides_m[0], speed_mps=speed)]
    for side_m in sides_m[1:]:
        steps += [Turn(turn_rad, left=left), Drive(side_m, speed_mps=speed)]
    return steps


def star(side_m: float, left: bool, speed: float | None) -> list[Step]:
    """A pentagram in one stroke."""
    edge: list[Step] = [Drive(side_m, speed_mps=speed), Turn(math.radians(144), left=left)]
    return edge * 5


def eight(radius_m: float, second_m: float, left: bool, speed: float | None) -> list[Step]:
    """Two circles that touch where it starts."""
    return [
        Arc(radius_m, 2 * math.pi, left=left, speed_mps=speed),
        Arc(second_m, 2 * math.pi, left=not left, speed_mps=speed),
    ]


def plus(arm_m: float, speed: float | None) -> list[Step]:
    """Out and back along four directions, without turning."""
    steps: list[Step] = []
    for out in (0.0, _QUARTER, math.pi, -_QUARTER):
        back = math.remainder(out + math.pi, 2 * math.pi)
        steps += [
            Drive(arm_m, direction_rad=out, speed_mps=speed),
            Drive(arm_m, direction_rad=back, speed_mps=speed),
        ]
    return steps


def zigzag(legs: int, leg_m: float, left: bool, speed: float | None, back: bool = False) -> list[Step]:
    """Legs at 45 degrees to either side of the way ahead, ending in the heading it began with."""
    steps: list[Step] = [Turn(math.pi / 4, left=left)]
    for k in range(legs):
        steps.append(Drive(leg_m, direction_rad=math.pi if back else 0.0, speed_mps=speed))
        last = k == legs - 1
        steps.append(Turn(math.pi / 4 if last else _QUARTER, left=(k % 2 == 0) != left))
    return steps


def lawn(passes: int, length_m: float, spacing_m: float, left: bool, speed: float | None) -> list[Step]:
    """Rows side by side, up and down, without turning."""
    side = _QUARTER if left else -_QUARTER
    steps: list[Step] = []
    for k in range(passes):
        if k:
            steps.append(Drive(spacing_m, direction_rad=side, speed_mps=speed))
        steps.append(Drive(length_m, direction_rad=math.pi if k % 2 else 0.0, speed_mps=speed))
    return steps


def racetrack(straight_m: float, radius_m: float, left: bool, speed: float | None) -> list[Step]:
    """Two straights joined by half circles."""
    return [Drive(straight_m, speed_mps=speed), Arc(radius_m, math.pi, left=left, speed_mps=speed)] * 2


def s_bend(radius_m: float, sweep_rad: float, left: bool, speed: float | None) -> list[Step]:
    """Two arcs, one to either side."""
    return [Arc(radius_m, sweep_rad, left=side, speed_mps=speed) for side in (left, not left)]


def letter_u(depth_m: float, width_m: float, left: bool, speed: float | None) -> list[Step]:
    """Down one side, across, up the other."""
    turn = Turn(_QUARTER, left=left)
    return [
        Drive(depth_m, speed_mps=speed),
        turn,
        Drive(width_m, speed_mps=speed),
        turn,
        Drive(depth_m, speed_mps=speed),
    ]
