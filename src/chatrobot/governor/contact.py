"""When would this twist touch something? In seconds of the twist itself, so that one rule serves every direction.

A robot that follows a constant twist sweeps its footprint along a screw motion. For points that the lidar saw, the
clearance of the footprint is sampled along that motion; where it falls below the margin, there is contact. Forward,
backward, sideways and turning are the same arithmetic.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from chatrobot.core.geometry import Twist
from chatrobot.robots.profile import Point

Floats = NDArray[np.float64]

SAMPLES = 17
SHRINKS_BY_M = 0.001
"""A point that is within the margin already counts only if the motion brings it nearer: away is always allowed."""


class Footprint:
    """A convex footprint as half planes: `clearance` is the distance to it, positive outside.

    Beside a corner the half planes understate the distance: an error to the safe side.
    """

    def __init__(self, points: tuple[Point, ...]) -> None:
        corners = np.asarray(points, dtype=np.float64)
        edges = np.roll(corners, -1, axis=0) - corners
        lengths = np.hypot(edges[:, 0], edges[:, 1])
        self._normals = np.stack([edges[:, 1] / lengths, -edges[:, 0] / lengths], axis=1)
        self._offsets = np.sum(self._normals * corners, axis=1)
        self.radius_m = float(np.hypot(corners[:, 0], corners[:, 1]).max())

    def clearance_m(self, points: Floats) -> Floats:
        """Of points [..., 2] in the robot's frame: [...]."""
        return np.asarray(np.max(points @ self._normals.T - self._offsets, axis=-1))


def seconds_to_contact(
    footprint: Footprint, points: Floats, twist: Twist, horizon_s: float, margin_m: float
) -> float:
    """How long `twist` may be followed before a point comes within `margin_m` of the footprint.

    Args:
        points: [n, 2], metres, in the robot's frame.
        horizon_s: how far to look, in seconds of the twist.

    Returns:
        Seconds, 0 where contact is imminent; infinite where there is none within the horizon.
    """
    reach_m = (
        footprint.radius_m
        + margin_m
        + (twist.speed_mps + abs(twist.wz_radps) * footprint.radius_m) * horizon_s
    )
    near = points[np.hypot(points[:, 0], points[:, 1]) <= reach_m]
    if len(near) == 0:
        return math.inf
    times = np.linspace(0.0, horizon_s, SAMPLES)
    clearance = footprint.clearance_m(_seen_along(near, twist, times))
    worrying = (clearance <= margin_m) & (clearance < clearance[0] - SHRINKS_BY_M)
    hits = np.flatnonzero(worrying.any(axis=1))
    if len(hits) == 0:
        return math.inf
    row = int(hits[0])
    before, after = clearance[row - 1], clearance[row]
    worst = worrying[row]
    if (before[worst] <= margin_m).any():  # within the margin already, and coming nearer
        return float(times[row - 1])
    share = np.min((before[worst] - margin_m) / (before[worst] - after[worst]))
    return float(times[row - 1] + share * (times[row] - times[row - 1]))


def _seen_along(points: Floats, twist: Twist, times: Floats) -> Floats:
    """The points as the robot sees them while it follows the twist: [times, n, 2]."""
    angle = twist.wz_radps * times
    small = np.abs(angle) < 1e-6
    safe = np.where(small, 1.0, angle)
    sin_over = np.where(small, 1.0, np.sin(safe) / safe)
    cos_over = np.where(small, angle / 2.0, (1.0 - np.cos(safe)) / safe)
    dx, dy = twist.vx_mps * times, twist.vy_mps * times
    moved_x, moved_y = sin_over * dx - cos_over * dy, cos_over * dx + sin_over * dy
    away_x = points[None, :, 0] - moved_x[:, None]
    away_y = points[None, :, 1] - moved_y[:, None]
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.stack([cos * away_x + sin * away_y, -sin * away_x + cos * away_y], axis=-1)
