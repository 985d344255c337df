"""The surroundings of the robot, as its body and its lidar meet them. numpy is imported at the first obstacle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from chatrobot.core.geometry import Pose, Twist
from chatrobot.sim.shapes import Point, Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from chatrobot.sim.edges import Edges

CONTACT_M = 1e-4
"""How near to a contact a motion is carried; also what a blocked robot must be able to move to count as free."""

RELEASE_M = 1e-3
"""A robot that has moved so far from where it touched something touches it no more."""


class Surroundings:
    """The shapes of a world and those added to it, and how far a footprint can go among them."""

    def __init__(self, footprint: tuple[Point, ...], shapes: Sequence[Shape]) -> None:
        self._points = footprint
        self._reach_m = max(math.hypot(x, y) for x, y in footprint)
        self._fixed = tuple(shapes)
        self.set_added(())

    def set_added(self, shapes: Sequence[Shape]) -> None:
        """Replace what was added to the world."""
        shapes = (*self._fixed, *shapes)
        self.is_empty = not shapes
        self._free_m = 0.0
        self._edges: Edges | None = None
        if shapes:
            from chatrobot.sim.edges import Edges, Footprint

            self._edges = Edges(shapes)
            self._footprint = Footprint(self._points)

    def free_share(self, start: Pose, twist: Twist, duration_s: float) -> float:
        """Return how much of a short motion (centimetres) is free, 0 to 1."""
        if self._edges is None:
            return 1.0
        path_m = twist.speed_mps * duration_s
        # As long as the robot has come less far than its whole turning circle was clear, nothing can touch it.
        if path_m < self._free_m:
            self._free_m -= path_m
            return 1.0
        end = start.moved(twist, duration_s)
        self._free_m = self._edges.clearance_m(end.x_m, end.y_m) - self._reach_m
        if self._free_m > 0.0 or not self._edges.touch(self._footprint, end):
            return 1.0
        return self._bisect(start, twist, duration_s)

    def raycast(self, eye: Pose, beams: int) -> NDArray[np.float64]:
        """Return metres from `eye` along `beams` directions from -pi on, [beams]; inf where there is nothing."""
        if self._edges is None:
            raise ValueError("there is nothing to see")
        return self._edges.raycast(eye, beams)

    def _bisect(self, start: Pose, twist: Twist, duration_s: float) -> float:
        edges = self._edges
        assert edges is not None
        span_m = (twist.speed_mps + abs(twist.wz_radps) * self._reach_m) * duration_s
        blocked, free = 1.0, 0.0
        if edges.touch(self._footprint, start.moved(twist, duration_s * min(1.0, CONTACT_M / span_m))):
            return 0.0
        while (blocked - free) * span_m > CONTACT_M:
            middle = 0.5 * (blocked + free)
            if edges.touch(self._footprint, start.moved(twist, duration_s * middle)):
                blocked = middle
            else:
                free = middle
        return free
