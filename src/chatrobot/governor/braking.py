"""How fast a robot may be that must be able to brake within the free way.

The twist is scaled by one factor f so that latency and braking fit into the free way s (both in seconds of the full
twist): f * latency + f^2 / (2 k) <= s, where k is the share of the twist that one second of braking takes away.
Solved for f: f = -k L + sqrt((k L)^2 + 2 k s). Source: uniform deceleration, v^2 = 2 a d, with a dead time.
"""

from __future__ import annotations

import math

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Twist
from chatrobot.robots.profile import Limits

LOOK_BEYOND_S = 0.3
"""Farther than it takes to brake, so that slowing down begins softly."""

CREEP_MPS = 0.01
CREEP_RADPS = 0.02
"""Slower than this is standing: a robot does not crawl into a wall."""

_MOST_PER_S = 1e6
"""A twist of next to nothing is braked at once; a bound keeps the arithmetic finite."""


class Braking:
    """Braking from one twist (not zero) of one robot."""

    def __init__(self, limits: Limits, twist: Twist) -> None:
        linear_mps2 = min(limits.acceleration_mps2, limits.deceleration_mps2)
        slowest = _MOST_PER_S
        if twist.speed_mps > 0.0:
            slowest = min(slowest, linear_mps2 / twist.speed_mps)
        if twist.wz_radps != 0.0:
            slowest = min(slowest, limits.angular_acceleration_radps2 / abs(twist.wz_radps))
        self._twist = twist
        self._per_s = slowest
        self._latency_s = limits.latency_s + TICK_S

    @property
    def horizon_s(self) -> float:
        """How far ahead to look, in seconds of the twist."""
        return self._latency_s + 0.5 / self._per_s + LOOK_BEYOND_S

    def factor_within(self, free_s: float) -> float:
        """The share of the twist, 0 to 1, from which the robot can brake within `free_s` seconds of the twist.

        Infinite seconds are all the way there is.
        """
        lag = self._per_s * self._latency_s
        factor = -lag + math.sqrt(lag * lag + 2.0 * self._per_s * free_s)
        if factor >= 1.0:
            return 1.0
        creeps = (
            self._twist.speed_mps * factor < CREEP_MPS and abs(self._twist.wz_radps) * factor < CREEP_RADPS
        )
        return 0.0 if creeps else factor
