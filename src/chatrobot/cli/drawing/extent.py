"""Which part of the plane a picture shows, and which way up."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from chatrobot.sim.world import World


class Extent(NamedTuple):
    """A box along the axes that the map is drawn in (see `Orientation`), metres."""

    min_x_m: float
    min_y_m: float
    max_x_m: float
    max_y_m: float

    @property
    def width_m(self) -> float:
        """Along x."""
        return self.max_x_m - self.min_x_m

    @property
    def height_m(self) -> float:
        """Along y."""
        return self.max_y_m - self.min_y_m

    def holds(self, x_m: float, y_m: float) -> bool:
        """Tell whether a point lies in the box."""
        return self.min_x_m <= x_m <= self.max_x_m and self.min_y_m <= y_m <= self.max_y_m


def extent_around(points: Iterable[XY], *, margin_m: float, least_m: float) -> Extent:
    """Return the box around `points` as they are drawn, at least `least_m` wide and high; without any the start."""
    xs, ys = zip(*(tuple(points) or ((0.0, 0.0),)))
    (min_x, max_x), (min_y, max_y) = (
        _widened(min(values) - margin_m, max(values) + margin_m, least_m) for values in (xs, ys)
    )
    return Extent(min_x, min_y, max_x, max_y)


def extent_of_world(world: World, points: Iterable[XY], *, margin_m: float, least_m: float) -> Extent:
    """Return the box that holds the whole world, the start and `points`, all in the frame of the start."""
    held = [*points]
    if world.bounds is not None:
        held += [(0.0, 0.0), *(pose[:2] for pose in world.places.values())]
        held += [point for _, outline in world.outline() for point in outline]
        held += world.allowed_area.points if world.allowed_area is not None else ()
    return extent_around(Orientation(world).points(held), margin_m=margin_m, least_m=least_m)


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    missing = max(0.0, least - (high - low)) / 2.0
    return low - missing, high + missing


XY = tuple[float, float]


class Orientation:
    """Turns what is in the frame of the start (`odom`) about the start into the axes of the world's file."""

    def __init__(self, world: World) -> None:
        self._turn_rad = world.start_yaw_rad
        self._cos, self._sin = math.cos(self._turn_rad), math.sin(self._turn_rad)

    @property
    def is_turned(self) -> bool:
        """The axes of the drawing are not those of `odom`."""
        return self._sin != 0.0 or self._cos < 0.0

    def point(self, x_m: float, y_m: float) -> XY:
        """Turn a point."""
        return self._cos * x_m - self._sin * y_m, self._sin * x_m + self._cos * y_m

    def points(self, points: Iterable[XY]) -> tuple[XY, ...]:
        """Turn points."""
        return tuple(self.point(*point) for point in points)

    def heading_rad(self, yaw_rad: float) -> float:
        """Turn a heading."""
        return yaw_rad + self._turn_rad
