"""A program's last velocity, held as its robot would hold it."""

from __future__ import annotations

import math

from chatrobot.core.geometry import ZERO_TWIST, Twist


class HeldTwist:
    """What a program asks for now: what it published last, for as long as the base would have held it.

    Args:
        base_timeout_s: of the robot's wiring; None holds for ever. The lease ends it in any case.
    """

    def __init__(self, base_timeout_s: float | None) -> None:
        self._timeout_s = math.inf if base_timeout_s is None else base_timeout_s
        self._twist = ZERO_TWIST
        self._ends_s = -math.inf

    def publish(self, twist: Twist, now_s: float) -> None:
        self._twist, self._ends_s = twist, now_s + self._timeout_s

    def at(self, now_s: float) -> Twist:
        return self._twist if now_s < self._ends_s else ZERO_TWIST

    @property
    def ends_s(self) -> float:
        """When it turns to zero."""
        return self._ends_s
