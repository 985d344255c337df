"""What must hold between the fields of a profile, so that everything downstream can rely on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NoReturn

from chatrobot.robots.profile import Lidar, Limits, Point, RobotProfile

Fail = Callable[[str, str, str], NoReturn]
"""Called with the dotted field, the problem and what is allowed; it raises."""

# Rounding in a file written by hand: a limit given with two digits still counts as equal.
_TOLERANCE = 1e-6
_MIN_CORNER_M2 = 1e-7

LONGEST_EASE_S = 0.25
"""From no acceleration to all of it, where jerk is limited."""


def check(profile: RobotProfile, fail: Fail) -> None:
    """Call `fail` about the first contradiction found in `profile`; return if there is none."""
    _check_defaults(profile, fail)
    _check_kinematics(profile, fail)
    _check_wheels(profile.limits, fail)
    _check_jerk(profile.limits, fail)
    _check_footprint(profile.footprint, fail)
    if profile.lidar is not None:
        _check_lidar(profile.lidar, fail)
    _check_safety(profile, fail)


def _check_defaults(profile: RobotProfile, fail: Fail) -> None:
    limits, defaults = profile.limits, profile.defaults
    pairs = (
        ("speed_mps", defaults.speed_mps, "max_speed_mps", limits.max_speed_mps),
        ("rate_radps", defaults.rate_radps, "max_rate_radps", limits.max_rate_radps),
    )
    for field, value, limit_field, limit in pairs:
        if value > limit:
            fail(
                f"defaults.{field}",
                f"{value:g} is more than the limit",
                f"at most limits.{limit_field}, {limit:g}",
            )


def _check_kinematics(profile: RobotProfile, fail: Fail) -> None:
    limits = profile.limits
    if not profile.can_go_sideways and limits.max_sideways_mps != 0.0:
        fail(
            "limits.max_sideways_mps.value",
            f"a base with {profile.kinematics} kinematics does not go sideways",
            '0, or kinematics = "mecanum"',
        )
    if profile.can_go_sideways and not 0.0 < limits.max_sideways_mps <= limits.max_speed_mps:
        fail(
            "limits.max_sideways_mps.value",
            f"{limits.max_sideways_mps:g} does not fit a mecanum base",
            f"above 0 and at most limits.max_speed_mps, {limits.max_speed_mps:g}",
        )
    if profile.can_turn_on_the_spot and limits.min_turning_radius_m != 0.0:
        fail(
            "limits.min_turning_radius_m.value",
            f"a base with {profile.kinematics} kinematics turns on the spot",
            '0 or no such line, or kinematics = "ackermann"',
        )
    if not profile.can_turn_on_the_spot:
        _check_steering(profile, fail)


def _check_steering(profile: RobotProfile, fail: Fail) -> None:
    limits = profile.limits
    if limits.min_turning_radius_m <= 0.0:
        fail(
            "limits.min_turning_radius_m",
            "an ackermann base cannot turn on the spot",
            "its smallest turning radius, above 0 m, with its source",
        )
    reachable = limits.max_speed_mps / limits.min_turning_radius_m
    # Otherwise a person who asked for too much would be told a number that is not possible either.
    if limits.max_rate_radps > reachable + _TOLERANCE:
        fail(
            "limits.max_rate_radps.value",
            f"{limits.max_rate_radps:g} rad/s cannot be reached by steering",
            f"at most max_speed_mps / min_turning_radius_m, {reachable:.4g} rad/s",
        )


def _check_wheels(limits: Limits, fail: Fail) -> None:
    """A person who asks for a limit must get it: each alone has to be within what the wheels can do."""
    if math.isinf(limits.max_wheel_speed_mps):
        if limits.wheel_reach_m != 0.0:
            fail(
                "limits.wheel_reach_m", "it is for max_wheel_speed_mps, which is missing", "both, or neither"
            )
        return
    if limits.wheel_reach_m == 0.0:
        fail(
            "limits.wheel_reach_m", "is missing", "half the track, for a mecanum base plus half the wheelbase"
        )
    alone = {
        "max_speed_mps": limits.wheel_speed_mps(limits.max_speed_mps, 0.0, 0.0),
        "max_sideways_mps": limits.wheel_speed_mps(0.0, limits.max_sideways_mps, 0.0),
        "max_rate_radps": limits.wheel_speed_mps(0.0, 0.0, limits.max_rate_radps),
    }
    for field, wheel_mps in alone.items():
        if wheel_mps > limits.max_wheel_speed_mps + _TOLERANCE:
            fail(
                "limits.max_wheel_speed_mps.value",
                f"limits.{field} alone makes a wheel roll at {wheel_mps:.4g} m/s",
                "a lower limit there, or faster wheels",
            )


def _check_jerk(limits: Limits, fail: Fail) -> None:
    """A ramp that takes longer to get under way than this would leave the reference behind."""
    pairs = (
        ("jerk_mps3", limits.jerk_mps3, limits.acceleration_mps2),
        ("angular_jerk_radps3", limits.angular_jerk_radps3, limits.angular_acceleration_radps2),
    )
    for field, jerk, acceleration in pairs:
        if jerk * LONGEST_EASE_S < acceleration:
            fail(
                f"limits.{field}.value",
                f"{jerk:g} takes {acceleration / jerk:.2g} s to the full acceleration",
                f"at least {acceleration / LONGEST_EASE_S:.4g}: {LONGEST_EASE_S:g} s",
            )


def _check_lidar(lidar: Lidar, fail: Fail) -> None:
    if not lidar.min_range_m < lidar.max_range_m:
        fail(
            "lidar.max_range_m",
            f"{lidar.max_range_m:g} is not beyond lidar.min_range_m, {lidar.min_range_m:g}",
            "a number above lidar.min_range_m",
        )


def _check_safety(profile: RobotProfile, fail: Fail) -> None:
    wiring, fence = profile.wiring, profile.safety.fence
    topics = {"odom": wiring.odom_topic, "scan": wiring.scan_topic, "imu": wiring.imu_topic}
    for sensor in profile.safety.requires:
        if not topics[sensor]:
            fail("safety.requires", f"the robot has no {sensor}", f"only what [wiring] names: {sensor}_topic")
    if isinstance(fence, tuple) and len(fence) < 3:
        fail("safety.fence", f"{len(fence)} corners", "at least 3 corners, or { x_m, y_m, radius_m }")
    if profile.safety.battery_low_percent is not None and not wiring.battery_topic:
        fail(
            "safety.battery_low_percent",
            "the robot tells no battery",
            "wiring.battery_topic, or no such line",
        )


def _check_footprint(points: tuple[Point, ...], fail: Fail) -> None:
    allowed = "3 to 64 corners of a convex polygon around (0, 0), counter-clockwise, each once"
    if not 3 <= len(points) <= 64:
        fail("footprint", f"{len(points)} corners", allowed)
    if _signed_area(points) < 0.0:
        fail("footprint", "the corners go clockwise: turn their order around", allowed)
    edges = [_minus(points[(i + 1) % len(points)], points[i]) for i in range(len(points))]
    turned = 0.0
    for i, edge in enumerate(edges):
        before = edges[i - 1]
        if _cross(before, edge) < _MIN_CORNER_M2:
            fail(
                "footprint",
                f"corner {i + 1}, {list(points[i])}, is straight, doubled or bent inwards",
                allowed,
            )
        turned += math.atan2(_cross(before, edge), _dot(before, edge))
    if turned > 3.0 * math.pi:
        fail("footprint", "the outline goes around more than once", allowed)
    for point, edge in zip(points, edges):
        if _cross(point, edge) <= 0.0:
            fail("footprint", "the robot's centre, (0, 0), is not inside", allowed)


def _signed_area(points: tuple[Point, ...]) -> float:
    """Square metres; positive if counter-clockwise (the shoelace formula)."""
    return 0.5 * sum(_cross(points[i - 1], points[i]) for i in range(len(points)))


def _minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1]


def _cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1]
