"""Feedback: how a robot that is a little off its reference is brought back while it drives."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.trajectory import Segment
from chatrobot.robots.profile import RobotProfile

POSITION_GAIN_PER_S = 2.0
HEADING_GAIN_PER_S = 4.0
CROSS_TRACK_GAIN = 6.0
"""rad/s of turn per metre aside and m/s of speed: how a base that cannot slide sideways returns to its line.
The law is Kanayama's (A Stable Tracking Control Method for an Autonomous Mobile Robot, ICRA 1990)."""

SHARE = 0.05
"""Feedback never adds more than this share of the asked speed."""

LEAST_SPEED_MPS = 0.008
LEAST_RATE_RADPS = 0.03
HEADING_HOLD_RADPS = 0.12
"""The most that holding a heading may turn a robot that drives straight."""


def feedback(profile: RobotProfile, segment: Segment, error: Pose) -> Twist:
    """The twist to add, in the robot's frame.

    Args:
        segment: what is being driven; its full twist sets how much feedback may add.
        error: the reference pose as seen from the robot.
    """
    asked = segment.motion.twist
    speed_cap = max(LEAST_SPEED_MPS, SHARE * asked.speed_mps)
    turning = abs(asked.wz_radps) > 1e-6
    rate_cap = max(LEAST_RATE_RADPS, SHARE * abs(asked.wz_radps)) if turning else HEADING_HOLD_RADPS
    vx = POSITION_GAIN_PER_S * error.x_m
    vy = POSITION_GAIN_PER_S * error.y_m if profile.can_go_sideways else 0.0
    wz = HEADING_GAIN_PER_S * error.yaw_rad
    if not profile.can_go_sideways:
        wz += CROSS_TRACK_GAIN * asked.vx_mps * error.y_m
    if not profile.can_turn_on_the_spot and asked.speed_mps == 0.0:
        wz = 0.0
    speed = math.hypot(vx, vy)
    if speed > speed_cap:
        vx, vy = vx * speed_cap / speed, vy * speed_cap / speed
    return Twist(vx, vy, max(-rate_cap, min(rate_cap, wz)))
