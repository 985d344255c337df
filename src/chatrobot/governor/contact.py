"""Time to contact: in seconds of the twist itself, so that one rule serves every direction.

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
REACH_OF_CONTACT = 2.0
"""Radii of the footprint: beside a sharp corner its half planes reach far."""
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
        normals = np.stack([edges[:, 1] / lengths, -edges[:, 0] / lengths], axis=1)
        offsets = np.sum(normals * corners, axis=1)
        self._planes = [(float(x), float(y), float(away)) for (x, y), away in zip(normals, offsets)]
        self.radius_m = float(np.hypot(corners[:, 0], corners[:, 1]).max())

    def clearance_m(self, x_m: Floats, y_m: Floats) -> Floats:
        """Return the clearance of points in the robot's frame, in the shape of both."""
        # One plane after the other: numpy is slow along a short last axis, and this is most of what a tick costs.
        clearance = np.full_like(x_m, -math.inf)
        for normal_x, normal_y, away in self._planes:
            np.maximum(clearance, normal_x * x_m + normal_y * y_m - away, out=clearance)
        return clearance

    def kept_m(self, x_m: Floats, y_m: Floats) -> Floats:
        """Return what points on a way, [times, n], keep clear at least from one time to the next, [times - 1, n].

        A point that passes a corner is nearest between two times. Its distance to each side goes nearly straight.
        """
        kept = np.full_like(x_m[1:], -math.inf)
        for normal_x, normal_y, away in self._planes:
            distance = normal_x * x_m + normal_y * y_m - away
            np.maximum(kept, np.minimum(distance[:-1], distance[1:]), out=kept)
        return kept

    def nearest_m(self, points: Floats, within_m: float) -> float:
        """Return the clearance of the nearest of points [n, 2] in the robot's frame; infinite beyond `within_m`."""
        reach_m = self.radius_m + within_m
        close = points[np.einsum("ij,ij->i", points, points) <= reach_m * reach_m]
        return float(self.clearance_m(close[:, 0], close[:, 1]).min(initial=math.inf))


def seconds_to_contact(
    footprint: Footprint, points: Floats, twist: Twist, horizon_s: float, margin_m: float
) -> float:
    """Return how long `twist` may be followed before a point comes within `margin_m` of the footprint.

    Args:
        points: [n, 2], metres, in the robot's frame.
        horizon_s: how far to look, in seconds of the twist.

    Returns:
        Seconds, 0 where contact is imminent; infinite where there is none within the horizon.
    """
    within_m = footprint.radius_m + margin_m
    farthest_m = within_m + twist.speed_mps * horizon_s
    if np.einsum("ij,ij->i", points, points).min(initial=math.inf) > farthest_m * farthest_m:
        return math.inf
    times = np.linspace(0.0, horizon_s, SAMPLES)
    angle, moved_x, moved_y = _moved(twist, times)
    middle_x, middle_y = moved_x[SAMPLES // 2], moved_y[SAMPLES // 2]
    # All places that are looked at lie in a disc about the middle one.
    wander_m = float(np.hypot(moved_x - middle_x, moved_y - middle_y).max())
    near = points[np.hypot(points[:, 0] - middle_x, points[:, 1] - middle_y) <= within_m + wander_m]
    if len(near) == 0:
        return math.inf
    clearance = footprint.clearance_m(*_seen_from(near, angle, moved_x, moved_y))
    return seconds_until_below(clearance, times, margin_m)


def seconds_until_below(clearance: Floats, times: Floats, margin_m: float) -> float:
    """Return when a clearance [times, n], metres, falls to `margin_m`, in seconds; infinite where it does not.

    What is below it already counts only where it shrinks: from the moment before that.
    """
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


def comes_nearer(
    footprint: Footprint, points: Floats, twist: Twist, horizon_s: float, nearest_m: float, by_m: float
) -> bool:
    """Return True where `twist` brings a point nearer, by more than `by_m`, than it is and than the nearest one is.

    Args:
        points: [n, 2], metres, in the robot's frame.
        horizon_s: how far to look, in seconds of the twist.
        nearest_m: the clearance of the nearest.
    """
    reach_m = REACH_OF_CONTACT * footprint.radius_m
    near = points[np.einsum("ij,ij->i", points, points) <= reach_m * reach_m]
    moved = _moved(twist, np.linspace(0.0, horizon_s, SAMPLES))
    allowed_m = np.minimum(footprint.clearance_m(near[:, 0], near[:, 1]), nearest_m) - by_m
    return bool((footprint.kept_m(*_seen_from(near, *moved)) < allowed_m).any())


def _moved(twist: Twist, times: Floats) -> tuple[Floats, Floats, Floats]:
    """Heading, x and y of a robot that follows the twist from the origin, at each time."""
    angle = twist.wz_radps * times
    small = np.abs(angle) < 1e-6
    safe = np.where(small, 1.0, angle)
    sin_over = np.where(small, 1.0, np.sin(safe) / safe)
    cos_over = np.where(small, angle / 2.0, (1.0 - np.cos(safe)) / safe)
    dx, dy = twist.vx_mps * times, twist.vy_mps * times
    return angle, sin_over * dx - cos_over * dy, cos_over * dx + sin_over * dy


def _seen_from(points: Floats, angle: Floats, moved_x: Floats, moved_y: Floats) -> tuple[Floats, Floats]:
    """x and y, [times, n] each, of the points as the robot sees them from each of those poses."""
    away_x, away_y = points[:, 0] - moved_x[:, None], points[:, 1] - moved_y[:, None]
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return cos * away_x + sin * away_y, cos * away_y - sin * away_x
