"""How far the lidar sees free floor in a direction of travel, and when it is time to brake for what it sees."""

from __future__ import annotations

import math

from chatrobot.plan.trajectory import Segment
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan


def free_ahead_m(profile: RobotProfile, scan: LaserScan, direction_rad: float) -> float:
    """Metres the footprint could go along `direction_rad` (robot's frame) before something the lidar sees.

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


def must_brake(
    profile: RobotProfile, scan: LaserScan | None, segment: Segment, t_s: float, tick_s: float
) -> bool:
    """Whether `t_s` into `segment` it is time to brake, so that its condition holds where the robot then stands.

    Braking distance: what is driven until the robot hears of it, and v²/2a. False where there is no condition, or
    no scan to see it by.
    """
    condition = segment.motion.until
    if condition is None or scan is None:
        return False
    speed_mps = segment.at(t_s)[1].speed_mps
    limits = profile.limits
    braking_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
    braking_m = speed_mps * (tick_s + limits.latency_s) + speed_mps * speed_mps / (2.0 * braking_mps2)
    full = segment.motion.twist
    direction_rad = math.atan2(full.vy_mps, full.vx_mps)
    return free_ahead_m(profile, scan, direction_rad) - braking_m <= condition.distance_m


def nearest_m(scan: LaserScan) -> float | None:
    """The nearest valid return, in metres from the lidar; None where there is none."""
    valid = [d for d in scan.ranges_m if scan.range_min_m <= d <= scan.range_max_m]
    return min(valid) if valid else None
