"""How late the robot does what it is told, measured whenever it sets out.

A base that follows late makes good at the end of a motion what it owed at the start. Where feedback takes that debt
for an error and drives it, the robot goes too far by just as much; so feedback has to know it.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import ZERO_TWIST, Twist

STEADY_SHARE = 0.1
STEADY_S = 0.15
"""A base has caught up with a velocity that has been held for so long, give or take that share of it."""
GAINING_S = 0.15
"""While it still gains speed, so long after its start, there is a first guess; none before."""
LONGEST_S = 1.5
"""Later after its start it may owe for other reasons."""
LEAST_MPS, LEAST_RADPS = 0.1, 0.2
"""From slower motion nothing can be told."""
LATEST_S = 0.15
"""A base that is later than that has another fault."""


class _Debt:
    """What was told and not yet done, of either the way or the turn."""

    def __init__(self, least: float) -> None:
        self._least = least
        self._told = 0.0
        self._speed = 0.0
        self._began_at = 0.0
        self._began_s = self._steady_since_s = -math.inf
        self.is_measured = True

    def begin(self, done: float, now_s: float) -> None:
        self._told, self._began_at = 0.0, done
        self._began_s = self._steady_since_s = now_s
        self.is_measured = False

    def tell(self, speed: float, now_s: float, held_s: float) -> None:
        """From now on it is to do `speed`; what it was told before has been held for `held_s`."""
        self._told += self._speed * held_s
        if abs(speed - self._speed) > STEADY_SHARE * abs(speed):
            self._steady_since_s = now_s
        self._speed = speed

    def late_s(self, done: float, stamp_s: float, told_s: float, *, guesses: bool) -> float | None:
        """How late it is, once that shows.

        Args:
            told_s: since when it is told what it is told now.
            guesses: a first guess will do.
        """
        if self.is_measured or abs(self._speed) < self._least:
            return None
        is_steady = stamp_s - self._steady_since_s >= STEADY_S
        if stamp_s - self._began_s > LONGEST_S or (not is_steady and not guesses):
            return None
        if stamp_s - self._began_s < GAINING_S:
            return None
        self.is_measured = is_steady
        owed = self._told + self._speed * (stamp_s - told_s) - (done - self._began_at)
        return owed / self._speed


class Response:
    """Belongs to the thread that sends; `lag_s` is what it has measured last."""

    def __init__(self) -> None:
        self.lag_s = 0.0
        self._is_guess = True
        self._way, self._turn = _Debt(LEAST_MPS), _Debt(LEAST_RADPS)
        self._twist = ZERO_TWIST
        self._told_s = 0.0

    def tell(self, twist: Twist, now_s: float, path_m: float, turned_rad: float) -> None:
        """The robot is told `twist` from now on; its wheels have rolled and turned so far in all."""
        if self._twist.is_zero and not twist.is_zero:
            self._way.begin(path_m, now_s)
            self._turn.begin(turned_rad, now_s)
            self._told_s = now_s
        held_s = now_s - self._told_s
        self._way.tell(twist.speed_mps, now_s, held_s)
        self._turn.tell(twist.wz_radps, now_s, held_s)
        self._twist, self._told_s = twist, now_s

    def see(self, stamp_s: float, path_m: float, turned_rad: float) -> None:
        """How far its wheels had rolled and turned by `stamp_s`."""
        for debt, done in ((self._way, path_m), (self._turn, turned_rad)):
            late_s = debt.late_s(done, stamp_s, self._told_s, guesses=self._is_guess)
            if late_s is not None:
                self.lag_s = max(0.0, min(LATEST_S, late_s))
                self._is_guess = self._is_guess and not debt.is_measured
