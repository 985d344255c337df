"""The tiny core that every primitive lowers to: a ramped twist, a pause, an event. Executors know nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.base import Condition
from chatrobot.robots.profile import Limits

NEAR_LIMIT = 0.7
RAMP_SHARE = 0.9
"""Beyond `NEAR_LIMIT` of the top speed feedback has little room above the reference; ramps then use only this share of
the accelerations, so that it can still brake more than the reference does. The governor holds the sum to all of it."""


@dataclass(frozen=True)
class RampedTwist:
    """A constant twist, held for `hold_s` and ramped at both ends so that the path is exactly twist * hold_s.

    All three components share one ramp, so the curvature is the same from the first tick to the last.
    `ramp_per_s` is how much of the twist a second of ramp adds (see `trajectory.Ramp`). `until` ends it early.
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
        """With the steepest ramp that keeps to both accelerations of `limits`. The twist must not be zero."""
        return cls(twist, hold_s, ramp_rate(limits, twist), until, asked, is_timed)

    def end(self, start: Pose) -> Pose:
        """The ideal pose at the end, in the frame of `start`."""
        return start.moved(self.twist, self.hold_s)


@dataclass(frozen=True)
class Pause:
    """Stand still for a time."""

    duration_s: float

    def end(self, start: Pose) -> Pose:
        return start


@dataclass(frozen=True)
class Emit:
    """Something to tell that needs no motion: kind `say` or `remember`, or a third party's own."""

    kind: str
    text: str

    def end(self, start: Pose) -> Pose:
        return start


_STEEPEST_PER_S = 1e6  # for velocities too small to matter; keeps infinities out of the arithmetic

CoreMotion = Union[RampedTwist, Pause, Emit]


def ramp_rate(limits: Limits, twist: Twist) -> float:
    """Share of `twist` that one second of ramp may add, 1/s, so that neither acceleration is exceeded.

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
