"""A way once around something keeps its distance from all of it, and has few corners."""

from __future__ import annotations

import itertools
import math

from hypothesis import given
from hypothesis import strategies as st

from chatrobot.plan.ring import convex_hull, ring_around

metres = st.floats(-5.0, 5.0).map(lambda value: round(value, 2))
OFF_M = 0.35


def off_m(point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    """How far a point lies to the left of the line from `a` to `b`."""
    across = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
    return across / math.dist(a, b)


@given(st.lists(st.tuples(metres, metres), min_size=3, max_size=40))
def test_no_side_of_a_ring_is_nearer_than_it_may_be(points: list[tuple[float, float]]) -> None:
    ring = ring_around(points, OFF_M)
    if len(convex_hull(points)) < 3:
        assert ring == ()
        return
    assert 3 <= len(ring) <= 8
    for a, b in itertools.pairwise((*ring, ring[0])):
        if math.dist(a, b) > 0.05:
            assert min(off_m(point, a, b) for point in points) > OFF_M - 0.01


def test_a_square_is_driven_around_on_a_larger_square() -> None:
    ring = ring_around([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5)], 0.5)
    assert sorted((round(x, 9), round(y, 9)) for x, y in ring) == [
        (-0.5, -0.5),
        (-0.5, 1.5),
        (1.5, -0.5),
        (1.5, 1.5),
    ]
