"""What the lidar sees, in eight numbers: the free way to the nearest thing in each direction."""

from __future__ import annotations

import math

from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

SECTORS = 8
"""Each 45 degrees wide; the first is centred on straight ahead, the next lie to the left of it, counter-clockwise."""


def sectors_m(profile: RobotProfile, scan: LaserScan | None) -> tuple[float | None, ...]:
    """Metres from the footprint's edge to the nearest return in each sector, in the robot's frame.

    None in a sector where nothing is seen; empty where there is no lidar or it has not spoken.
    """
    lidar = profile.lidar
    if lidar is None or scan is None:
        return ()
    nearest = [math.inf] * SECTORS
    for count, distance in enumerate(scan.ranges_m):
        if not scan.range_min_m <= distance <= scan.range_max_m:
            continue
        angle = scan.angle_min_rad + count * scan.angle_increment_rad + lidar.yaw_rad
        x, y = lidar.x_m + distance * math.cos(angle), lidar.y_m + distance * math.sin(angle)
        sector = round(math.atan2(y, x) / (2.0 * math.pi) * SECTORS) % SECTORS
        free_m = math.hypot(x, y) - _reach_m(profile, x, y)
        nearest[sector] = min(nearest[sector], max(0.0, free_m))
    return tuple(round(d, 2) if math.isfinite(d) else None for d in nearest)


def _reach_m(profile: RobotProfile, x_m: float, y_m: float) -> float:
    """How far the footprint reaches towards that point."""
    distance = math.hypot(x_m, y_m)
    if distance == 0.0:
        return 0.0
    return max(0.0, max((x * x_m + y * y_m) / distance for x, y in profile.footprint))
