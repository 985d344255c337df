"""Flat shapes in plain Python: what obstacles are made of. Metres, in whatever frame their owner says."""

from __future__ import annotations

import math
from dataclasses import dataclass

from chatrobot.core.geometry import Pose

Point = tuple[float, float]


@dataclass(frozen=True)
class Polygon:
    """A simple polygon, convex or not, its corners counter-clockwise (`polygon` sees to that)."""

    points: tuple[Point, ...]

    def seen_from(self, origin: Pose) -> Polygon:
        """Return the same polygon expressed in the frame that `origin` describes."""
        return Polygon(tuple(_point_seen_from(point, origin) for point in self.points))

    def distance_m(self, x_m: float, y_m: float) -> float:
        """Return metres from a point to the outline; negative inside."""
        corners = zip(self.points, self.points[1:] + self.points[:1])
        outline_m = min(_distance_to_segment_m(x_m, y_m, a, b) for a, b in corners)
        return -outline_m if self._contains(x_m, y_m) else outline_m

    def _contains(self, x_m: float, y_m: float) -> bool:
        inside = False
        for (ax, ay), (bx, by) in zip(self.points, self.points[1:] + self.points[:1]):
            if (ay > y_m) != (by > y_m) and x_m < (bx - ax) * (y_m - ay) / (by - ay) + ax:
                inside = not inside
        return inside

    def outline(self) -> tuple[Point, ...]:
        """Return its corners."""
        return self.points


@dataclass(frozen=True)
class Circle:
    """A disc."""

    x_m: float
    y_m: float
    radius_m: float

    def seen_from(self, origin: Pose) -> Circle:
        """Return the same circle expressed in the frame that `origin` describes."""
        x_m, y_m = _point_seen_from((self.x_m, self.y_m), origin)
        return Circle(x_m, y_m, self.radius_m)

    def distance_m(self, x_m: float, y_m: float) -> float:
        """Return metres from a point to the rim; negative inside."""
        return math.hypot(x_m - self.x_m, y_m - self.y_m) - self.radius_m

    def outline(self) -> tuple[Point, ...]:
        """Return a polygon of 24 corners, for drawing."""
        angles = [math.tau * i / 24 for i in range(24)]
        return tuple(
            (self.x_m + self.radius_m * math.cos(a), self.y_m + self.radius_m * math.sin(a)) for a in angles
        )


Shape = Polygon | Circle


def polygon(points: tuple[Point, ...]) -> Polygon:
    """Make a polygon from corners in either sense of rotation.

    Raises:
        ValueError: fewer than three corners, or no area, or edges that cross.
    """
    if len(points) < 3:
        raise ValueError(f"a polygon has at least 3 corners, not {len(points)}")
    if _crosses_itself(points):
        raise ValueError("the edges of a polygon must not cross")
    twice_area = sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1]))
    if abs(twice_area) < 1e-9:
        raise ValueError("the corners of a polygon must not lie on one line")
    return Polygon(points if twice_area > 0.0 else tuple(reversed(points)))


def _crosses_itself(points: tuple[Point, ...]) -> bool:
    edges = [*zip(points, points[1:] + points[:1])]
    return any(edges_cross(*one, *other) for i, one in enumerate(edges) for other in edges[i + 2 :])


def edges_cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Return whether the edge from `a` to `b` goes through that from `c` to `d`; not where they only touch."""
    return side_of(a, b, c) * side_of(a, b, d) < 0.0 and side_of(c, d, a) * side_of(c, d, b) < 0.0


def side_of(a: Point, b: Point, of: Point) -> float:
    """Return a number that is positive on the left of the line from `a` to `b`, negative on the right."""
    return (b[0] - a[0]) * (of[1] - a[1]) - (b[1] - a[1]) * (of[0] - a[0])


def rectangle(x_m: float, y_m: float, length_m: float, width_m: float, yaw_rad: float = 0.0) -> Polygon:
    """Make a rectangle by its centre, `length_m` along its own x axis, which looks along `yaw_rad`."""
    half_x, half_y = length_m / 2.0, width_m / 2.0
    cos, sin = math.cos(yaw_rad), math.sin(yaw_rad)
    corners = ((-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y))
    return Polygon(tuple((x_m + cos * x - sin * y, y_m + sin * x + cos * y) for x, y in corners))


def _point_seen_from(point: Point, origin: Pose) -> Point:
    seen = Pose(point[0], point[1]).relative_to(origin)
    return seen.x_m, seen.y_m


def _distance_to_segment_m(x_m: float, y_m: float, a: Point, b: Point) -> float:
    ex, ey = b[0] - a[0], b[1] - a[1]
    length_squared = ex * ex + ey * ey
    along = ((x_m - a[0]) * ex + (y_m - a[1]) * ey) / length_squared if length_squared > 0.0 else 0.0
    along = min(1.0, max(0.0, along))
    return math.hypot(x_m - a[0] - along * ex, y_m - a[1] - along * ey)
