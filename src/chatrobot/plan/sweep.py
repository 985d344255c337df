"""Sweeps the footprint along a path and finds where it first comes too close to what is known, or leaves its area."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from chatrobot.plan.known_world import Contact, Floats
from chatrobot.robots.profile import Circle, Point

SPACING_M = 0.05
_CHUNK_ROWS = 2000
STUCK_M = 0.05
"""A robot that seems to stand this deep in an obstacle may still move, if it gets no deeper: maps and odometry err."""
GIVE_M = 0.005

Clearance = Callable[[Floats], Floats]
"""Signed metres to spare at points [n, 2]."""


def outline_points(footprint: Sequence[Point], spacing_m: float = SPACING_M) -> Floats:
    """The outline of a polygon as points [n, 2], at most `spacing_m` apart, corners included, and its centre."""
    points: list[Point] = [(0.0, 0.0)]
    for (ax, ay), (bx, by) in zip(footprint, [*footprint[1:], footprint[0]]):
        count = max(1, math.ceil(math.hypot(bx - ax, by - ay) / spacing_m))
        points += [(ax + (bx - ax) * i / count, ay + (by - ay) * i / count) for i in range(count)]
    return np.array(points)


def transformed(outline: Floats, poses: Floats) -> Floats:
    """The outline [k, 2] placed at every pose [n, 3]: [n, k, 2]."""
    cos, sin = np.cos(poses[:, 2:3]), np.sin(poses[:, 2:3])
    x, y = outline[:, 0], outline[:, 1]
    placed = np.empty((len(poses), len(outline), 2))
    placed[..., 0] = poses[:, 0:1] + cos * x - sin * y
    placed[..., 1] = poses[:, 1:2] + sin * x + cos * y
    return placed


def first_contact(
    poses: Floats,
    footprint: Sequence[Point],
    clearance: Clearance,
    margin_m: float,
    *,
    core_stays_clear: bool = True,
) -> Contact | None:
    """The first of [n, 3] poses where any point of the outline has less than `margin_m` to spare.

    Where the first pose itself has less, the robot may go on as long as it does not get (`GIVE_M`) closer, so that
    it can leave a wall it stands at, or come back into its area. With `core_stays_clear` the footprint without its
    outermost `STUCK_M` has to be clear in any case.
    """
    outline = outline_points(footprint)
    _, at_start = _closest(poses[:1], outline, clearance)
    if at_start[0] > margin_m:
        return _first_below(poses, outline, clearance, margin_m)
    found = [_first_below(poses, outline, clearance, float(at_start[0]) - GIVE_M)]
    if core_stays_clear:
        found.append(_first_below(poses, _shrunk(outline), clearance, 0.0))
    return min((contact for contact in found if contact is not None), key=lambda c: c.row, default=None)


def _shrunk(outline: Floats) -> Floats:
    distance = np.hypot(outline[:, 0:1], outline[:, 1:2])
    shrunk: Floats = outline * np.maximum(0.0, 1.0 - STUCK_M / np.maximum(distance, STUCK_M))
    return shrunk


def _first_below(poses: Floats, outline: Floats, clearance: Clearance, needed_m: float) -> Contact | None:
    """A quick look at the circle around the outline first, at the outline itself only where that is too near."""
    radius_m = float(np.hypot(outline[:, 0], outline[:, 1]).max())
    close = np.flatnonzero(clearance(poses[:, :2]) < radius_m + needed_m)
    for begin in range(0, len(close), _CHUNK_ROWS):
        rows = close[begin : begin + _CHUNK_ROWS]
        points, spare = _closest(poses[rows], outline, clearance)
        bad = np.flatnonzero(spare < needed_m)
        if len(bad):
            x, y = points[bad[0]]
            return Contact(int(rows[bad[0]]), float(x), float(y))
    return None


def _closest(poses: Floats, outline: Floats, clearance: Clearance) -> tuple[Floats, Floats]:
    """Per pose the outline point with the least clearance [n, 2], and that clearance [n]."""
    placed = transformed(outline, poses)
    spare = clearance(placed.reshape(-1, 2)).reshape(len(poses), -1)
    worst = spare.argmin(axis=1)
    rows = np.arange(len(poses))
    return placed[rows, worst], spare[rows, worst]


def area_clearance(corners: Sequence[Point]) -> Clearance:
    """Signed distance to the edge of a polygon, positive inside; inside by the even-odd rule."""
    start = np.array(corners, dtype=float)
    end = np.roll(start, -1, axis=0)
    edge = end - start
    length_squared = np.maximum((edge**2).sum(axis=1), 1e-12)

    def clearance(points: Floats) -> Floats:
        offset = points[:, None, :] - start
        along = np.clip((offset * edge).sum(axis=2) / length_squared, 0.0, 1.0)
        distance = np.sqrt(((offset - along[..., None] * edge) ** 2).sum(axis=2).min(axis=1))
        y = points[:, 1:2]
        crosses = (start[:, 1] > y) != (end[:, 1] > y)
        height = np.where(edge[:, 1] == 0.0, 1.0, edge[:, 1])
        right_of = points[:, 0:1] < start[:, 0] + edge[:, 0] * (y - start[:, 1]) / height
        inside = (crosses & right_of).sum(axis=1) % 2 == 1
        signed: Floats = np.where(inside, distance, -distance)
        return signed

    return clearance


def fence_clearance(fence: Circle | Sequence[Point]) -> Clearance:
    """The same for a fence: a circle, or the corners of a polygon."""
    if not isinstance(fence, Circle):
        return area_clearance(fence)

    def clearance(points: Floats) -> Floats:
        away = np.hypot(points[:, 0] - fence.x_m, points[:, 1] - fence.y_m)
        return np.asarray(fence.radius_m - away)

    return clearance


def free_ahead_m(
    pose: tuple[float, float, float],
    footprint: Sequence[Point],
    direction_rad: float,
    clearance: Clearance,
    at_most_m: float,
) -> float:
    """How far the strip the footprint sweeps straight on is free; `at_most_m` if nothing is met before.

    The strip begins at the front of the footprint in the direction of travel (given in the robot's frame), which
    is what the lidar's condition measures from.
    """
    step_m = 0.02
    cos, sin = math.cos(direction_rad), math.sin(direction_rad)
    front = max(x * cos + y * sin for x, y in footprint)
    across = [y * cos - x * sin for x, y in footprint]
    count = max(2, math.ceil((max(across) - min(across)) / SPACING_M) + 1)
    sides = np.linspace(min(across), max(across), count)
    ahead = np.arange(0.0, at_most_m + step_m, step_m)
    along, side = np.meshgrid(front + ahead, sides, indexing="ij")
    x_m, y_m, yaw_rad = pose
    world_cos, world_sin = math.cos(yaw_rad + direction_rad), math.sin(yaw_rad + direction_rad)
    points = np.stack(
        (x_m + world_cos * along - world_sin * side, y_m + world_sin * along + world_cos * side), axis=2
    )
    blocked = (clearance(points.reshape(-1, 2)).reshape(len(ahead), count) <= 0.0).any(axis=1)
    return float(ahead[blocked.argmax()]) if blocked.any() else at_most_m
