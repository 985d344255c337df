"""Limits that were narrowed at run time. There is no way to widen them: a new run begins at the profile's."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.battery import at_most
from chatrobot.governor.rule import FREE, Ruling, Situation


class NarrowedRule:
    """Speeds below the profile's. Speed is zero or more; NaN is refused by comparing nothing with it."""

    name = "narrowed"

    def __init__(self) -> None:
        self._speed_mps = math.inf
        self._rate_radps = math.inf

    def narrow(self, speed_mps: float, rate_radps: float) -> None:
        """At most these from now on, and never more than before. Raises ValueError for what is no limit."""
        for limit in (speed_mps, rate_radps):
            if not limit >= 0.0:
                raise ValueError(f"not a limit: {limit}")
        self._speed_mps = min(self._speed_mps, speed_mps)
        self._rate_radps = min(self._rate_radps, rate_radps)

    def judge(self, asked: Twist, situation: Situation) -> Ruling:  # noqa: ARG002 - the protocol's
        factor = at_most(asked, self._speed_mps, self._rate_radps)
        if factor == 1.0:
            return FREE
        reason = Reason("narrowed", {"speed_mps": asked.speed_mps * factor})
        return Ruling(factor, reason, urgent=False)
