"""The obstacle rule: never faster than the robot can brake before what its lidar sees."""

from __future__ import annotations

import math

import numpy as np

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.braking import Braking
from chatrobot.governor.contact import Footprint, seconds_to_contact
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.governor.seen import Seen
from chatrobot.robots.profile import RobotProfile

MARGIN_M = 0.03
RELEASE_M = 0.03
"""A barred way must show this much more room than the margin before it counts as free again: lidars are noisy."""


class ObstacleRule:
    """Scales a twist by what the lidar has seen in its way, in `odom`; what it never saw is `blind`'s business."""

    name = "obstacle"

    def __init__(self, profile: RobotProfile, seen: Seen) -> None:
        self._limits = profile.limits
        self._footprint = Footprint(profile.footprint)
        self._seen = seen
        self._barred = False

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        pose, points = situation.pose, self._seen.points
        if pose is None or asked.is_zero:
            return FREE
        braking = Braking(self._limits, asked)
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        away = points - np.array([pose.x_m, pose.y_m])
        local = away @ np.array([[cos, -sin], [sin, cos]])
        margin_m = MARGIN_M + RELEASE_M if self._barred else MARGIN_M
        free_s = seconds_to_contact(self._footprint, local, asked, braking.horizon_s, margin_m)
        factor = braking.factor_within(free_s)
        self._barred = factor == 0.0
        if factor == 1.0:
            return FREE
        return Ruling(factor, Reason("obstacle_ahead", {"distance_m": round(free_s * asked.speed_mps, 2)}))
