"""Paths as rows of poses: sampled from a trajectory, as the governor lets them through, and swept by a footprint."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.plan.known_world import Contact, Floats, GovernorKernel
from chatrobot.plan.trajectory import STRAIGHT_RADPS, Ramp, Segment
from chatrobot.robots.profile import Circle, Point


def sample_ramp(ramp: Ramp, t_s: Floats) -> Floats:
    """Return the progress s [n], seconds of the full twist, at times [n] in ascending order."""
    up, down = np.searchsorted(t_s, (ramp.up_end_s, ramp.down_start_s))
    left_s = np.maximum(ramp.total_s - t_s[down:], 0.0)
    s: Floats = ramp.peak * (t_s - 0.5 * ramp.up_end_s)
    s[:up] = 0.5 * (ramp.slope_per_s * t_s[:up]) * t_s[:up]
    s[down:] = ramp.hold_s - 0.5 * (ramp.slope_per_s * left_s) * left_s
    return s


def sample_poses(segment: Segment, s: Floats) -> Floats:
    """Return poses [n, 3] (x_m, y_m, yaw_rad) at progress [n], in the frame of the segment's start."""
    vx, vy, wz = segment.motion.twist
    start = segment.start
    poses = np.empty((len(s), 3))
    poses[:, 2] = yaw = start.yaw_rad + wz * s
    cos0, sin0 = math.cos(start.yaw_rad), math.sin(start.yaw_rad)
    if abs(wz) < STRAIGHT_RADPS:  # turned by half the bend: the chord, exact to third order in a tiny angle
        half = start.yaw_rad + 0.5 * wz * s
        cos, sin = np.cos(half), np.sin(half)
        poses[:, 0] = start.x_m + s * (cos * vx - sin * vy)
        poses[:, 1] = start.y_m + s * (sin * vx + cos * vy)
        return poses
    cos, sin = np.cos(yaw), np.sin(yaw)
    poses[:, 0] = start.x_m + ((sin - sin0) * vx + (cos - cos0) * vy) / wz
    poses[:, 1] = start.y_m + ((sin - sin0) * vy - (cos - cos0) * vx) / wz
    return poses


def tick_times(total_s: float, tick_s: float) -> Floats:
    """Return 0, tick, 2 tick, … and `total_s` itself at the end, [n] with n >= 2."""
    times = np.arange(0.0, total_s, tick_s)
    return np.append(times if len(times) else [0.0], total_s)


_SAME = 1e-6
_STOPPED_TICKS = 500  # ten seconds to come to rest after the reference has


class GovernorCheck:
    """Asks a kernel about motions, each kind of motion once: the kernel is pure and every motion starts from rest."""

    def __init__(self, kernel: GovernorKernel) -> None:
        self._kernel = kernel
        self._passed: set[tuple[Twist, float, float]] = set()

    def changed(self, segment: Segment) -> tuple[Twist, Floats] | None:
        """Return None if every reference twist passes unchanged, as it should.

        Otherwise the slowest share of it that got through at full speed, and the integrated rows [n, 4] (t_s from
        0, x_m, y_m, yaw_rad) of what the governor would really send.
        """
        key = (segment.motion.twist, segment.ramp.hold_s, segment.ramp.slope_per_s)
        if key in self._passed:
            return None
        if self._passes(segment):
            self._passed.add(key)
            return None
        return self._integrated(segment)

    def _passes(self, segment: Segment) -> bool:
        twist, ramp = segment.motion.twist, segment.ramp
        previous = ZERO_TWIST
        tick = 0
        while tick * TICK_S < ramp.total_s:
            tick += 1
            asked = twist.scaled(ramp.at(tick * TICK_S)[1])
            if not _same(self._kernel(previous, asked, TICK_S), asked):
                return False
            if asked == previous:  # level: a pure kernel says the same until the ramp down begins
                tick = max(tick, int(ramp.down_start_s / TICK_S) - 1)
            previous = asked
        return True

    def _integrated(self, segment: Segment) -> tuple[Twist, Floats]:
        ramp, twist = segment.ramp, segment.motion.twist
        pose, sent, fastest = segment.start, ZERO_TWIST, ZERO_TWIST
        rows: list[tuple[float, float, float, float]] = [(0.0, *pose)]
        tick, last_tick = 0, int(ramp.total_s / TICK_S) + _STOPPED_TICKS
        while tick * TICK_S < ramp.total_s or (not sent.is_zero and tick < last_tick):
            tick += 1
            sent = self._kernel(sent, twist.scaled(ramp.at(tick * TICK_S)[1]), TICK_S)
            pose = pose.moved(sent, TICK_S)
            fastest = max(fastest, sent, key=_size)
            rows.append((tick * TICK_S, *pose))
        return fastest, np.array(rows)


def _size(twist: Twist) -> float:
    return twist.speed_mps + abs(twist.wz_radps)


def _same(one: Twist, other: Twist) -> bool:
    return (
        abs(one.vx_mps - other.vx_mps) < _SAME
        and abs(one.vy_mps - other.vy_mps) < _SAME
        and abs(one.wz_radps - other.wz_radps) < _SAME
    )


def pose_of(row: Floats) -> Pose:
    """Return the pose in a row (t_s, x_m, y_m, yaw_rad)."""
    return Pose(float(row[1]), float(row[2]), float(row[3]))


SPACING_M = 0.05
_CHUNK_ROWS = 2000
STUCK_M = 0.05
"""A robot that seems to stand this deep in an obstacle may still move, if it gets no deeper: maps and odometry err."""
GIVE_M = 0.005

Clearance = Callable[[Floats], Floats]
"""Signed metres to spare at points [n, 2]."""


def outline_points(footprint: Sequence[Point]) -> Floats:
    """Return the outline of a polygon as points [n, 2], at most `SPACING_M` apart, corners included, and its centre."""
    points: list[Point] = [(0.0, 0.0)]
    for (ax, ay), (bx, by) in zip(footprint, [*footprint[1:], footprint[0]]):
        count = max(1, math.ceil(math.hypot(bx - ax, by - ay) / SPACING_M))
        points += [(ax + (bx - ax) * i / count, ay + (by - ay) * i / count) for i in range(count)]
    return np.array(points)


def transformed(outline: Floats, poses: Floats) -> Floats:
    """Return the outline [k, 2] placed at every pose [n, 3]: [n, k, 2]."""
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
) -> Contact | None:
    """Return the first of [n, 3] poses where any point of the outline has less than `margin_m` to spare.

    Where the first pose itself has less, the robot may go on as long as it does not get (`GIVE_M`) closer, so that
    it can leave a wall it stands at. The footprint without its outermost `STUCK_M` has to be clear in any case.
    """
    outline = outline_points(footprint)
    _, at_start = closest(poses[:1], outline, clearance)
    if at_start[0] > margin_m:
        return _first_below(poses, outline, clearance, margin_m)
    found = [
        _first_below(poses, outline, clearance, float(at_start[0]) - GIVE_M),
        _first_below(poses, _shrunk(outline), clearance, 0.0),
    ]
    return min((contact for contact in found if contact is not None), key=lambda c: c.row, default=None)


def _shrunk(outline: Floats) -> Floats:
    distance = np.hypot(outline[:, 0:1], outline[:, 1:2])
    shrunk: Floats = outline * np.maximum(0.0, 1.0 - STUCK_M / np.maximum(distance, STUCK_M))
    return shrunk


def _first_below(poses: Floats, outline: Floats, clearance: Clearance, needed_m: float) -> Contact | None:
    """Look at the circle around the outline first, at the outline itself only where that is too near."""
    radius_m = float(np.hypot(outline[:, 0], outline[:, 1]).max())
    close = np.flatnonzero(clearance(poses[:, :2]) < radius_m + needed_m)
    for begin in range(0, len(close), _CHUNK_ROWS):
        rows = close[begin : begin + _CHUNK_ROWS]
        points, spare = closest(poses[rows], outline, clearance)
        bad = np.flatnonzero(spare < needed_m)
        if len(bad):
            x, y = points[bad[0]]
            return Contact(int(rows[bad[0]]), float(x), float(y))
    return None


def closest(poses: Floats, outline: Floats, clearance: Clearance) -> tuple[Floats, Floats]:
    """Return per pose the outline point with the least clearance [n, 2], and that clearance [n]."""
    placed = transformed(outline, poses)
    spare = clearance(placed.reshape(-1, 2)).reshape(len(poses), -1)
    worst = spare.argmin(axis=1)
    rows = np.arange(len(poses))
    return placed[rows, worst], spare[rows, worst]


def area_clearance(corners: Sequence[Point]) -> Clearance:
    """Return the signed distance to the edge of a polygon, positive inside; inside by the even-odd rule."""
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
    """Return the same for a fence: a circle, or the corners of a polygon."""
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
    """Return how far the strip the footprint sweeps straight on is free; `at_most_m` if nothing is met before.

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


STANDING = 1e-9
"""Rows of a path that differ by less are the same."""


class Most(NamedTuple):
    """Limits how far and how long a plan may drive that is offered; while it waits it does not drive."""

    length_m: float = math.inf
    driving_s: float = math.inf

    def first_row_over(self, rows: Floats) -> int:
        """Return the first of the rows [n, 4] of a path that is beyond it; n where none is."""
        steps = np.diff(rows, axis=0)
        driven_m = np.cumsum(np.hypot(steps[:, 1], steps[:, 2]))
        moves = np.any(np.abs(steps[:, 1:]) > STANDING, axis=1)
        over = (driven_m > self.length_m + STANDING) | (np.cumsum(steps[:, 0] * moves) > self.driving_s)
        found = np.flatnonzero(over)
        return int(found[0]) + 1 if len(found) else len(rows)

    def allows(self, rows: Floats) -> bool:
        """Return True where the whole path [n, 4] is within it."""
        return self.first_row_over(rows) == len(rows)


ANY_WAY = Most()
