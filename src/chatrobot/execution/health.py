"""Does the robot do what it is told? What it does instead is said, never papered over."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import Sensors

ODOMETRY_LATE_S = 0.13
"""Odometry comes ten times a second at least: with news older than this the robot goes slower."""
ODOMETRY_SILENT_S = 0.2
"""With news as old as this it is told to stand: it then does within 250 ms."""
ODOMETRY_LOST_S = 0.45
"""A packet that a bad Wi-Fi lost is there again after a quarter of a second: it stands and waits for no longer."""
MOVING_MPS, MOVING_RADPS = 0.03, 0.1
"""Above these it clearly moves; noise of a standing robot is below."""
FRESH_S = 0.3
"""Odometry older than this shows nothing."""
SAME_MOMENT_S = 0.001
"""Stamps closer than this are of one moment: sums of clock ticks differ by rounding."""
STANDS_LATE_S = 2.0
"""A robot that is told to stand and clearly moves after this long does not obey."""
OFF_TRACK_M = 0.10
OFF_TRACK_RAD = math.radians(15.0)
OFF_TRACK_SHARE = 0.10
SLIP_SHARE = 0.5
"""Where the heading is off and the wheels claim at least this share of what is missing, they slip."""


def sensor_fault(sensors: Sensors) -> Reason | None:
    """Odometry that is silent or says what cannot be."""
    if not sensors.has_odometry:
        return None
    age_s = sensors.odometry_age_s()
    if age_s > ODOMETRY_LOST_S:
        return silence(sensors)
    fault, sensors.estimator.fault = sensors.estimator.fault, None
    return fault


def silence(sensors: Sensors) -> Reason:
    """How long odometry has been silent."""
    return Reason("odometry_silent", {"age_s": round(min(sensors.odometry_age_s(), 999.0), 2)})


def freshness(sensors: Sensors) -> float:
    """What share of its speed a robot may go with odometry as old as it is now: 1, less where it is late, 0 where
    it is silent."""
    if not sensors.has_odometry:
        return 1.0
    left_s = ODOMETRY_SILENT_S - sensors.odometry_age_s()
    return max(0.0, min(1.0, left_s / (ODOMETRY_SILENT_S - ODOMETRY_LATE_S)))


def is_seen_moving(sensors: Sensors) -> bool:
    """Odometry shows clearly, and just now, that it moves."""
    estimate = sensors.estimate
    if estimate is None or sensors.odometry_age_s() >= FRESH_S:
        return False
    return estimate.twist.speed_mps > MOVING_MPS or abs(estimate.twist.wz_radps) > MOVING_RADPS


def is_seen_standing(sensors: Sensors, since_s: float = -math.inf) -> bool:
    """It is told to stand, and odometry of after that (and after `since_s`) shows, just now, that it does."""
    estimate = sensors.estimate
    if estimate is None or not estimate.is_standing or sensors.odometry_age_s() >= FRESH_S:
        return False
    return estimate.stamp_s - max(since_s, sensors.estimator.rest.told_since_s) > SAME_MOMENT_S


def tracking_fault(begin: Pose, reference: Pose, seen: Pose, wheel_turn_rad: float) -> Reason | None:
    """What is wrong where the robot parts too far from its reference.

    Args:
        begin: pose at the start of the motion.
        reference: where it should be now.
        seen: where odometry and gyro say it is.
        wheel_turn_rad: how much the wheels say it turned since `begin`.
    """
    asked_m, seen_m = begin.distance_to(reference), begin.distance_to(seen)
    asked_rad, seen_rad = reference.yaw_rad - begin.yaw_rad, seen.yaw_rad - begin.yaw_rad
    off_m = reference.distance_to(seen)
    off_rad = abs(asked_rad - seen_rad)
    if off_m <= OFF_TRACK_M + OFF_TRACK_SHARE * asked_m and off_rad <= OFF_TRACK_RAD + OFF_TRACK_SHARE * abs(
        asked_rad
    ):
        return None
    if off_rad > OFF_TRACK_RAD and abs(wheel_turn_rad - seen_rad) > SLIP_SHARE * off_rad:
        return Reason("wheels_slip", {"wheels_deg": _degrees(wheel_turn_rad), "gyro_deg": _degrees(seen_rad)})
    values = {
        "asked_m": round(asked_m, 2),
        "seen_m": round(seen_m, 2),
        "asked_deg": _degrees(asked_rad),
        "seen_deg": _degrees(seen_rad),
    }
    if seen_m < 0.1 * asked_m + 0.01 and abs(seen_rad) < 0.1 * abs(asked_rad) + 0.02:
        return Reason("does_not_move", values)
    ahead = (reference.x_m - begin.x_m) * (seen.x_m - begin.x_m) + (reference.y_m - begin.y_m) * (
        seen.y_m - begin.y_m
    )
    if ahead < -0.002 or asked_rad * seen_rad < -0.01:
        return Reason("moves_the_other_way", values)
    return Reason("does_not_follow", values)


def _degrees(angle_rad: float) -> float:
    return round(math.degrees(angle_rad), 1)
