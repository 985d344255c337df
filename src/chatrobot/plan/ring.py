"""The way once around something: its convex hull, moved outwards."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence

from chatrobot.sim.shapes import Point, side_of

RING_MARGIN_M = 0.12
"""How far a robot keeps from what it drives around."""
_MOST_CORNERS = 8
_SAME_M = 1e-3


def ring_around(points: Iterable[Point], off_m: float) -> tuple[Point, ...]:
    """Return the corners, counter-clockwise, of a convex way that keeps `off_m` from the hull of `points`.

    A hull of more than 8 corners, such as that of a disc, is replaced by an octagon about its middle.
    Empty for fewer than three points that are on no line.
    """
    hull = convex_hull(points)
    if len(hull) < 3:
        return ()
    if len(hull) > _MOST_CORNERS:
        hull = _octagon(hull)
    around = (hull[-1], *hull, hull[0])
    return tuple(
        _outwards(before, at, after, off_m) for before, at, after in zip(around, around[1:], around[2:])
    )


def convex_hull(points: Iterable[Point]) -> list[Point]:
    """Return the corners of the hull, counter-clockwise (Andrew's monotone chain, 1979)."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered
    return [*_chain(ordered)[:-1], *_chain(ordered[::-1])[:-1]]


def _chain(ordered: Sequence[Point]) -> list[Point]:
    chain: list[Point] = []
    for point in ordered:
        while len(chain) > 1 and side_of(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _octagon(hull: Sequence[Point]) -> list[Point]:
    """The tangents at every eighth of a turn, cut with each other: they hold the whole hull."""
    sides = [math.pi / 4.0 * k for k in range(_MOST_CORNERS)]
    reach = [max(x * math.cos(a) + y * math.sin(a) for x, y in hull) for a in sides]
    corners = []
    for (a, r), (b, s) in itertools.pairwise([*zip(sides, reach), (sides[0], reach[0])]):
        x = (r * math.sin(b) - s * math.sin(a)) / math.sin(b - a)
        y = (s * math.cos(a) - r * math.cos(b)) / math.sin(b - a)
        corners.append((x, y))
    return [at for at, other in itertools.pairwise((*corners, corners[0])) if math.dist(at, other) > _SAME_M]


def _outwards(before: Point, at: Point, after: Point, off_m: float) -> Point:
    """A corner moved so far that both its sides are `off_m` farther out."""
    first = math.atan2(at[1] - before[1], at[0] - before[0]) - math.pi / 2.0
    turn = math.remainder(
        math.atan2(after[1] - at[1], after[0] - at[0]) - math.pi / 2.0 - first, 2.0 * math.pi
    )
    far_m = off_m / math.cos(turn / 2.0)
    return at[0] + far_m * math.cos(first + turn / 2.0), at[1] + far_m * math.sin(first + turn / 2.0)


def point_beside(ring: Sequence[Point], towards: Point, off_m: float = 0.0) -> Point:
    """Return the point of a convex ring, `off_m` farther out, on the way from its middle towards a point."""
    middle = middle_of(ring)
    way_m = math.dist(middle, towards)
    ux, uy = ((towards[0] - middle[0]) / way_m, (towards[1] - middle[1]) / way_m) if way_m else (1.0, 0.0)
    reach_m = math.inf
    for (ax, ay), (bx, by) in zip(ring, [*ring[1:], ring[0]]):
        out = (by - ay) * ux - (bx - ax) * uy
        if out > 0.0:
            reach_m = min(reach_m, ((by - ay) * (ax - middle[0]) - (bx - ax) * (ay - middle[1])) / out)
    return middle[0] + (reach_m + off_m) * ux, middle[1] + (reach_m + off_m) * uy


def middle_of(ring: Sequence[Point]) -> Point:
    """Return the mean of the corners."""
    return sum(x for x, _ in ring) / len(ring), sum(y for _, y in ring) / len(ring)
