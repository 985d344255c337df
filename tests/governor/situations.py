"""Profiles and situations that the tests of single rules share."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.governor.rule import Sensed, Situation
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile, Safety

MECANUM = load_profile("wheeltec_mini_mec")
"""0.27 m long, 0.222 m wide, up to 1 m/s and 2 rad/s, brakes with 1 m/s² (its ramp), 0.05 s late."""


def with_safety(safety: Safety, profile: RobotProfile = MECANUM) -> RobotProfile:
    return replace(profile, safety=safety)


def at(pose: Pose | None = ORIGIN, **ages_s: float) -> Situation:
    return Situation(pose, Sensed(ages_s))


def battery(percent: float | None, begins: bool = False) -> Situation:
    return Situation(ORIGIN, Sensed(battery_percent=percent), begins)


JERK_MPS3 = 5.0
ANGULAR_JERK_RADPS3 = 12.0


def smooth(profile: RobotProfile = MECANUM) -> RobotProfile:
    """The same robot with limited jerk."""
    limits = replace(profile.limits, jerk_mps3=JERK_MPS3, angular_jerk_radps3=ANGULAR_JERK_RADPS3)
    return replace(profile, limits=limits)
