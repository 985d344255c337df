"""Since when the robot has been at rest: told to stand, and seen not to roll.

A gyro's bias may only be learned then. That the wheels look slow is not enough: a robot that is told to creep does.
"""

from __future__ import annotations

import math

from chatrobot.wire.messages import Odometry

STANDING_SPEED_MPS = 0.005
STANDING_RATE_RADPS = 0.02
SETTLED_S = 0.15
"""A robot that was told to stand has braked and rocks no more after so long."""
UNROLLED_S = 0.06
"""Wheels stand when several messages in a row have said so."""


class Rest:
    """`note_command` may come from another thread than `see`."""

    def __init__(self) -> None:
        self._told_since_s = -math.inf
        self._still_since_s = math.inf

    def note_command(self, *, is_zero: bool, now_s: float) -> None:
        """The robot has just been told to stand, or to move."""
        if not is_zero:
            self._told_since_s = math.inf
        elif self._told_since_s == math.inf:
            self._told_since_s = now_s

    def see(self, message: Odometry) -> None:
        """What its wheels do."""
        if not is_still(message):
            self._still_since_s = math.inf
        elif self._still_since_s == math.inf:
            self._still_since_s = message.stamp_s

    @property
    def told_since_s(self) -> float:
        """Since when it has been told to stand; infinite where it was told to move, minus infinity if it never was."""
        return self._told_since_s

    @property
    def since_s(self) -> float:
        """Since when it has been at rest, once the body was still, too; infinite where it moves."""
        return max(self._told_since_s + SETTLED_S, self._still_since_s + UNROLLED_S)


def is_still(message: Odometry) -> bool:
    """The wheels do not turn, as far as their speed tells."""
    speed_mps = math.hypot(message.vx_mps, message.vy_mps)
    return speed_mps < STANDING_SPEED_MPS and abs(message.wz_radps) < STANDING_RATE_RADPS
