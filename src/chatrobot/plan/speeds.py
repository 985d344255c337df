"""Which speed a step gets: what it says if the robot can do that, else the robot's default, never above its limits.

A speed that somebody asked for in words is refused when it is beyond the limits, with the number that is possible.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.plan.context import Impossible
from chatrobot.robots.profile import Limits, RobotProfile

_SLACK = 1.0 + 1e-9  # a limit said in other units (36 km/h) must not fail by rounding
_STRAIGHT_RAD = 1e-9
_ABSURD = 1e6


def max_speed_mps(limits: Limits, direction_rad: float) -> float:
    """The largest linear speed in a direction of the robot's frame: overall and sideways limit combined."""
    ahead, sideways = abs(math.cos(direction_rad)), abs(math.sin(direction_rad))
    if sideways < _STRAIGHT_RAD:
        return limits.max_speed_mps
    by_wheels = limits.max_wheel_speed_mps / (ahead + sideways)
    return min(limits.max_speed_mps, limits.max_sideways_mps / sideways, by_wheels)


def max_arc_speed_mps(limits: Limits, radius_m: float) -> float:
    """The largest linear speed on an arc that the turning rate and the outer wheel allow."""
    share = radius_m / (radius_m + limits.wheel_reach_m) if limits.wheel_reach_m > 0.0 else 1.0
    return min(limits.max_rate_radps * radius_m, limits.max_wheel_speed_mps * share)


def choose_speed(
    profile: RobotProfile, asked_mps: float | None, direction_rad: float = 0.0
) -> float | Impossible:
    """The linear speed for a direction of travel, m/s, or `sideways_impossible` / `speed_above_limit`."""
    if not profile.can_go_sideways and abs(math.sin(direction_rad)) > _STRAIGHT_RAD:
        return Impossible(Reason("sideways_impossible", {"turn_first_rad": direction_rad}))
    most = max_speed_mps(profile.limits, direction_rad)
    if asked_mps is None:
        return min(profile.defaults.speed_mps, most)
    if asked_mps > most * _SLACK:
        return Impossible(Reason("speed_above_limit", {"asked_mps": asked_mps, "max_mps": most}))
    return min(asked_mps, most)


def choose_rate(profile: RobotProfile, asked_radps: float | None) -> float | Impossible:
    """The turning rate on the spot, rad/s, or `rate_above_limit`."""
    most = profile.limits.max_rate_radps
    if asked_radps is None:
        return min(profile.defaults.rate_radps, most)
    if asked_radps > most * _SLACK:
        return Impossible(Reason("rate_above_limit", {"asked_radps": asked_radps, "max_radps": most}))
    return min(asked_radps, most)


def choose_arc_speed(profile: RobotProfile, asked_mps: float | None, radius_m: float) -> float | Impossible:
    """The linear speed on an arc, m/s: its turning rate speed / radius has a limit too."""
    limits = profile.limits
    if radius_m * _SLACK < limits.min_turning_radius_m:
        values = {"radius_m": radius_m, "min_radius_m": limits.min_turning_radius_m}
        return Impossible(Reason("turning_radius_too_small", values))
    speed = choose_speed(profile, asked_mps)
    if isinstance(speed, Impossible):
        return speed
    most = max_arc_speed_mps(limits, radius_m)
    if asked_mps is not None and speed > most * _SLACK:
        values = {
            "asked_radps": speed / radius_m,
            "max_radps": most / radius_m,
            "asked_mps": asked_mps,
            "max_mps": most,
        }
        return Impossible(Reason("rate_above_limit", values))
    return min(speed, most)


def refuse_turn_on_the_spot(profile: RobotProfile, angle_rad: float) -> Impossible | None:
    """For a base that steers; `angle_rad` is signed, left positive."""
    if profile.can_turn_on_the_spot:
        return None
    values = {"angle_rad": angle_rad, "min_radius_m": profile.limits.min_turning_radius_m}
    return Impossible(Reason("cannot_turn_on_the_spot", values))


def scale_into_limits(limits: Limits, twist: Twist) -> Twist:
    """The largest twist of the same direction (all three components in proportion) within the speed limits."""
    largest = max(abs(value) for value in twist)
    if largest > _ABSURD:  # so that no sum of squares is infinite
        twist = twist.scaled(_ABSURD / largest)
    factor = 1.0
    for value, most in (
        (twist.speed_mps, limits.max_speed_mps),
        (abs(twist.vy_mps), limits.max_sideways_mps),
        (abs(twist.wz_radps), limits.max_rate_radps),
        (limits.wheel_speed_mps(*twist), limits.max_wheel_speed_mps),
    ):
        if value > most:
            factor = min(factor, most / value)
    return twist if factor == 1.0 else twist.scaled(factor)
