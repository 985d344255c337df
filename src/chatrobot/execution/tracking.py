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


def corrected(profile: RobotProfile, segment: Segment, twist: Twist, error: Pose) -> Twist:
    """The reference's `twist` with feedback, in the robot's frame. Near the end of a ramp, where the reference hardly
    moves any more, feedback may bring a robot that is ahead to stand; it never drives it back."""
    more = feedback(profile, segment, error)
    total = Twist(twist.vx_mps + more.vx_mps, twist.vy_mps + more.vy_mps, twist.wz_radps + more.wz_radps)
    return Twist(*without_reverse(total, segment.motion.twist))


def without_reverse(motion: tuple[float, float, float], driven: Twist) -> tuple[float, float, float]:
    """`motion` (forward, to the left, counter-clockwise) without what goes against `driven`."""
    x, y, turn = motion
    speed = driven.speed_mps
    along = (x * driven.vx_mps + y * driven.vy_mps) / speed if speed > 0.0 else 0.0
    if along < 0.0:
        x, y = x - along * driven.vx_mps / speed, y - along * driven.vy_mps / speed
    return x, y, 0.0 if turn * driven.wz_radps < 0.0 else turn


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
