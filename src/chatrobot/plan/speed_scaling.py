"""Another speed for a plan that is being driven: the same path, faster or slower from now on, and without a stop.

Speed scaling as controllers of arms have it: where the robot goes stays as it was rehearsed, only when it is there
changes. A motion that was to last a given time lasts as long as before where it becomes slower, and covers less.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from chatrobot.core.geometry import Twist
from chatrobot.plan.base import Plan, Step, expanded, with_each
from chatrobot.plan.context import max_arc_speed_mps, max_speed_mps
from chatrobot.plan.steps import Arc, Drive, Face, Go, Turn
from chatrobot.plan.trajectory import Ramp, RampedTwist, Segment, ramp_rate
from chatrobot.robots.profile import Limits, RobotProfile


@dataclass(frozen=True)
class SpeedScaling:
    """Factors, 1 for no change: `linear_factor` of motions that go somewhere, `angular_factor` of turns on the spot."""

    linear_factor: float = 1.0
    angular_factor: float = 1.0

    @property
    def is_faster(self) -> bool:
        """True where any motion becomes faster."""
        return max(self.linear_factor, self.angular_factor) > 1.0

    def times(self, other: SpeedScaling) -> SpeedScaling:
        """Return the one that does both."""
        return SpeedScaling(
            self.linear_factor * other.linear_factor, self.angular_factor * other.angular_factor
        )

    def factor(self, twist: Twist, limits: Limits) -> float:
        """Return the factor of a motion with that full twist, no more than `limits` allow."""
        wanted = self.linear_factor if twist.speed_mps > 0.0 else self.angular_factor
        room = [wanted]
        if twist.speed_mps > 0.0:
            most_mps = max_speed_mps(limits, math.atan2(twist.vy_mps, twist.vx_mps))
            room.append(most_mps / twist.speed_mps)
        if twist.wz_radps != 0.0:
            room.append(limits.max_rate_radps / abs(twist.wz_radps))
        return min(room) if wanted > 1.0 else wanted

    def motion(self, motion: RampedTwist, limits: Limits) -> RampedTwist:
        """Return a motion that has not begun at the other speed."""
        factor = self.factor(motion.twist, limits)
        if factor == 1.0:
            return motion
        twist = motion.twist.scaled(factor)
        hold_s = motion.hold_s if motion.is_timed and factor < 1.0 else motion.hold_s / factor
        return replace(motion, twist=twist, hold_s=hold_s, ramp_per_s=ramp_rate(limits, twist), asked=None)

    def segment(self, segment: Segment, t_s: float, limits: Limits) -> Segment:
        """Return a motion under way with the other speed from `t_s` on; as it is where it brakes to its end already."""
        motion = segment.motion
        factor = self.factor(motion.twist, limits)
        twist = motion.twist.scaled(factor)
        slope_per_s = ramp_rate(limits, twist)
        s, rate = (value / factor for value in segment.ramp.at(t_s))
        full_rest_s = segment.ramp.hold_s - s * factor
        if motion.is_timed and factor < 1.0:
            # It lasts as long: what it covers while it slows down counts in addition.
            rest_s = full_rest_s + 0.5 * (max(rate, 1.0) - 1.0) ** 2 / slope_per_s
        else:
            rest_s = full_rest_s / factor
        if factor == 1.0 or t_s >= segment.ramp.down_start_s or 0.5 * rate * rate > slope_per_s * rest_s:
            return segment
        earlier = [(at_s, before / factor) for at_s, before in segment.ramp.corners if at_s < t_s]
        later = _to_the_end(t_s, rate, rest_s, slope_per_s)
        ramp = ChangedRamp([*earlier, (t_s, rate), *later], slope_per_s)
        changed = replace(motion, twist=twist, hold_s=ramp.hold_s, ramp_per_s=slope_per_s, asked=None)
        return Segment(changed, segment.start, ramp)

    def plan(self, plan: Plan, profile: RobotProfile) -> Plan:
        """Return the plan whose steps say the other speed."""
        return Plan(tuple(with_each(step, partial(self._step, profile)) for step in plan.steps))

    def _step(self, profile: RobotProfile, step: Step) -> Step:
        if isinstance(step, (Drive, Go, Arc)) and self.linear_factor != 1.0:
            speed_mps, most_mps = _speed(step, profile)
            return replace(step, speed_mps=min(speed_mps * self.linear_factor, most_mps))
        if isinstance(step, (Turn, Face)) and self.angular_factor != 1.0:
            rate_radps, most_radps = _speed(step, profile)
            return replace(step, rate_radps=min(rate_radps * self.angular_factor, most_radps))
        return step


class ChangedRamp(Ramp):
    """Progress whose rate changed on the way.

    Args:
        corners: time and rate, 1/s, wherever the slope of the rate changes; from (0, 0) to a rate of 0.
        slope_per_s: how steep a controlled stop is.
    """

    __slots__ = ("_corners", "_progress", "_times_s")

    def __init__(self, corners: Sequence[tuple[float, float]], slope_per_s: float) -> None:
        self._corners = list(corners)
        self.slope_per_s = slope_per_s
        self._times_s = [at_s for at_s, _ in corners]
        self._progress = [0.0]
        for (from_s, before), (to_s, after) in pairwise(corners):
            self._progress.append(self._progress[-1] + 0.5 * (before + after) * (to_s - from_s))
        self.hold_s, self.total_s = self._progress[-1], self._times_s[-1]
        self.down_start_s, self.peak = corners[-2]
        self.up_end_s = self._times_s[-3] if len(corners) > 2 else 0.0

    @property
    def corners(self) -> Sequence[tuple[float, float]]:
        """Return time and rate, 1/s, wherever the slope of the rate changes."""
        return self._corners

    def at(self, t_s: float) -> tuple[float, float]:
        """Return (s, ds/dt) at `t_s` after the start."""
        if t_s <= 0.0 or t_s >= self.total_s:
            return (0.0, 0.0) if t_s <= 0.0 else (self.hold_s, 0.0)
        before = bisect_right(self._times_s, t_s) - 1
        rate, slope_per_s, since_s = self.corners[before][1], self._slope(before), t_s - self._times_s[before]
        s = self._progress[before] + (rate + 0.5 * slope_per_s * since_s) * since_s
        return s, rate + slope_per_s * since_s

    def time_at(self, s: float) -> float:
        """Return when it is at progress `s`."""
        if s <= 0.0 or s >= self.hold_s:
            return 0.0 if s <= 0.0 else self.total_s
        before = bisect_right(self._progress, s) - 1
        rate, slope_per_s, more = self.corners[before][1], self._slope(before), s - self._progress[before]
        root = math.sqrt(max(0.0, rate * rate + 2.0 * slope_per_s * more))
        return self._times_s[before] + 2.0 * more / (rate + root)

    def stop_early(self, t_s: float) -> Ramp:
        """Return the same up to `t_s`, and from there down with slope k."""
        if t_s >= self.down_start_s:
            return self
        rate = self.at(t_s)[1]
        earlier = [corner for corner in self.corners if corner[0] < t_s]
        return ChangedRamp([*earlier, (t_s, rate), (t_s + rate / self.slope_per_s, 0.0)], self.slope_per_s)

    def _slope(self, before: int) -> float:
        (from_s, rate), (to_s, after) = self.corners[before : before + 2]
        return (after - rate) / (to_s - from_s)


def _to_the_end(
    t_s: float, rate_share: float, rest_s: float, slope_per_s: float
) -> list[tuple[float, float]]:
    """The corners from a rate at `t_s` to full speed, or as near as the rest allows, level, and down to a stand."""
    reached = math.sqrt(slope_per_s * rest_s + 0.5 * rate_share * rate_share)
    peak = 1.0 if rate_share >= 1.0 else min(1.0, reached)
    changing_s, braking_s = abs(peak - rate_share) / slope_per_s, peak / slope_per_s
    level = rest_s - 0.5 * (rate_share + peak) * changing_s - 0.5 * peak * braking_s
    there_s = t_s + changing_s
    down_s = there_s + max(0.0, level) / peak
    corners = [(there_s, peak), (down_s, peak), (down_s + braking_s, 0.0)]
    times = [t_s, there_s, down_s]
    return [corner for before_s, corner in zip(times, corners) if corner[0] > before_s]


def speed_scaling(
    before: Plan, after: Plan, profile: RobotProfile, *, step_number: int = 1
) -> SpeedScaling | None:
    """Return what makes the one plan of the other, None where they differ in more than speeds.

    Args:
        step_number: of the step under way, repeats counted; it tells the factor where they differ.
    """
    planned, changed = list(expanded(before.steps)), list(expanded(after.steps))
    if list(map(_at_no_speed, planned)) != list(map(_at_no_speed, changed)):
        return None
    pairs = list(zip(planned, changed))
    factors: dict[bool, float] = {}
    for one, other in [*pairs[step_number - 1 :], *pairs]:
        if one != other:
            is_turn = isinstance(one, (Turn, Face))
            factors.setdefault(is_turn, _speed(other, profile)[0] / _speed(one, profile)[0])
    return SpeedScaling(factors.get(False, 1.0), factors.get(True, 1.0))


def _at_no_speed(step: Step) -> Step:
    if isinstance(step, (Drive, Go, Arc)):
        return replace(step, speed_mps=None)
    return replace(step, rate_radps=None) if isinstance(step, (Turn, Face)) else step


def _speed(step: Step, profile: RobotProfile) -> tuple[float, float]:
    """The speed of a step and the highest one for it, m/s; of a turn on the spot its rates, rad/s."""
    limits, defaults = profile.limits, profile.defaults
    if isinstance(step, (Turn, Face)):
        most = limits.max_rate_radps
        return step.rate_radps or min(defaults.rate_radps, most), most
    assert isinstance(step, (Drive, Go, Arc))
    most = max_speed_mps(limits, step.direction_rad if isinstance(step, Drive) else 0.0)
    if isinstance(step, Arc):
        most = min(most, max_arc_speed_mps(limits, step.radius_m))
    return step.speed_mps or min(defaults.speed_mps, most), most
