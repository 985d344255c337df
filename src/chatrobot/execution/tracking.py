"""Corrections to a motion: feedback while it drives, braking for what the lidar sees, and the rest at its end."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.plan.trajectory import RampedTwist, Segment
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

POSITION_GAIN_PER_S = 2.0
HEADING_GAIN_PER_S = 4.0
CROSS_TRACK_GAIN_RADPM2 = 6.0
"""rad/s of turn per metre aside and m/s of speed: how a base that cannot slide sideways returns to its line.
The law is Kanayama's (A Stable Tracking Control Method for an Autonomous Mobile Robot, ICRA 1990)."""

FEEDBACK_SHARE = 0.05
"""Feedback never adds more than this share of the asked speed, dimensionless."""

LEAST_SPEED_MPS = 0.008
LEAST_RATE_RADPS = 0.03
HEADING_HOLD_RADPS = 0.12
"""The most that holding a heading may turn a robot that drives straight."""


def corrected(profile: RobotProfile, segment: Segment, twist: Twist, error: Pose) -> Twist:
    """Return the reference's `twist` with feedback, in the robot's frame.

    Near the end of a ramp feedback may bring a robot that is ahead to stand; it never drives it back.
    """
    more = feedback(profile, segment, error)
    total = Twist(twist.vx_mps + more.vx_mps, twist.vy_mps + more.vy_mps, twist.wz_radps + more.wz_radps)
    return Twist(*without_reverse(total, segment.motion.twist))


def without_reverse(motion: tuple[float, float, float], driven: Twist) -> tuple[float, float, float]:
    """Return `motion` (forward, to the left, counter-clockwise) without what goes against `driven`."""
    x, y, turn = motion
    speed = driven.speed_mps
    along = (x * driven.vx_mps + y * driven.vy_mps) / speed if speed > 0.0 else 0.0
    if along < 0.0:
        x, y = x - along * driven.vx_mps / speed, y - along * driven.vy_mps / speed
    return x, y, 0.0 if turn * driven.wz_radps < 0.0 else turn


def feedback(profile: RobotProfile, segment: Segment, error: Pose) -> Twist:
    """Return the twist to add, in the robot's frame.

    Args:
        segment: what is being driven; its full twist sets how much feedback may add.
        error: the reference pose as seen from the robot.
    """
    asked = segment.motion.twist
    speed_cap = max(LEAST_SPEED_MPS, FEEDBACK_SHARE * asked.speed_mps)
    turning = abs(asked.wz_radps) > 1e-6
    rate_cap = max(LEAST_RATE_RADPS, FEEDBACK_SHARE * abs(asked.wz_radps)) if turning else HEADING_HOLD_RADPS
    vx = POSITION_GAIN_PER_S * error.x_m
    vy = POSITION_GAIN_PER_S * error.y_m if profile.can_go_sideways else 0.0
    wz = HEADING_GAIN_PER_S * error.yaw_rad
    if not profile.can_go_sideways:
        wz += CROSS_TRACK_GAIN_RADPM2 * asked.vx_mps * error.y_m
    if not profile.can_turn_on_the_spot and asked.speed_mps == 0.0:
        wz = 0.0
    speed = math.hypot(vx, vy)
    if speed > speed_cap:
        vx, vy = vx * speed_cap / speed, vy * speed_cap / speed
    return Twist(vx, vy, max(-rate_cap, min(rate_cap, wz)))


OFF_TRACK_M = 0.10
OFF_TRACK_RAD = math.radians(15.0)
OFF_TRACK_SHARE = 0.10
SLIP_SHARE = 0.5
"""Where the heading is off and the wheels claim at least this share of what is missing, they slip."""


def tracking_fault(begin: Pose, reference: Pose, seen: Pose, wheel_turn_rad: float) -> Reason | None:
    """Return what is wrong where the robot parts too far from its reference; None where it does not.

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


LATE_BY_S = (0.15, 0.3, 0.45, 0.6)
"""How long a bad Wi-Fi may keep our velocities and the robot's news together."""

LAGS = frozenset({"does_not_move", "does_not_follow"})
"""Faults that a robot may show that does what it is told, only late; going another way is none of them."""


def unless_late(
    fault: Callable[[Pose], Reason | None], reference: Pose, earlier: Iterable[Pose]
) -> Reason | None:
    """Return the fault of the reference; None where one of the `earlier` references shows none: it is only late."""
    found = fault(reference)
    if found is None or found.code not in LAGS:
        return found
    return None if any(fault(before) is None for before in earlier) else found


def _degrees(angle_rad: float) -> float:
    return round(math.degrees(angle_rad), 1)


def free_ahead_m(profile: RobotProfile, scan: LaserScan, direction_rad: float) -> float:
    """Return how far the footprint could go along `direction_rad` (robot's frame) before something the lidar sees.

    Looks at the strip the footprint sweeps. Infinite where nothing is in it; zeros and NaN are "no return" on
    cheap lidars and are passed over.
    """
    lidar = profile.lidar
    if lidar is None:
        return math.inf
    cos, sin = math.cos(direction_rad), math.sin(direction_rad)
    along = [x * cos + y * sin for x, y in profile.footprint]
    across = [y * cos - x * sin for x, y in profile.footprint]
    front, left, right = max(along), max(across), min(across)
    nearest = math.inf
    angle = scan.angle_min_rad + lidar.yaw_rad
    for distance in scan.ranges_m:
        if scan.range_min_m <= distance <= scan.range_max_m:
            x = lidar.x_m + distance * math.cos(angle)
            y = lidar.y_m + distance * math.sin(angle)
            ahead = x * cos + y * sin
            if right <= y * cos - x * sin <= left and ahead > 0.0:
                nearest = min(nearest, ahead - front)
        angle += scan.angle_increment_rad
    return nearest


def must_brake(profile: RobotProfile, scan: LaserScan | None, segment: Segment, t_s: float) -> bool:
    """Return True where it is time to brake, `t_s` into `segment`, so that its condition holds where the robot stops.

    Braking distance: what is driven until the robot hears of it, and v²/2a. False where there is no condition, or
    no scan to see it by.
    """
    condition = segment.motion.until
    if condition is None or scan is None:
        return False
    speed_mps = segment.at(t_s)[1].speed_mps
    limits = profile.limits
    braking_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
    braking_m = speed_mps * (TICK_S + limits.latency_s) + speed_mps * speed_mps / (2.0 * braking_mps2)
    full = segment.motion.twist
    direction_rad = math.atan2(full.vy_mps, full.vx_mps)
    return free_ahead_m(profile, scan, direction_rad) - braking_m <= condition.distance_m


def nearest_m(scan: LaserScan) -> float | None:
    """Return the nearest valid range, in metres from the lidar; None where there is none."""
    valid = [d for d in scan.ranges_m if scan.range_min_m <= d <= scan.range_max_m]
    return min(valid) if valid else None


TRIES = 2
"""A robot that cannot hold still any better is left where it is."""

SPEED_MPS = 0.08
RATE_RADPS = 0.3
LEAST_S = 0.1


class Tolerance(NamedTuple):
    """A bigger rest than this is driven."""

    distance_m: float
    turn_rad: float


AT_THE_END = Tolerance(0.006, math.radians(0.4))
NOT_ARRIVED = "not_arrived"
ARRIVED = Tolerance(0.02, math.radians(1.5))
"""A plan that ends farther off than this has not been done."""
BETWEEN_STEPS = Tolerance(0.04, math.radians(2.5))
"""Feedback does the work there; only what is this big is driven first."""


def not_arrived(profile: RobotProfile, rest: Pose) -> Reason | None:
    """Return why a plan that leaves `rest`, as far as the base could drive it, has not been done; None where it has."""
    if correction(profile, rest, ARRIVED) is None:
        return None
    off_m, off_deg = math.hypot(rest.x_m, rest.y_m), abs(_degrees(rest.yaw_rad))
    return Reason(NOT_ARRIVED, {"off_m": round(off_m, 2), "off_deg": off_deg})


def correction(profile: RobotProfile, rest: Pose, tolerance: Tolerance) -> RampedTwist | None:
    """Return the motion that takes the robot to its reference; None where it is near enough.

    Args:
        rest: the reference pose as seen from the robot. What the base cannot do is left out.
    """
    x = rest.x_m
    y = rest.y_m if profile.can_go_sideways else 0.0
    yaw = rest.yaw_rad if profile.can_turn_on_the_spot else 0.0
    distance_m = math.hypot(x, y)
    if distance_m <= tolerance.distance_m and abs(yaw) <= tolerance.turn_rad:
        return None
    hold_s = max(distance_m / SPEED_MPS, abs(yaw) / RATE_RADPS, LEAST_S)
    return RampedTwist.within(profile.limits, Twist(x / hold_s, y / hold_s, yaw / hold_s), hold_s)
