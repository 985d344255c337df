"""The tiny core that every primitive lowers to, and the one trajectory generator for it.

A motion is a constant twist scaled by one progress variable s(t), in seconds of that twist. Its rate ds/dt rises
from 0 to 1 with slope k, stays, and falls again, so that s ends at exactly `hold_s`: the path is twist * hold_s, and
linear and angular velocity keep their ratio (the curvature) at every moment. Source of the trapezoid with equal
area: Lynch and Park, Modern Robotics (2017), section 9.2.2.2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Union

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.plan.base import Condition
from chatrobot.robots.profile import Limits

NEAR_LIMIT = 0.7
RAMP_SHARE = 0.9
"""Dimensionless. Beyond `NEAR_LIMIT` of the top speed feedback has little room above the reference; ramps then use only
this share of the accelerations, so that it can still brake more than the reference. The governor holds the sum."""


@dataclass(frozen=True)
class RampedTwist:
    """A constant twist, held for `hold_s` and ramped at both ends so that the path is exactly twist * hold_s.

    All three components share one ramp, so the curvature is the same from the first tick to the last.
    `ramp_per_s` is how much of the twist a second of ramp adds (the slope of `Ramp`). `until` ends it early.
    `asked` is what the plan said where the limits scaled it down, else None. `is_timed`: the plan said how long, not
    how far.
    """

    twist: Twist
    hold_s: float
    ramp_per_s: float
    until: Condition | None = None
    asked: Twist | None = None
    is_timed: bool = False

    @classmethod
    def within(
        cls,
        limits: Limits,
        twist: Twist,
        hold_s: float,
        *,
        until: Condition | None = None,
        asked: Twist | None = None,
        is_timed: bool = False,
    ) -> RampedTwist:
        """Make one with the steepest ramp that keeps to both accelerations of `limits`. The twist must not be zero."""
        return cls(twist, hold_s, ramp_rate(limits, twist), until, asked, is_timed)

    def end(self, start: Pose) -> Pose:
        """Return the ideal pose at the end, in the frame of `start`."""
        return start.moved(self.twist, self.hold_s)


@dataclass(frozen=True)
class Pause:
    """Stand still for a time."""

    duration_s: float

    def end(self, start: Pose) -> Pose:
        """Return `start`."""
        return start


@dataclass(frozen=True)
class Emit:
    """Something to tell that needs no motion: kind `say` or `remember`, or a third party's own."""

    kind: str
    text: str

    def end(self, start: Pose) -> Pose:
        """Return `start`."""
        return start


_STEEPEST_PER_S = 1e6  # for velocities too small to matter; keeps infinities out of the arithmetic

CoreMotion = Union[RampedTwist, Pause, Emit]


def ramp_rate(limits: Limits, twist: Twist) -> float:
    """Return the share of `twist` that one second of ramp may add, 1/s, so that neither acceleration is exceeded.

    Ramps are symmetric; where the base brakes more weakly than it accelerates, braking decides.
    """
    linear_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
    rates = []
    if twist.speed_mps > 0.0:
        rates.append(linear_mps2 / twist.speed_mps)
    if twist.wz_radps != 0.0:
        rates.append(limits.angular_acceleration_radps2 / abs(twist.wz_radps))
    if not rates:
        raise ValueError("a zero twist has no ramp: use Pause")
    fast = twist.speed_mps > NEAR_LIMIT * limits.max_speed_mps
    turns_fast = abs(twist.wz_radps) > NEAR_LIMIT * limits.max_rate_radps
    share = RAMP_SHARE if fast or turns_fast else 1.0
    return min(share * min(rates), _STEEPEST_PER_S)


STRAIGHT_RADPS = 1e-6  # below this the circle's centre is so far off that rounding beats the curvature
TIGHT_M = 0.1
"""On a smaller radius than this the heading tells better than the position how far a motion is."""


class Ramp:
    """Progress s(t) of one motion: up with slope k, level, down with slope k.

    Args:
        hold_s: how long the full twist would have to be held for the same path; s at the end.
        slope_per_s: k, the slope of ds/dt. Where hold_s < 1/k the level part vanishes and the peak stays below 1.
    """

    __slots__ = ("down_start_s", "hold_s", "peak", "slope_per_s", "total_s", "up_end_s")

    def __init__(self, hold_s: float, slope_per_s: float) -> None:
        if not (hold_s >= 0.0 and slope_per_s > 0.0):
            raise ValueError(f"a ramp needs hold_s >= 0 and slope_per_s > 0, not {hold_s} and {slope_per_s}")
        self.hold_s = hold_s
        self.slope_per_s = slope_per_s
        self.peak = min(1.0, math.sqrt(hold_s * slope_per_s))
        self.up_end_s = self.peak / slope_per_s
        self.down_start_s = hold_s if self.peak == 1.0 else self.up_end_s
        self.total_s = self.down_start_s + self.up_end_s

    @property
    def corners(self) -> Sequence[tuple[float, float]]:
        """Return time and rate, 1/s, wherever the slope of the rate changes."""
        peak = self.peak
        return (0.0, 0.0), (self.up_end_s, peak), (self.down_start_s, peak), (self.total_s, 0.0)

    def at(self, t_s: float) -> tuple[float, float]:
        """Return (s, ds/dt) at `t_s` after the start; before it (0, 0), after the end (hold_s, 0)."""
        if t_s <= 0.0:
            return 0.0, 0.0
        if t_s < self.up_end_s:
            rate = self.slope_per_s * t_s
            return 0.5 * rate * t_s, rate
        if t_s <= self.down_start_s:
            return self.peak * (t_s - 0.5 * self.up_end_s), self.peak
        left_s = self.total_s - t_s
        if left_s <= 0.0:
            return self.hold_s, 0.0
        rate = self.slope_per_s * left_s
        return self.hold_s - 0.5 * rate * left_s, rate

    def time_at(self, s: float) -> float:
        """Return when it is at progress `s`: the inverse of `at`."""
        left = self.hold_s - s
        if s <= 0.0 or left <= 0.0:
            return 0.0 if s <= 0.0 else self.total_s
        ramped = 0.5 * self.peak * self.up_end_s
        if s < ramped:
            return math.sqrt(2.0 * s / self.slope_per_s)
        if left < ramped:
            return self.total_s - math.sqrt(2.0 * left / self.slope_per_s)
        return s / self.peak + 0.5 * self.up_end_s

    def stop_early(self, t_s: float) -> Ramp:
        """Return the same ramp up to `t_s`, and from there down with slope k: a controlled stop."""
        if t_s >= self.down_start_s:
            return self
        s, rate = self.at(t_s)
        stopped = Ramp.__new__(Ramp)
        stopped.slope_per_s = self.slope_per_s
        stopped.peak = rate
        stopped.hold_s = s + 0.5 * rate * rate / self.slope_per_s
        stopped.up_end_s = rate / self.slope_per_s
        stopped.down_start_s = max(0.0, t_s)
        stopped.total_s = stopped.down_start_s + stopped.up_end_s
        return stopped


class Segment:
    """A ramped twist that starts at a pose. Says where the robot should be, and how fast, at every moment.

    Args:
        motion: what to do.
        start: reference pose at t = 0; all poses come out in its frame.
        ramp: for a motion cut short; otherwise made from `motion`.
    """

    __slots__ = ("_center_x", "_center_y", "_cos", "_sin", "motion", "ramp", "start")

    def __init__(self, motion: RampedTwist, start: Pose, ramp: Ramp | None = None) -> None:
        self.motion = motion
        self.start = start
        self.ramp = ramp if ramp is not None else Ramp(motion.hold_s, motion.ramp_per_s)
        self._cos, self._sin = math.cos(start.yaw_rad), math.sin(start.yaw_rad)
        vx, vy, wz = motion.twist
        if abs(wz) >= STRAIGHT_RADPS:
            self._center_x = start.x_m + (-self._sin * vx - self._cos * vy) / wz
            self._center_y = start.y_m + (self._cos * vx - self._sin * vy) / wz

    @property
    def total_s(self) -> float:
        """Return how long it lasts, seconds."""
        return self.ramp.total_s

    @property
    def end_pose(self) -> Pose:
        """Return the reference pose at the end."""
        return self.start.moved(self.motion.twist, self.ramp.hold_s)

    def pose_at_progress(self, s: float) -> Pose:
        """Return the reference pose after `s` seconds of the full twist."""
        vx, vy, wz = self.motion.twist
        start = self.start
        if abs(wz) < STRAIGHT_RADPS:
            if wz != 0.0:
                return start.moved(self.motion.twist, s)
            cos, sin = self._cos, self._sin
            return Pose(
                start.x_m + s * (cos * vx - sin * vy), start.y_m + s * (sin * vx + cos * vy), start.yaw_rad
            )
        yaw = start.yaw_rad + wz * s
        cos, sin = math.cos(yaw), math.sin(yaw)
        return Pose(
            self._center_x + (sin * vx + cos * vy) / wz, self._center_y + (sin * vy - cos * vx) / wz, yaw
        )

    def progress_at(self, pose: Pose) -> float:
        """Return the progress whose reference pose is nearest to `pose`; it may lie before the start or after the end.

        On a curve it is measured about the curve's centre, on a tight one and on the spot by the heading.
        """
        twist, moved = self.motion.twist, pose.relative_to(self.start)
        speed = twist.speed_mps
        if speed < TIGHT_M * abs(twist.wz_radps):
            return moved.yaw_rad / twist.wz_radps
        if abs(twist.wz_radps) < STRAIGHT_RADPS:
            return (moved.x_m * (twist.vx_mps / speed) + moved.y_m * (twist.vy_mps / speed)) / speed
        cx, cy = -twist.vy_mps / twist.wz_radps, twist.vx_mps / twist.wz_radps
        x, y = moved.x_m - cx, moved.y_m - cy
        about = math.atan2(cy * x - cx * y, -cx * x - cy * y)
        return (moved.yaw_rad + math.remainder(about - moved.yaw_rad, 2.0 * math.pi)) / twist.wz_radps

    def at(self, t_s: float) -> tuple[Pose, Twist]:
        """Return reference pose and reference twist (robot's frame) at `t_s` after the start."""
        s, rate = self.ramp.at(t_s)
        twist = self.motion.twist.scaled(rate) if rate else ZERO_TWIST
        return self.pose_at_progress(s), twist

    def stop_early(self, t_s: float) -> Segment:
        """Return the same motion with a controlled stop that begins at `t_s`."""
        return Segment(self.motion, self.start, self.ramp.stop_early(t_s))
