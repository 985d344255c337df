"""The fence: the footprint stays inside an area of `odom`, and brakes before its edge as before a wall."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.braking import Braking
from chatrobot.governor.contact import SAMPLES, SHRINKS_BY_M, Floats
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.plan.sweep import fence_clearance, outline_points, transformed
from chatrobot.robots.profile import Circle, Point, RobotProfile


class FenceRule:
    """Keeps the robot inside; one that stands outside may only come nearer.

    Args:
        fence: a circle, or the corners of a polygon, in `odom`. It means nothing once odometry begins anew.
    """

    name = "fence"

    def __init__(self, profile: RobotProfile, fence: Circle | Sequence[Point]) -> None:
        self._limits = profile.limits
        self._outline = outline_points(profile.footprint)
        self._radius_m = profile.footprint_radius_m
        self._clearance = fence_clearance(fence)

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        pose = situation.pose
        if asked.is_zero:
            return FREE
        if pose is None:
            return Ruling(0.0, Reason("sensor_silent", {"sensor": "odom"}))
        braking = Braking(self._limits, asked)
        reach_m = asked.speed_mps * braking.horizon_s  # of its middle; however it turns, no corner is farther
        if float(self._clearance(np.array([pose[:2]]))[0]) > self._radius_m + reach_m:
            return FREE
        times = np.linspace(0.0, braking.horizon_s, SAMPLES)
        poses = np.array([pose.moved(asked, time_s) for time_s in times.tolist()])
        placed = transformed(self._outline, poses).reshape(-1, 2)
        spare = self._clearance(placed).reshape(SAMPLES, -1).min(axis=1)
        factor = braking.factor_within(seconds_to_edge(spare, times))
        if factor == 1.0:
            return FREE
        return Ruling(factor, Reason("leaves_fence", {"distance_m": round(max(0.0, float(spare[0])), 2)}))


def seconds_to_edge(spare: Floats, times: Floats) -> float:
    """When `spare` [n] at `times` [n] runs out; infinite where it does not. Outside, 0 unless it grows."""
    out = np.flatnonzero((spare <= 0.0) & (spare < spare[0] - SHRINKS_BY_M))
    if len(out) == 0:
        return math.inf
    row = int(out[0])
    before, after = float(spare[row - 1]), float(spare[row])
    if before <= 0.0:
        return float(times[row - 1])
    return float(times[row - 1] + before / (before - after) * (times[row] - times[row - 1]))
