"""How far the edge of a robot is from what stands in its world, to the millimetre, and what that is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from chatrobot.core.geometry import Pose
from chatrobot.sim.shapes import Circle, Point, Polygon, Shape, edges_cross
from chatrobot.sim.world import Obstacle


class Near(NamedTuple):
    """The thing that is nearest, and how far off its edge is; `inf` and None where there is nothing."""

    distance_m: float = math.inf
    obstacle: Obstacle | None = None


class Nearness:
    """What stands in a world, measured from the edge of one footprint."""

    def __init__(self, footprint: Sequence[Point], obstacles: Sequence[Obstacle]) -> None:
        self._obstacles = tuple(obstacles)
        self._body = Polygon(tuple(footprint))
        self._reach_m = max(math.hypot(x, y) for x, y in footprint)

    def at(self, pose: Pose) -> Near:
        """Return what is nearest to the edge of a robot that stands there, at 0 m where it touches."""
        to_centre = [(each.shape.distance_m(pose.x_m, pose.y_m), each) for each in self._obstacles]
        best = Near()
        for centre_m, obstacle in sorted(to_centre, key=lambda pair: pair[0]):
            if centre_m - self._reach_m >= best.distance_m:
                break  # the rest is further off, however the robot is turned
            distance_m = self._distance_m(obstacle.shape.seen_from(pose))
            if distance_m < best.distance_m:
                best = Near(distance_m, obstacle)
        return best

    def on_the_way(self, poses: Iterable[Pose]) -> Near:
        """Return what was nearest on a way, yaw not wrapped. Of the poses only those are measured that can matter."""
        best, before, free_m = Near(), None, 0.0
        for pose in poses if self._obstacles else ():
            if before is not None:
                free_m -= before.distance_to(pose) + abs(pose.yaw_rad - before.yaw_rad) * self._reach_m
            before = pose
            if free_m < best.distance_m:
                near = self.at(pose)
                free_m = near.distance_m
                best = min(best, near, key=lambda each: each.distance_m)
        return best

    def _distance_m(self, shape: Shape) -> float:
        """Return metres from the edge to a shape in the robot's own frame, 0 where they meet."""
        body = self._body
        if isinstance(shape, Circle):
            return max(0.0, body.distance_m(shape.x_m, shape.y_m) - shape.radius_m)
        if _cross(body.points, shape.points):
            return 0.0
        to_body_m = min(body.distance_m(x, y) for x, y in shape.points)
        to_shape_m = min(shape.distance_m(x, y) for x, y in body.points)
        return max(0.0, min(to_body_m, to_shape_m))


def _cross(one: Sequence[Point], other: Sequence[Point]) -> bool:
    """Return whether any two sides of the two outlines cross."""
    return any(
        edges_cross(a, b, c, d)
        for a, b in zip(one, (*one[1:], one[0]))
        for c, d in zip(other, (*other[1:], other[0]))
    )
