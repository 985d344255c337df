"""Notices that this process stood still, or the machine slept: what moved is over then."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import Clock
from chatrobot.core.reason import Reason
from chatrobot.session.guard_link import GuardLink

FROZEN_S = 0.12
"""A gap this long between two ticks of a moving robot means that this process stood still: the plan is over."""


class FreezeWatch:
    """Looks at the clock and at the guard with every tick, before anything else is done."""

    def __init__(self, clock: Clock, guard: GuardLink, halt: Callable[[Reason], None]) -> None:
        self._clock = clock
        self._guard = guard
        self._halt = halt
        self._last_tick_s: float | None = None
        self._suspended_s = clock.suspended_s()

    def tick(self, now_s: float, *, is_driven: bool, is_engaged: bool) -> None:
        """Halt where we were frozen, or the guard thinks so; then shake hands with it anew.

        Args:
            is_driven: a velocity of ours, or of others through us, moves the robot.
            is_engaged: something is being done, be it that it waits for a yes. What slept through a suspended
                machine is over, too.
        """
        suspended_s = self._suspended_since_last_tick_s()
        gap_s = suspended_s + (now_s - self._last_tick_s if self._last_tick_s is not None else 0.0)
        self._last_tick_s = now_s
        tripped = self._guard.was_tripped()
        slept = suspended_s > FROZEN_S and is_engaged
        if slept or (is_driven and gap_s > FROZEN_S):
            self._halt(Reason("motion_froze", {"gap_s": round(gap_s, 2)}))
        elif is_driven and tripped:  # we were there, and our beats came late all the same
            self._halt(Reason("beats_missed"))
        if tripped or gap_s > FROZEN_S:
            self._guard.handshake()

    def _suspended_since_last_tick_s(self) -> float:
        before_s, self._suspended_s = self._suspended_s, self._clock.suspended_s()
        return self._suspended_s - before_s
