"""The robots that the fuzzer drives."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.robots.load import list_profiles
from chatrobot.robots.profile import Circle, RobotProfile, Safety


def profiles() -> list[RobotProfile]:
    """All there are, and each with every rule that a profile can switch on."""
    plain = [entry.load() for entry in list_profiles()]
    return [*plain, *map(with_everything, plain)]


def with_everything(profile: RobotProfile) -> RobotProfile:
    """The same robot with every rule and every limit that a profile can switch on."""
    limits = profile.limits
    reach_m = limits.max_speed_mps / limits.max_rate_radps
    return replace(
        profile,
        safety=Safety(Circle(0.0, 0.0, 3.0), ("odom", "imu"), 0.05, 60.0),
        limits=replace(
            limits,
            max_wheel_speed_mps=1.1 * limits.max_speed_mps,
            wheel_reach_m=reach_m,
            jerk_mps3=4.0 * limits.acceleration_mps2,
            angular_jerk_radps3=5.0 * limits.angular_acceleration_radps2,
        ),
    )
