"""Jerk: how fast an acceleration may grow. It binds what gains speed; zero and a rule's braking it never touches.

A limit that delayed braking would lengthen every way to a stop, which the other rules count on. So what gains speed
eases into its acceleration and out of it again before the speed that was asked for, along the straight line that the
kernel goes, and what only brakes goes as the kernel says.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.robots.profile import Limits


class JerkLimit:
    """Of one robot; remembers the acceleration of the last step, in m/s² and rad/s²."""

    def __init__(self, limits: Limits) -> None:
        self._linear_mps3 = limits.jerk_mps3
        self._angular_radps3 = limits.angular_jerk_radps3
        self._acceleration = ZERO_TWIST

    def eased(self, previous: Twist, wanted: Twist, target: Twist, dt_s: float, *, urgent: bool) -> Twist:
        """What may be sent of the step from `previous` to `wanted` on the way to `target`.

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
        """What was sent in the end: the acceleration that the next step goes on from."""
        if dt_s > 0.0:
            self._acceleration = Twist(*_between(previous, sent)).scaled(1.0 / dt_s)

    def rest(self) -> None:
        """It stands: the next acceleration begins at none."""
        self._acceleration = ZERO_TWIST


def _between(previous: Twist, wanted: Twist) -> tuple[float, float, float]:
    return (
        wanted.vx_mps - previous.vx_mps,
        wanted.vy_mps - previous.vy_mps,
        wanted.wz_radps - previous.wz_radps,
    )


def _most(acceleration: float, left: float, jerk: float, dt_s: float) -> float:
    """The most that one step may add: more acceleration by the jerk, but only as much as can be eased out again.

    Out again over `left`: a^2 / (2 j) + a dt / 2 <= left, solved for a.
    """
    half = 0.5 * jerk * dt_s
    return min(max(0.0, acceleration) + jerk * dt_s, math.sqrt(half * half + 2.0 * jerk * left) - half) * dt_s
