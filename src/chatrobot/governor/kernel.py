"""The arithmetic of the governor: one pure function from what was asked to what may be sent.

Rehearsal, executor and real time all run this very function. It keeps the direction of what was asked: a twist
beyond a limit is scaled as a whole, and a change beyond the acceleration limits is made as far as they allow along
the straight line between the two twists, so that linear and angular ramps stay synchronised.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.robots.profile import RobotProfile

Kernel = Callable[[Twist, Twist, float], Twist]
"""(what was sent last, what is asked now, seconds since) -> what may be sent now."""


def bounded(profile: RobotProfile, asked: Twist) -> Twist:
    """`asked` within the speed limits, each and combined, and the kinematics of the robot, accelerations aside.

    All of them bound convex sets of twists, so what lies between two bounded twists is bounded. A differential base
    loses its sideways part. An Ackermann base keeps its speed and turns no tighter than its minimum turning radius,
    so it never gets a spin. The rest is one common factor.
    """
    if not asked.is_finite:
        return ZERO_TWIST
    limits = profile.limits
    vx, vy, wz = asked
    if not profile.can_go_sideways:
        vy = 0.0
    if profile.kinematics == "ackermann":
        widest = abs(vx) / limits.min_turning_radius_m
        wz = max(-widest, min(widest, wz))
    factor = 1.0
    speed = math.hypot(vx, vy)
    if speed > limits.max_speed_mps:
        factor = limits.max_speed_mps / speed
    if abs(vy) * factor > limits.max_sideways_mps:
        factor = limits.max_sideways_mps / abs(vy)
    if abs(wz) * factor > limits.max_rate_radps:
        factor = limits.max_rate_radps / abs(wz)
    wheel_mps = limits.wheel_speed_mps(vx, vy, wz)
    if wheel_mps * factor > limits.max_wheel_speed_mps:
        factor = limits.max_wheel_speed_mps / wheel_mps
    return Twist(vx * factor, vy * factor, wz * factor)


def make_kernel(profile: RobotProfile) -> Kernel:
    """The kernel for one robot. Zero is exempt from the acceleration limits: asking for it yields it at once."""
    gaining_mps2 = profile.limits.acceleration_mps2
    braking_mps2 = min(gaining_mps2, profile.limits.deceleration_mps2)
    angular_radps2 = profile.limits.angular_acceleration_radps2
    ackermann = profile.kinematics == "ackermann"

    def kernel(previous: Twist, asked: Twist, dt_s: float) -> Twist:
        target = bounded(profile, asked)
        if target.is_zero:
            return ZERO_TWIST
        if ackermann and previous.vx_mps * target.vx_mps < 0.0:
            # The twists an Ackermann base can do are a double cone; its tip is the only way between the halves.
            target = ZERO_TWIST
        dvx = target.vx_mps - previous.vx_mps
        dvy = target.vy_mps - previous.vy_mps
        dwz = target.wz_radps - previous.wz_radps
        linear, angular = math.hypot(dvx, dvy), abs(dwz)
        share = 1.0
        brakes = dvx * previous.vx_mps + dvy * previous.vy_mps < 0.0
        linear_mps2 = braking_mps2 if brakes else gaining_mps2
        if linear > linear_mps2 * dt_s:
            share = linear_mps2 * dt_s / linear
        if angular * share > angular_radps2 * dt_s:
            share = angular_radps2 * dt_s / angular
        if share >= 1.0:
            return target
        return Twist(
            previous.vx_mps + share * dvx, previous.vy_mps + share * dvy, previous.wz_radps + share * dwz
        )

    return kernel
