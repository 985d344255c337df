"""What the guard decides: pure, on any clock, so that real time and simulated time run the same rule.

States: `idle` until Motion shakes hands, `watching` while beats come, `tripped` from a missed beat until Motion
shakes hands again. Only a trip sends anything.
"""

from __future__ import annotations

from typing import Literal

from chatrobot.core.clock import TICK_S

MISSED_S = 0.17
"""This long without a beat is a trip: a tick may come 0.11 s after the last where three times as many threads as there
are processors want to run, and 80 ms of the promised 250 ms are left for everything else."""

ECHO_LOST_S = 0.15
"""Motion takes a guard that does not echo for this long as dead, and does not move without one."""

HANDSHAKE, BEAT, GOODBYE = b"H", b"B", b"G"
"""What Motion says to the guard, one byte each. The guard echoes them; a handshake among beats is what it echoes."""

TRIPPED = b"T"
"""What the guard answers to a beat that comes too late."""


class Watch:
    """The guard's rule."""

    def __init__(self) -> None:
        self.state: Literal["idle", "watching", "tripped"] = "idle"
        self._last_beat_s = 0.0

    def hear(self, word: bytes, now_s: float) -> None:
        """A word from Motion. After a trip, beats alone do not help: Motion must know that it was tripped."""
        if word == HANDSHAKE:
            self.state = "watching"
        if self.state == "watching":
            self._last_beat_s = now_s

    def lose(self) -> None:
        """Motion's end of the line is gone without a goodbye."""
        if self.state == "watching":
            self.state = "tripped"

    def must_halt(self, now_s: float) -> bool:
        """True while zeros are to be sent; trips where a beat is overdue."""
        if self.state == "watching" and now_s - self._last_beat_s > MISSED_S:
            self.state = "tripped"
        return self.state == "tripped"

    def seconds_left(self, now_s: float) -> float:
        """How long until something may have to be done."""
        if self.state == "idle":
            return MISSED_S
        if self.state == "tripped":
            return TICK_S  # Motion beats with every tick of its control loop
        return max(0.0, self._last_beat_s + MISSED_S - now_s)
