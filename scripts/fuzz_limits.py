"""What the governor promises of speed and acceleration: an account of what was sent, for the fuzzer to hold it to."""

from __future__ import annotations

import math

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Twist
from chatrobot.governor.governor import LONGEST_STEP_S
from chatrobot.robots.profile import RobotProfile

EPSILON = 1e-9


class BrokenPromiseError(AssertionError):
    """A promise of the governor does not hold."""


class Sent:
    """What was sent last, how fast that gained, and the narrowest limits until now."""

    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile
        self._sent = Twist()
        self._at_s = -math.inf
        self._gaining = (0.0, 0.0)
        self._most_mps = math.inf
        self._most_radps = math.inf

    def stop(self) -> None:
        """The robot's way is zero now, whatever was sent."""
        self._sent = Twist()

    def narrow(self, most_mps: float, most_radps: float) -> None:
        """No more than this from now on."""
        self._most_mps = min(self._most_mps, most_mps)
        self._most_radps = min(self._most_radps, most_radps)

    def note(self, sent: Twist, now_s: float) -> None:
        """It goes out. The next step goes on from the acceleration of the change, for what turns about slows first."""
        step_s = TICK_S if self._sent.is_zero else min(now_s - self._at_s, LONGEST_STEP_S)
        if sent.is_zero:
            self._gaining = (0.0, 0.0)
        elif step_s > 0.0:
            change = math.hypot(sent.vx_mps - self._sent.vx_mps, sent.vy_mps - self._sent.vy_mps)
            self._gaining = (change / step_s, abs(sent.wz_radps - self._sent.wz_radps) / step_s)
        self._sent, self._at_s = sent, now_s

    def check(self, sent: Twist, now_s: float) -> None:
        """Hold `sent`, which is not zero, to all that is promised.

        Raises:
            BrokenPromiseError: it may not go out now.
        """
        self._check_speed(sent)
        elapsed_s = now_s - self._at_s
        if elapsed_s < 0.0:
            raise BrokenPromiseError("motion though the clock went back")
        step_s = LONGEST_STEP_S if self._sent.is_zero else min(elapsed_s, LONGEST_STEP_S)
        limits = self._profile.limits
        change = math.hypot(sent.vx_mps - self._sent.vx_mps, sent.vy_mps - self._sent.vy_mps)
        if change > limits.acceleration_mps2 * step_s + EPSILON:
            raise BrokenPromiseError(f"{change} m/s in {step_s} s")
        along = sent.vx_mps * self._sent.vx_mps + sent.vy_mps * self._sent.vy_mps
        if along < self._sent.speed_mps**2 - EPSILON:
            brakes = min(limits.acceleration_mps2, limits.deceleration_mps2)
            if change > brakes * step_s + EPSILON:
                raise BrokenPromiseError(f"brakes by {change} m/s in {step_s} s")
        if abs(sent.wz_radps - self._sent.wz_radps) > limits.angular_acceleration_radps2 * step_s + EPSILON:
            raise BrokenPromiseError(f"{sent.wz_radps - self._sent.wz_radps} rad/s in {step_s} s")
        self._check_jerk(sent, step_s)

    def _check_jerk(self, sent: Twist, step_s: float) -> None:
        """What only gains, gains no more than the last gain and a step's jerk on top. `gain` is in m/s and rad/s."""
        before, limits = self._sent, self._profile.limits
        gained = sent.speed_mps - before.speed_mps
        turned = abs(sent.wz_radps) - abs(before.wz_radps)
        if gained < 0.0 or turned < 0.0 or not step_s:
            return
        last_mps2, last_radps2 = self._gaining
        if gained > (last_mps2 + limits.jerk_mps3 * step_s) * step_s + EPSILON:
            raise BrokenPromiseError(f"from {last_mps2} to {gained / step_s} m/s² in {step_s} s")
        if turned > (last_radps2 + limits.angular_jerk_radps3 * step_s) * step_s + EPSILON:
            raise BrokenPromiseError(f"from {last_radps2} to {turned / step_s} rad/s² in {step_s} s")

    def _check_speed(self, sent: Twist) -> None:
        limits, profile = self._profile.limits, self._profile
        speed, rate = math.hypot(sent.vx_mps, sent.vy_mps), abs(sent.wz_radps)
        if speed > limits.max_speed_mps + EPSILON or abs(sent.vy_mps) > limits.max_sideways_mps + EPSILON:
            raise BrokenPromiseError(f"{sent} is above the profile's speed")
        if rate > limits.max_rate_radps + EPSILON:
            raise BrokenPromiseError(f"{sent} is above the profile's rate")
        if not profile.can_go_sideways and sent.vy_mps != 0.0:
            raise BrokenPromiseError("sideways on a base that cannot")
        if limits.wheel_speed_mps(*sent) > limits.max_wheel_speed_mps + EPSILON:
            raise BrokenPromiseError("a wheel rolls faster than it may")
        if rate * limits.min_turning_radius_m > abs(sent.vx_mps) + EPSILON:
            raise BrokenPromiseError("a tighter curve than the base can do")
        if speed > max(self._most_mps, self._sent.speed_mps) + EPSILON:
            raise BrokenPromiseError("faster than the limit that was narrowed")
        if rate > max(self._most_radps, abs(self._sent.wz_radps)) + EPSILON:
            raise BrokenPromiseError("turns faster than the limit that was narrowed")
