"""The trajectory of `plan.trajectory`, many moments at a time. Imports numpy: rehearsal only."""

from __future__ import annotations

import math

import numpy as np

from chatrobot.plan.known_world import Floats
from chatrobot.plan.trajectory import STRAIGHT_RADPS, Ramp, Segment


def sample_ramp(ramp: Ramp, t_s: Floats) -> tuple[Floats, Floats]:
    """(s, ds/dt), each [n], at times [n] in ascending order."""
    up, down = np.searchsorted(t_s, (ramp.up_end_s, ramp.down_start_s))
    left_s = np.maximum(ramp.total_s - t_s[down:], 0.0)
    rate = np.full(len(t_s), ramp.peak)
    rate[:up] = ramp.k * t_s[:up]
    rate[down:] = ramp.k * left_s
    s = ramp.peak * (t_s - 0.5 * ramp.up_end_s)
    s[:up] = 0.5 * rate[:up] * t_s[:up]
    s[down:] = ramp.hold_s - 0.5 * rate[down:] * left_s
    return s, rate


def sample_poses(segment: Segment, s: Floats) -> Floats:
    """[n, 3] (x_m, y_m, yaw_rad) at progress [n], in the frame of the segment's start."""
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
    """0, tick, 2 tick, … and `total_s` itself at the end, [n] with n >= 2."""
    times = np.arange(0.0, total_s, tick_s)
    return np.append(times if len(times) else [0.0], total_s)
