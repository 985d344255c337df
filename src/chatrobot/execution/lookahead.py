"""How far the lidar sees free floor in a direction of travel."""

from __future__ import annotations

import math

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


def nearest_m(scan: LaserScan) -> float | None:
    """The nearest valid return, in metres from the lidar; None where there is none."""
    valid = [d for d in scan.ranges_m if scan.range_min_m <= d <= scan.range_max_m]
    return min(valid) if valid else None
