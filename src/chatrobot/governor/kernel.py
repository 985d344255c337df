"""The arithmetic of the governor: one pure function from what was asked to what may be sent.

Rehearsal, executor and real time all run this very function. It keeps the direction of what was asked: a twist
beyond a limit is scaled as a whole, and a change beyond the acceleration limits is made as far as they allow along
the straight line between the two twists, so that linear and angular ramps stay synchronised.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.robots.profile import Limits, RobotProfile

Kernel = Callable[[Twist, Twist, float], Twist]
"""(what was sent last, what is asked now, seconds since) -> what may be sent now."""


def bounded(profile: RobotProfile, asked: Twist) -> Twist:
    """Return `asked` within the speed limits, each and combined, and the kinematics of the robot, accelerations aside.

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
    """Return the kernel for one robot. Zero is exempt from the acceleration limits: asking for it yields it at once."""
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


class JerkLimit:
    """Limits jerk: how fast an acceleration, m/s² and rad/s², may grow from one step to the next.

    It binds what gains speed; zero and a rule's braking it never touches. A limit that delayed braking would lengthen
    every way to a stop, which the rules count on. So what gains speed eases into its acceleration and out of it again
    before the speed that was asked for, along the straight line that the kernel goes.
    """

    def __init__(self, limits: Limits) -> None:
        self._linear_mps3 = limits.jerk_mps3
        self._angular_radps3 = limits.angular_jerk_radps3
        self._acceleration = ZERO_TWIST

    def eased(self, previous: Twist, wanted: Twist, target: Twist, dt_s: float, *, urgent: bool) -> Twist:
        """Return what may be sent of the step from `previous` to `wanted` on the way to `target`.

        A step that gains and slows at once (into a curve, say) is eased as a whole, so that its direction is kept;
        where a rule brakes (`urgent`) such a step is not eased at all.
        """
        gains = wanted.speed_mps > previous.speed_mps
        turns_in = abs(wanted.wz_radps) > abs(previous.wz_radps)
        slows = wanted.speed_mps < previous.speed_mps or abs(wanted.wz_radps) < abs(previous.wz_radps)
        if dt_s <= 0.0 or (urgent and slows):
            return wanted
        step = Twist(*_between(previous, wanted))
        share = 1.0
        if gains and not math.isinf(self._linear_mps3):
            along = self._acceleration.vx_mps * step.vx_mps + self._acceleration.vy_mps * step.vy_mps
            left = Twist(*_between(previous, target)).speed_mps
            most = _most(along / step.speed_mps, left, self._linear_mps3, dt_s)
            share = min(share, most / step.speed_mps)
        if turns_in and not math.isinf(self._angular_radps3):
            along = self._acceleration.wz_radps * math.copysign(1.0, step.wz_radps)
            left = abs(target.wz_radps - previous.wz_radps)
            share = min(share, _most(along, left, self._angular_radps3, dt_s) / abs(step.wz_radps))
        if share >= 1.0:
            return wanted
        part = step.scaled(share)
        return Twist(
            previous.vx_mps + part.vx_mps, previous.vy_mps + part.vy_mps, previous.wz_radps + part.wz_radps
        )

    def note(self, previous: Twist, sent: Twist, dt_s: float) -> None:
        """Take what was sent in the end: the acceleration that the next step goes on from."""
        if dt_s > 0.0:
            self._acceleration = Twist(*_between(previous, sent)).scaled(1.0 / dt_s)

    def rest(self) -> None:
        """Begin the next acceleration at none: the robot stands."""
        self._acceleration = ZERO_TWIST


def _between(previous: Twist, wanted: Twist) -> tuple[float, float, float]:
    return (
        wanted.vx_mps - previous.vx_mps,
        wanted.vy_mps - previous.vy_mps,
        wanted.wz_radps - previous.wz_radps,
    )


def _most(acceleration: float, left: float, jerk: float, dt_s: float) -> float:
    """Return the most that one step may add: more acceleration by the jerk, but only what can be eased out again.

    All in metres or all in radians. Out again over `left`: a^2 / (2 j) + a dt / 2 <= left, solved for a.
    """
    half = 0.5 * jerk * dt_s
    return min(max(0.0, acceleration) + jerk * dt_s, math.sqrt(half * half + 2.0 * jerk * left) - half) * dt_s


LOOK_BEYOND_S = 0.3
"""Looks so much farther than it takes to brake, so that slowing down begins softly."""

CREEP_MPS = 0.01
CREEP_RADPS = 0.02
"""Slower than this is standing: a robot does not crawl into a wall."""

_MOST_PER_S = 1e6
"""A twist of next to nothing is braked at once; a bound keeps the arithmetic finite."""


class Braking:
    """Says how fast a robot may be that must be able to brake within the free way, from one twist (not zero).

    The twist is scaled by one factor f so that latency and braking fit into the free way s (both in seconds of the
    full twist): f * latency + f^2 / (2 k) <= s, where k is the share of the twist that one second of braking takes
    away. Solved for f: f = -k L + sqrt((k L)^2 + 2 k s). Source: uniform deceleration, v^2 = 2 a d, with a dead time.
    """

    def __init__(self, limits: Limits, twist: Twist) -> None:
        linear_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
        slowest = _MOST_PER_S
        if twist.speed_mps > 0.0:
            slowest = min(slowest, linear_mps2 / twist.speed_mps)
        if twist.wz_radps != 0.0:
            slowest = min(slowest, limits.angular_acceleration_radps2 / abs(twist.wz_radps))
        self._twist = twist
        self._per_s = slowest
        self._latency_s = limits.latency_s + TICK_S

    @property
    def horizon_s(self) -> float:
        """Return how far ahead to look, in seconds of the twist."""
        return self._latency_s + 0.5 / self._per_s + LOOK_BEYOND_S

    def factor_within(self, free_s: float) -> float:
        """Return the share of the twist, 0 to 1, from which the robot can brake within `free_s` seconds of the twist.

        Infinite seconds are all the way there is.
        """
        lag = self._per_s * self._latency_s
        factor = -lag + math.sqrt(lag * lag + 2.0 * self._per_s * free_s)
        if factor >= 1.0:
            return 1.0
        creeps = (
            self._twist.speed_mps * factor < CREEP_MPS and abs(self._twist.wz_radps) * factor < CREEP_RADPS
        )
        return 0.0 if creeps else factor
