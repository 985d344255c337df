"""What the governor promises a robot that is in contact with something: it goes slowly, and nearer to nothing.

An account of its own, point by point in plain Python, for the fuzzer to hold the governor to.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.core.geometry import Pose, Twist
from chatrobot.governor.governor import FARTHEST
from chatrobot.governor.space_rules import AWAY_MPS, MARGIN_M, NEARER_M
from chatrobot.robots.profile import Point, RobotProfile

EPSILON = 1e-9
LATER_S = 0.1


def broken_in_contact(
    profile: RobotProfile, seen: Sequence[Sequence[float]], allowed: Twist, pose: Pose
) -> str:
    """What of it `allowed` breaks for a robot at `pose` that has `seen` these points (of `odom`); empty: nothing."""
    if not all(abs(number) <= FARTHEST for number in pose):
        return ""
    points = [Pose(x, y) for x, y in seen]
    before = [_clearance_m(profile.footprint, point.relative_to(pose)) for point in points]
    reach_m = profile.footprint_radius_m + MARGIN_M - EPSILON
    near = [clear_m for clear_m, point in zip(before, points) if pose.distance_to(point) <= reach_m]
    nearest_m = min(near, default=math.inf)
    if nearest_m > MARGIN_M - EPSILON:
        return ""
    if allowed.speed_mps + abs(allowed.wz_radps) * profile.footprint_radius_m > AWAY_MPS + EPSILON:
        return f"{allowed} though something is {nearest_m} m beside it"
    moved = pose.moved(allowed, LATER_S)
    for clear_m, point in zip(before, points):
        if (
            _clearance_m(profile.footprint, point.relative_to(moved))
            < min(clear_m, nearest_m) - 2.0 * NEARER_M
        ):
            return f"{allowed} comes nearer to what is {nearest_m} m beside it"
    return ""


def _clearance_m(corners: tuple[Point, ...], at: Pose) -> float:
    """Of a point in the robot's frame from its footprint, by its sides; negative inside."""
    return max(
        ((by - ay) * (at.x_m - ax) - (bx - ax) * (at.y_m - ay)) / math.hypot(bx - ax, by - ay)
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1])
    )
