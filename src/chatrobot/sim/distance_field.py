"""Distances from anywhere to the nearest obstacle, precomputed on a grid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from chatrobot.sim.shapes import Circle, Polygon, Shape

Floats = NDArray[np.float64]

FAR_M = 1e6
"""The clearance where there is no obstacle at all."""
RESOLUTION_M = 0.02
MARGIN_M = 0.5
"""How far the grid reaches beyond the outermost obstacle."""
MAX_CELLS = 1_000_000
"""A large world gets a coarser grid: a million cells take about a tenth of a second and 8 MB."""
MANY_SHAPES = 100
REACH_M = 1.2
"""Of a world of many shapes, as a map is, no clearance above this is known: no way asks for more, and each shape then
touches the cells around it alone."""


@dataclass(frozen=True)
class DistanceField:
    """Signed distances to the nearest obstacle at grid points, negative inside.

    `values_m[i, j]` [ny, nx] belongs to the point (origin_x_m + j * resolution_m, origin_y_m + i *
    resolution_m) of the world's frame. At the grid points the distance outside obstacles is exact.
    """

    origin_x_m: float
    origin_y_m: float
    resolution_m: float
    values_m: Floats

    def clearance_m(self, points: Floats) -> Floats:
        """Interpolate bilinearly, and never promise more than there is.

        A distance changes by at most a metre per metre, and a point is at most half a cell's diagonal from
        where the interpolation of its distances holds: that much is subtracted.

        Args:
            points: [n, 2], metres; outside the grid too.

        Returns:
            [n], metres.
        """
        points = np.asarray(points, dtype=float)
        ny, nx = self.values_m.shape
        column = (points[:, 0] - self.origin_x_m) / self.resolution_m
        row = (points[:, 1] - self.origin_y_m) / self.resolution_m
        inside_column = np.clip(column, 0.0, nx - 1.0)
        inside_row = np.clip(row, 0.0, ny - 1.0)
        j = np.minimum(inside_column.astype(np.intp), nx - 2)
        i = np.minimum(inside_row.astype(np.intp), ny - 2)
        u, v = inside_column - j, inside_row - i
        flat, at = self.values_m.ravel(), i * nx + j
        below = flat[at] * (1.0 - u) + flat[at + 1] * u
        above = flat[at + nx] * (1.0 - u) + flat[at + nx + 1] * u
        clearance = below * (1.0 - v) + above * v - self.resolution_m / math.sqrt(2.0)
        beyond = np.hypot(column - inside_column, row - inside_row) * self.resolution_m
        # All obstacles lie within the grid, a convex box: leaving it at a right angle adds a leg to a triangle.
        result: Floats = np.where(beyond > 0.0, np.hypot(np.maximum(clearance, 0.0), beyond), clearance)
        return result


def build_distance_field(shapes: Sequence[Shape]) -> DistanceField:
    """Return the field of `shapes`; a constant `FAR_M` for none of them."""
    if not shapes:
        return DistanceField(-0.5, -0.5, 1.0, np.full((2, 2), FAR_M))
    corners = np.array([point for shape in shapes for point in _box(shape)])
    low, high = corners.min(axis=0) - MARGIN_M, corners.max(axis=0) + MARGIN_M
    area_m2 = float(np.prod(high - low))
    resolution_m = max(RESOLUTION_M, math.sqrt(area_m2 / MAX_CELLS))
    nx, ny = (math.ceil(extent_m / resolution_m) + 1 for extent_m in (high - low).tolist())
    xs = low[0] + resolution_m * np.arange(nx)
    ys = low[1] + resolution_m * np.arange(ny)
    return DistanceField(float(low[0]), float(low[1]), resolution_m, _signed_distances(shapes, xs, ys))


def _signed_distances(shapes: Sequence[Shape], xs: Floats, ys: Floats) -> Floats:
    """Outside: the nearest shape. Inside: as deep as in the shape where it is deepest."""
    reach_m = REACH_M if len(shapes) > MANY_SHAPES else math.inf
    outside_squared = np.full((len(ys), len(xs)), reach_m**2)
    depth = np.zeros_like(outside_squared)
    for shape in shapes:
        (low_x, low_y), (high_x, high_y) = _box(shape)
        j = slice(*np.searchsorted(xs, (low_x - reach_m, high_x + reach_m)))
        i = slice(*np.searchsorted(ys, (low_y - reach_m, high_y + reach_m)))
        _add(shape, xs[j], ys[i], outside_squared[i, j], depth[i, j])
    signed: Floats = np.where(depth > 0.0, -depth, np.sqrt(outside_squared))
    return signed


def _add(shape: Shape, xs: Floats, ys: Floats, outside_squared: Floats, depth: Floats) -> None:
    if isinstance(shape, Circle):
        gap = np.hypot(xs[None, :] - shape.x_m, ys[:, None] - shape.y_m) - shape.radius_m
    elif (sides := _rectangle_of(shape)) is None:
        gap = _polygon_distance(shape, xs, ys)
    elif sides.is_upright:
        _add_upright(_box(shape), xs, ys, outside_squared, depth)
        return
    else:
        dx, dy = xs[None, :] - sides.x_m, ys[:, None] - sides.y_m
        cos, sin = math.cos(sides.yaw_rad), math.sin(sides.yaw_rad)
        along = np.abs(dx * cos + dy * sin) - sides.half_length_m
        beside = np.abs(dy * cos - dx * sin) - sides.half_width_m
        outside = np.hypot(np.maximum(along, 0.0), np.maximum(beside, 0.0))
        gap = outside + np.minimum(np.maximum(along, beside), 0.0)
    np.minimum(outside_squared, np.maximum(gap, 0.0) ** 2, out=outside_squared)
    np.maximum(depth, -gap, out=depth)


def _add_upright(box: _Box, xs: Floats, ys: Floats, outside_squared: Floats, depth: Floats) -> None:
    """A rectangle along the axes splits into both, which makes it ten times as quick as any other polygon."""
    (low_x, low_y), (high_x, high_y) = box
    gap_x, gap_y = np.maximum(low_x - xs, xs - high_x), np.maximum(low_y - ys, ys - high_y)
    squared = (np.maximum(gap_x, 0.0) ** 2)[None, :] + (np.maximum(gap_y, 0.0) ** 2)[:, None]
    np.minimum(outside_squared, squared, out=outside_squared)
    j = slice(*np.searchsorted(xs, (low_x, high_x)))
    i = slice(*np.searchsorted(ys, (low_y, high_y)))
    inner = np.minimum(-gap_x[None, j], -gap_y[i, None])
    np.maximum(depth[i, j], inner, out=depth[i, j])


def _polygon_distance(shape: Polygon, xs: Floats, ys: Floats) -> Floats:
    """Signed distance [ny, nx] to any polygon: nearest edge, and even-odd crossings for the sign."""
    x, y = xs[None, :], ys[:, None]
    nearest_squared = np.full((len(ys), len(xs)), np.inf)
    inside = np.zeros(nearest_squared.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(shape.points, shape.points[1:] + shape.points[:1]):
        ex, ey = bx - ax, by - ay
        along = np.clip(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0.0, 1.0)
        squared = (x - ax - along * ex) ** 2 + (y - ay - along * ey) ** 2
        np.minimum(nearest_squared, squared, out=nearest_squared)
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ex * (y - ay) / ey + ax)
    distance = np.sqrt(nearest_squared)
    signed: Floats = np.where(inside, -distance, distance)
    return signed


class _Rectangle(NamedTuple):
    """Its centre, where its length points, and half its sides."""

    x_m: float
    y_m: float
    yaw_rad: float
    half_length_m: float
    half_width_m: float

    @property
    def is_upright(self) -> bool:
        """Its sides lie along the axes."""
        return min(abs(math.cos(self.yaw_rad)), abs(math.sin(self.yaw_rad))) < 1e-9


def _rectangle_of(shape: Polygon) -> _Rectangle | None:
    """Return the shape as a rectangle, if it is one."""
    if len(shape.points) != 4:
        return None
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = shape.points
    length_m, width_m = math.hypot(bx - ax, by - ay), math.hypot(cx - bx, cy - by)
    is_closed = math.hypot(ax + cx - bx - dx, ay + cy - by - dy) < 1e-9
    leaning = (bx - ax) * (cx - bx) + (by - ay) * (cy - by)
    if min(length_m, width_m) < 1e-9 or not is_closed or abs(leaning) > 1e-9 * length_m * width_m:
        return None
    yaw_rad = math.atan2(by - ay, bx - ax)
    return _Rectangle((ax + cx) / 2.0, (ay + cy) / 2.0, yaw_rad, length_m / 2.0, width_m / 2.0)


_Box = tuple[tuple[float, float], tuple[float, float]]
"""The lower left and the upper right corner."""


def _box(shape: Shape) -> _Box:
    if isinstance(shape, Circle):
        r = shape.radius_m
        return (shape.x_m - r, shape.y_m - r), (shape.x_m + r, shape.y_m + r)
    xs, ys = zip(*shape.points)
    return (min(xs), min(ys)), (max(xs), max(ys))
