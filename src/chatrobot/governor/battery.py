"""A battery that runs low: no new motion begins, and what is under way goes on slowly."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.robots.profile import RobotProfile

SLOW_SHARE = 0.5
"""Of the speed and rate limits: enough to come home, and less current."""


class BatteryRule:
    """Where the robot tells its battery and the profile says what is low."""

    name = "battery"

    def __init__(self, profile: RobotProfile, low_percent: float) -> None:
        self._low_percent = low_percent
        self._speed_mps = SLOW_SHARE * profile.limits.max_speed_mps
        self._rate_radps = SLOW_SHARE * profile.limits.max_rate_radps

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        percent = situation.sensed.battery_percent
        if percent is None or math.isnan(percent) or percent >= self._low_percent:
            return FREE
        reason = Reason("battery_low", {"percent": round(percent, 1), "low_percent": self._low_percent})
        if situation.begins:
            return Ruling(0.0, reason)
        factor = at_most(asked, self._speed_mps, self._rate_radps)
        return Ruling(factor, reason, urgent=False) if factor < 1.0 else FREE


def at_most(asked: Twist, speed_mps: float, rate_radps: float) -> float:
    """The share of `asked` that keeps to a speed and a rate."""
    factor = 1.0
    if asked.speed_mps > speed_mps:
        factor = speed_mps / asked.speed_mps
    if abs(asked.wz_radps) * factor > rate_radps:
        factor = rate_radps / abs(asked.wz_radps)
    return factor
