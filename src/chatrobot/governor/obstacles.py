"""The obstacle rule: never faster than the robot can brake before what its lidar sees.

The twist is scaled by one factor f so that latency and braking fit into the free way s (both in seconds of the full
twist): f * latency + f^2 / (2 k) <= s, where k is the share of the twist that one second of braking takes away.
Solved for f: f = -k L + sqrt((k L)^2 + 2 k s). Source: uniform deceleration, v^2 = 2 a d, with a dead time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.contact import Footprint, seconds_to_contact
from chatrobot.governor.seen import Seen
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

MARGIN_M = 0.03
RELEASE_M = 0.03
"""A barred way must show this much more room than the margin before it counts as free again: lidars are noisy."""

TICK_S = 0.02
LOOK_BEYOND_S = 0.3
CREEP_MPS = 0.01
CREEP_RADPS = 0.02
"""Slower than this is standing: a robot does not crawl into a wall."""


@dataclass(frozen=True)
class Ruling:
    """What a rule makes of a request: the twist may be sent times `factor`."""

    factor: float
    reason: Reason | None = None


FREE = Ruling(1.0)


class ObstacleRule:
    """Scales a twist by what the lidar sees in its way. Knows nothing where the robot has no lidar."""

    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile
        self._footprint = Footprint(profile.footprint)
        self.seen = Seen(profile.lidar) if profile.lidar is not None else None
        self._barred = False

    def take(self, scan: LaserScan, pose: Pose) -> None:
        """A scan made at `pose` (of `odom`)."""
        if self.seen is not None:
            self.seen.take(scan, pose)

    def judge(self, asked: Twist, pose: Pose) -> Ruling:
        """How much of `asked` is safe for a robot at `pose`."""
        if self.seen is None or asked.is_zero:
            return FREE
        points = self.seen.points
        if len(points) == 0:
            return FREE
        braking_per_s = self._braking_per_s(asked)
        latency_s = self._profile.limits.latency_s + TICK_S
        horizon_s = latency_s + 0.5 / braking_per_s + LOOK_BEYOND_S
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        away = points - np.array([pose.x_m, pose.y_m])
        local = away @ np.array([[cos, -sin], [sin, cos]])
        margin_m = MARGIN_M + RELEASE_M if self._barred else MARGIN_M
        free_s = seconds_to_contact(self._footprint, local, asked, horizon_s, margin_m)
        if math.isinf(free_s):
            self._barred = False
            return FREE
        lag = braking_per_s * latency_s
        factor = -lag + math.sqrt(lag * lag + 2.0 * braking_per_s * free_s)
        if factor >= 1.0:
            self._barred = False
            return FREE
        if asked.speed_mps * factor < CREEP_MPS and abs(asked.wz_radps) * factor < CREEP_RADPS:
            factor = 0.0
        self._barred = factor == 0.0
        return Ruling(factor, Reason("obstacle_ahead", {"distance_m": round(free_s * asked.speed_mps, 2)}))

    def _braking_per_s(self, twist: Twist) -> float:
        limits = self._profile.limits
        linear_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
        rates = [linear_mps2 / twist.speed_mps] if twist.speed_mps > 0.0 else []
        if twist.wz_radps != 0.0:
            rates.append(limits.angular_acceleration_radps2 / abs(twist.wz_radps))
        return min(rates)
