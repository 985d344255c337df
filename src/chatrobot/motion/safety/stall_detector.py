"""Detects that this process stalled, or the machine slept: what moved is over then."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from chatrobot.core.clock import Clock
from chatrobot.core.process import is_machine_busy
from chatrobot.core.reason import Reason
from chatrobot.governor.tick import TICK_S
from chatrobot.guard.watch import MISSED_S
from chatrobot.motion.safety.watchdog import GuardLink

FROZEN_S = MISSED_S
"""A gap this long between two ticks of a moving robot means that this process stood still: the plan is over."""
LATE_S = 2.0 * TICK_S
"""A gap between two ticks up to this is nothing unusual."""
ANSWERED_TICKS = 10
"""The guard tells of a trip within so many ticks, or it is taken for dead."""


class StallDetector:
    """Looks at the clock and at the guard with every tick, before anything else is done."""

    def __init__(self, clock: Clock, guard: GuardLink, halt: Callable[[Reason], None]) -> None:
        self._clock = clock
        self._guard = guard
        self._halt = halt
        self._last_tick_s: float | None = None
        self._last_beat_s: float | None = None
        self._beat_gaps_s = deque([0.0], maxlen=ANSWERED_TICKS)
        self._suspended_s = clock.suspended_s()
        self._is_driven = False
        self._was_stopped = False

    def tick(self, now_s: float, *, is_driven: bool, is_engaged: bool) -> float:
        """Halt where we were frozen, or the guard thinks so; then shake hands with it anew.

        Args:
            is_driven: a velocity of ours, or of others through us, moves the robot.
            is_engaged: something is being done, be it that it waits for a yes. What slept through a suspended
                machine is over, too.

        Returns:
            How late this tick is, seconds; 0 where that is nothing unusual.
        """
        suspended_s = self._suspended_since_last_tick_s()
        gap_s = suspended_s + (now_s - self._last_tick_s if self._last_tick_s is not None else 0.0)
        self._last_tick_s, self._is_driven = now_s, is_driven
        was_stopped, self._was_stopped = self._was_stopped, False
        tripped = self._guard.was_tripped()
        slept = suspended_s > FROZEN_S and is_engaged
        if slept or (is_driven and (gap_s > FROZEN_S or was_stopped)):
            is_starved = not (was_stopped or suspended_s > FROZEN_S) and is_machine_busy()
            self._halt(_late(gap_s) if is_starved else Reason("motion_froze", {"gap_s": round(gap_s, 2)}))
        elif is_driven and tripped:  # we were there, and our beats came late all the same
            beat_gap_s = max(self._beat_gaps_s)
            is_busy = beat_gap_s > LATE_S and is_machine_busy()
            self._halt(_late(beat_gap_s) if is_busy else Reason("beats_missed"))
        if tripped or gap_s > FROZEN_S:
            self._guard.handshake()
        return gap_s - TICK_S if gap_s > LATE_S else 0.0

    def beat(self, now_s: float) -> None:
        """Say to the guard that we are there."""
        self._guard.beat()
        if self._last_beat_s is not None:
            self._beat_gaps_s.append(now_s - self._last_beat_s)
        self._last_beat_s = now_s

    def thaw(self, now_s: float) -> Reason | None:
        """This process was stopped by a signal and goes on; why what is driven is over."""
        self._was_stopped = True
        since_s = now_s - self._last_tick_s if self._last_tick_s is not None else 0.0
        return Reason("motion_froze", {"gap_s": round(since_s, 2)}) if self._is_driven else None

    def _suspended_since_last_tick_s(self) -> float:
        before_s, self._suspended_s = self._suspended_s, self._clock.suspended_s()
        return self._suspended_s - before_s


def _late(gap_s: float) -> Reason:
    return Reason("motion_late", {"late_s": round(gap_s, 2)})
