"""The one trajectory generator: rehearsal, executor and generated code all take their references from here.

A motion is a constant twist scaled by one progress variable s(t), in seconds of that twist. Its rate ds/dt rises
from 0 to 1 with slope k, stays, and falls again, so that s ends at exactly `hold_s`: the path is twist * hold_s, and
linear and angular velocity keep their ratio (the curvature) at every moment. Source of the trapezoid with equal
area: Lynch and Park, Modern Robotics (2017), section 9.2.2.2.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.plan.core_motion import RampedTwist

STRAIGHT_RADPS = 1e-6  # below this the circle's centre is so far off that rounding beats the curvature
TIGHT_M = 0.1
"""On a smaller radius than this the heading tells better than the position how far a motion is."""


class Ramp:
    """Progress s(t) of one motion: up with slope k, level, down with slope k.

    Args:
        hold_s: how long the full twist would have to be held for the same path; s at the end.
        k: slope of ds/dt, 1/s. Where hold_s < 1/k the level part vanishes and the peak stays below 1.
    """

    __slots__ = ("down_start_s", "hold_s", "k", "peak", "total_s", "up_end_s")

    def __init__(self, hold_s: float, k: float) -> None:
        if not (hold_s >= 0.0 and k > 0.0):
            raise ValueError(f"a ramp needs hold_s >= 0 and k > 0, not {hold_s} and {k}")
        self.hold_s = hold_s
        self.k = k
        self.peak = min(1.0, math.sqrt(hold_s * k))
        self.up_end_s = self.peak / k
        self.down_start_s = hold_s if self.peak == 1.0 else self.up_end_s
        self.total_s = self.down_start_s + self.up_end_s

    def at(self, t_s: float) -> tuple[float, float]:
        """(s, ds/dt) at `t_s` after the start; before it (0, 0), after the end (hold_s, 0)."""
        if t_s <= 0.0:
            return 0.0, 0.0
        if t_s < self.up_end_s:
            rate = self.k * t_s
            return 0.5 * rate * t_s, rate
        if t_s <= self.down_start_s:
            return self.peak * (t_s - 0.5 * self.up_end_s), self.peak
        left_s = self.total_s - t_s
        if left_s <= 0.0:
            return self.hold_s, 0.0
        rate = self.k * left_s
        return self.hold_s - 0.5 * rate * left_s, rate

    def time_at(self, s: float) -> float:
        """When s is first reached, clamped to [0, total_s]: the inverse of `at`."""
        if s <= 0.0:
            return 0.0
        if s >= self.hold_s:
            return self.total_s
        if s < 0.5 * self.peak * self.up_end_s:
            return math.sqrt(2.0 * s / self.k)
        left = self.hold_s - s
        if left < 0.5 * self.peak * self.up_end_s:
            return self.total_s - math.sqrt(2.0 * left / self.k)
        return s / self.peak + 0.5 * self.up_end_s

    def stop_early(self, t_s: float) -> Ramp:
        """The same ramp up to `t_s`, and from there down with slope k: a controlled stop."""
        if t_s >= self.down_start_s:
            return self
        s, rate = self.at(t_s)
        stopped = Ramp.__new__(Ramp)
        stopped.k = self.k
        stopped.peak = rate
        stopped.hold_s = s + 0.5 * rate * rate / self.k
        stopped.up_end_s = rate / self.k
        stopped.down_start_s = max(0.0, t_s)
        stopped.total_s = stopped.down_start_s + stopped.up_end_s
        return stopped


class Segment:
    """A ramped twist that starts at a pose: where the robot should be, and how fast, at every moment.

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
        return self.ramp.total_s

    @property
    def end_pose(self) -> Pose:
        return self.start.moved(self.motion.twist, self.ramp.hold_s)

    def pose_at_progress(self, s: float) -> Pose:
        """The reference pose after `s` seconds of the full twist."""
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
        """The progress whose reference pose is nearest to `pose`; it may lie before the start or after the end.

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
        """Reference pose and reference twist (robot's frame) at `t_s` after the start."""
        s, rate = self.ramp.at(t_s)
        twist = self.motion.twist.scaled(rate) if rate else ZERO_TWIST
        return self.pose_at_progress(s), twist

    def stop_early(self, t_s: float) -> Segment:
        """The same motion with a controlled stop that begins at `t_s`."""
        return Segment(self.motion, self.start, self.ramp.stop_early(t_s))
