"""Corrects what feedback left at the end of a motion, by a small motion of its own where it is worth it."""

from __future__ import annotations

import math
from typing import NamedTuple

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.core_motion import RampedTwist
from chatrobot.robots.profile import RobotProfile

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
BETWEEN_STEPS = Tolerance(0.04, math.radians(2.5))
"""Feedback does the work there; only what is this big is driven first."""


def correction(profile: RobotProfile, rest: Pose, tolerance: Tolerance) -> RampedTwist | None:
    """The motion that takes the robot to its reference; None where it is near enough.

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
