"""Which part of the plane a picture shows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from chatrobot.cli.drawing.orientation import XY as XY
from chatrobot.cli.drawing.orientation import Orientation
from chatrobot.sim.world import World


class Extent(NamedTuple):
    """A box along the axes that the map is drawn in (see `Orientation`), metres."""

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
    """The box around `points` as they are drawn, at least `least_m` wide and high; without any around the start."""
    xs, ys = zip(*(tuple(points) or ((0.0, 0.0),)))
    (min_x, max_x), (min_y, max_y) = (
        _widened(min(values) - margin_m, max(values) + margin_m, least_m) for values in (xs, ys)
    )
    return Extent(min_x, min_y, max_x, max_y)


def extent_of_world(world: World, points: Iterable[XY], *, margin_m: float, least_m: float) -> Extent:
    """The box that holds the whole world, the start and `points`, all in the frame of the start."""
    held = [*points]
    if world.bounds is not None:
        held += [(0.0, 0.0), *(pose[:2] for pose in world.places.values())]
        held += [point for _, outline in world.outline() for point in outline]
        held += world.allowed_area.points if world.allowed_area is not None else ()
    return extent_around(Orientation(world).points(held), margin_m=margin_m, least_m=least_m)


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    missing = max(0.0, least - (high - low)) / 2.0
    return low - missing, high + missing
