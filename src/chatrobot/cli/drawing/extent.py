"""Which part of the plane a picture shows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from chatrobot.sim.world import World

XY = tuple[float, float]


class Extent(NamedTuple):
    """An axis-aligned box in the frame of the world, metres."""

    min_x_m: float
    min_y_m: float
    max_x_m: float
    max_y_m: float

    @property
    def width_m(self) -> float:
        return self.max_x_m - self.min_x_m

    @property
    def height_m(self) -> float:
        return self.max_y_m - self.min_y_m

    def holds(self, x_m: float, y_m: float) -> bool:
        return self.min_x_m <= x_m <= self.max_x_m and self.min_y_m <= y_m <= self.max_y_m


def extent_around(points: Iterable[XY], *, margin_m: float, least_m: float) -> Extent:
    """The box around `points` with a margin, at least `least_m` wide and high; around the origin if there are none."""
    xs, ys = zip(*(tuple(points) or ((0.0, 0.0),)))
    (min_x, max_x), (min_y, max_y) = (
        _widened(min(values) - margin_m, max(values) + margin_m, least_m) for values in (xs, ys)
    )
    return Extent(min_x, min_y, max_x, max_y)


def extent_of_world(world: World, points: Iterable[XY], *, margin_m: float, least_m: float) -> Extent:
    """The box that holds the whole world and `points`."""
    bounds = world.bounds
    corners = () if bounds is None else ((bounds.min_x_m, bounds.min_y_m), (bounds.max_x_m, bounds.max_y_m))
    return extent_around((*corners, *points), margin_m=margin_m, least_m=least_m)


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    missing = max(0.0, least - (high - low)) / 2.0
    return low - missing, high + missing
