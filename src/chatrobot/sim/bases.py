"""The wheels of a base, and what they make of its last command: kinematics, top speed and acceleration.

The base holds its last command until it gets another one. Velocities change linearly in time, as motor
controllers with a current limit do, and a step is cut exactly where a ramp ends, so the result hardly depends
on its length.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.robots.profile import RobotProfile

HARDWARE_MARGIN = 1.5
"""Dimensionless. The hardware can do more than the governor lets through; else nobody would need a governor."""


class Base:
    """The wheels of one robot. `wheel_twist` is what they do now: the robot's velocity without slip."""

    def __init__(self, profile: RobotProfile) -> None:
        limits = profile.limits
        self._kinematics = profile.kinematics
        self._turning_radius_m = limits.min_turning_radius_m
        self._top_speed_mps = HARDWARE_MARGIN * limits.max_speed_mps
        self._top_rate_radps = HARDWARE_MARGIN * limits.max_rate_radps
        # At least what the profile says of braking, or every braking distance computed from it would be a lie.
        self._acceleration_mps2 = max(HARDWARE_MARGIN * limits.acceleration_mps2, limits.deceleration_mps2)
        self._angular_acceleration_radps2 = HARDWARE_MARGIN * limits.angular_acceleration_radps2
        self._target = ZERO_TWIST
        self.wheel_twist = ZERO_TWIST

    def command(self, twist: Twist) -> None:
        """Hold from now on what this kind of base can do of `twist`. NaN is ignored."""
        if twist.is_finite:
            self._target = self._feasible(twist)

    @property
    def is_standing(self) -> bool:
        """Return True where it stands and is told to."""
        return self.wheel_twist.is_zero and self._target.is_zero

    def stall(self) -> None:
        """Hold the wheels fast: they stand at once, and push on."""
        self.wheel_twist = ZERO_TWIST

    def step(self, duration_s: float) -> list[tuple[Twist, float]]:
        """Let time pass.

        Returns:
            Constant twists of the wheels and how long each lasts; together they are `duration_s`.
        """
        segments: list[tuple[Twist, float]] = []
        while duration_s > 0.0:
            if self.wheel_twist == self._target:
                segments.append((self._target, duration_s))
                break
            ramp_s, reached = self._ramp(duration_s)
            before, self.wheel_twist = self.wheel_twist, reached
            segments.append((self._rolling(_middle(before, reached)), ramp_s))
            duration_s -= ramp_s
        return segments

    def _ramp(self, duration_s: float) -> tuple[float, Twist]:
        """Go to where the first ramp, linear or angular, ends: how long that takes and what is reached."""
        now, target = self.wheel_twist, self._target
        dvx, dvy, dwz = target.vx_mps - now.vx_mps, target.vy_mps - now.vy_mps, target.wz_radps - now.wz_radps
        linear_s = math.hypot(dvx, dvy) / self._acceleration_mps2
        angular_s = abs(dwz) / self._angular_acceleration_radps2
        ramp_s = min([duration_s, *(needed_s for needed_s in (linear_s, angular_s) if needed_s > 0.0)])
        linear = ramp_s / linear_s if linear_s > ramp_s else 1.0
        angular = ramp_s / angular_s if angular_s > ramp_s else 1.0
        reached = Twist(
            now.vx_mps + linear * dvx if linear < 1.0 else target.vx_mps,
            now.vy_mps + linear * dvy if linear < 1.0 else target.vy_mps,
            now.wz_radps + angular * dwz if angular < 1.0 else target.wz_radps,
        )
        return ramp_s, self._rolling(reached)

    def _feasible(self, twist: Twist) -> Twist:
        """Return the nearest this base comes to `twist`: its wheels and its top speed."""
        vx, vy, wz = twist
        if self._kinematics != "mecanum":
            vy = 0.0
        largest = max(abs(vx), abs(vy))
        if largest > self._top_speed_mps:  # first, so that no square of it overflows
            vx, vy = vx / largest * self._top_speed_mps, vy / largest * self._top_speed_mps
        speed = math.hypot(vx, vy)
        if speed > self._top_speed_mps:
            vx, vy = vx * self._top_speed_mps / speed, vy * self._top_speed_mps / speed
        wz = max(-self._top_rate_radps, min(self._top_rate_radps, wz))
        return self._rolling(Twist(vx, vy, wz))

    def _rolling(self, twist: Twist) -> Twist:
        """Turn a steered base only as far as it rolls: at most the speed over its smallest radius."""
        if self._kinematics != "ackermann":
            return twist
        top = abs(twist.vx_mps) / max(self._turning_radius_m, 1e-3)
        return twist._replace(wz_radps=max(-top, min(top, twist.wz_radps)))


def _middle(a: Twist, b: Twist) -> Twist:
    return Twist(0.5 * (a.vx_mps + b.vx_mps), 0.5 * (a.vy_mps + b.vy_mps), 0.5 * (a.wz_radps + b.wz_radps))
