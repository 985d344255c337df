"""No motion without the sensors that the profile requires."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.robots.profile import RobotProfile

SILENT_S = 0.3
"""Odometry and gyros speak at 20 Hz at least."""

SCAN_SILENT_S = 0.5
SCANS_MISSED = 4.0


def silent_after_s(profile: RobotProfile, sensor: str) -> float:
    """Without a word for longer than this, a sensor counts as silent."""
    if sensor == "scan" and profile.lidar is not None:
        return max(SCAN_SILENT_S, SCANS_MISSED / profile.lidar.rate_hz)
    return SILENT_S


class SensorRule:
    """Refuses while a required sensor is silent, or never spoke."""

    name = "sensors"

    def __init__(self, profile: RobotProfile) -> None:
        self._due_s = {sensor: silent_after_s(profile, sensor) for sensor in profile.safety.requires}

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        if asked.is_zero:
            return FREE
        for sensor, due_s in self._due_s.items():
            if not situation.sensed.ages_s.get(sensor, math.inf) <= due_s:
                return Ruling(0.0, Reason("sensor_silent", {"sensor": sensor}))
        return FREE
