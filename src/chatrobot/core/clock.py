"""Time as a parameter, and the periods that all of us keep: code runs in real time and as fast as it goes alike."""

from __future__ import annotations

import time
from typing import Protocol

TICK_S = 0.02
"""The control period, 50 Hz: of Motion's loop and its beats to the guard, of the governor and of rehearsal."""

BEAT_HZ = 10.0
TERM_S = 0.3
"""A source beats at `BEAT_HZ`; after `TERM_S` without a beat the robot is told to stand."""

LOCAL_BEAT_HZ = 25.0
LOCAL_TERM_S = 0.18
"""On one machine beats are cheap, and a frozen console must be noticed so that zeros arrive within 250 ms."""

PRESENCE_S = 0.1
"""So often every Motion says on its topic that it is there."""

_BOOT_CLOCK: int = getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC)


class Clock(Protocol):
    """Seconds since an arbitrary start. Never goes backwards, is never the wall clock."""

    def now_s(self) -> float: ...

    def suspended_s(self) -> float:
        """Seconds the machine has slept so far. `now_s` does not count them; a robot may have gone on for them."""
        ...


class RealClock:
    """The machine's monotonic clock (shared by all processes of one machine since its boot)."""

    def now_s(self) -> float:
        return time.monotonic()

    def suspended_s(self) -> float:
        return awake_or_not_s() - time.monotonic()


def awake_or_not_s() -> float:
    """Monotonic time that goes on while the machine sleeps; the plain one where there is none such (not Linux)."""
    return time.clock_gettime(_BOOT_CLOCK)


class VirtualClock:
    """A clock that stands until someone moves it on."""

    def __init__(self, start_s: float = 0.0) -> None:
        self._now_s = start_s
        self._suspended_s = 0.0

    def now_s(self) -> float:
        return self._now_s

    def suspended_s(self) -> float:
        return self._suspended_s

    def suspend(self, duration_s: float) -> None:
        """The machine sleeps for so long, and this clock stands meanwhile."""
        self._suspended_s += duration_s

    def advance(self, duration_s: float) -> None:
        """Move on by `duration_s`.

        Raises:
            ValueError: for a negative duration; time does not go back.
        """
        if not duration_s >= 0.0:
            raise ValueError(f"a clock cannot go back: {duration_s} s")
        self._now_s += duration_s
