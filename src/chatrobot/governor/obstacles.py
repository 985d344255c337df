"""The obstacle rule: never faster than the robot can brake before what its lidar sees."""

from __future__ import annotations

import math

import numpy as np

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.braking import Braking
from chatrobot.governor.contact import Floats, Footprint, comes_nearer, seconds_to_contact
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.robots.profile import RobotProfile

MARGIN_M = 0.03
RELEASE_M = 0.03
"""A barred way must show this much more room than the margin before it counts as free again: lidars are noisy."""

AWAY_MPS = 0.05
"""A robot that is within the margin of something goes no faster than this, no corner of it."""

NEARER_M = 0.0002
"""And nothing comes nearer than the nearest thing is, but for this much on the way that it takes to brake."""


class ObstacleRule:
    """Scales a twist by what the lidar has seen in its way, in `odom`; what it never saw is `blind`'s business.

    A robot that is in contact, within the margin of something, may move away from it, slowly.
    """

    name = "obstacle"

    def __init__(self, profile: RobotProfile, seen: ObstacleMemory) -> None:
        self._limits = profile.limits
        self._footprint = Footprint(profile.footprint)
        self._obstacle_memory = seen
        self._barred = False

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        if situation.begins:
            self._barred = False  # another motion: the way that was barred need not be its way
        pose, points = situation.pose, self._obstacle_memory.points
        if pose is None or asked.is_zero:
            return FREE
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        away = points - np.array([pose.x_m, pose.y_m])
        local = away @ np.array([[cos, -sin], [sin, cos]])
        nearest_m = self._footprint.nearest_m(local, MARGIN_M)
        if nearest_m <= MARGIN_M:
            return self._away(asked, local, nearest_m)
        braking = Braking(self._limits, asked)
        margin_m = MARGIN_M + RELEASE_M if self._barred else MARGIN_M
        free_s = seconds_to_contact(self._footprint, local, asked, braking.horizon_s, margin_m)
        factor = braking.factor_within(free_s)
        self._barred = factor == 0.0
        if factor == 1.0:
            return FREE
        return Ruling(factor, Reason("obstacle_ahead", {"distance_m": round(free_s * asked.speed_mps, 2)}))

    def _away(self, asked: Twist, local: Floats, nearest_m: float) -> Ruling:
        """In contact: slowly, where the distance to what was seen does not shrink; else not at all.

        A wall is many points: along it those ahead come nearer, but no nearer than those beside the robot are.
        """
        fastest_mps = asked.speed_mps + abs(asked.wz_radps) * self._footprint.radius_m
        share = AWAY_MPS / fastest_mps if fastest_mps > AWAY_MPS else 1.0
        slow = asked.scaled(share)
        horizon_s = Braking(self._limits, slow).horizon_s
        self._barred = comes_nearer(self._footprint, local, slow, horizon_s, nearest_m, NEARER_M)
        if self._barred:
            return Ruling(0.0, Reason("obstacle_ahead", {"distance_m": 0.0}))
        if share == 1.0:
            return FREE
        return Ruling(share, Reason("in_contact", {"distance_m": round(nearest_m, 2), "speed_mps": AWAY_MPS}))
