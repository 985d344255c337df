"""Which way up a world is drawn: as its file has it, x to the right and y up, whichever way the robot starts."""

from __future__ import annotations

import math
from collections.abc import Iterable

from chatrobot.sim.world import World

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
        return self._cos * x_m - self._sin * y_m, self._sin * x_m + self._cos * y_m

    def points(self, points: Iterable[XY]) -> tuple[XY, ...]:
        return tuple(self.point(*point) for point in points)

    def heading_rad(self, yaw_rad: float) -> float:
        return yaw_rad + self._turn_rad
