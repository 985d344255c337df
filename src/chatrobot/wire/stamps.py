"""Header stamps of other machines, translated to this machine's monotonic clock.

Sender and receiver share no clock. The smallest difference between receipt and stamp seen lately belongs to the
message that travelled fastest: it is taken as the offset of the two clocks, so that a message held up on its way
keeps the age it has.
"""

from __future__ import annotations

import math
import time

WINDOW_S = 10.0
"""The offset is the smallest of the last one to two windows: clocks drift (50 ppm is 1 ms in 20 s)."""
LATEST_S = 30.0
"""A message that seems older than this is no late message: the sender's clock was set back."""
JUMP_S = 1.0
"""A stamp this far ahead of all others is no fast message: the sender's clock was set forward."""


class StampTranslator:
    """One sender's clock, learned from its messages."""

    def __init__(self) -> None:
        self._offset_s = math.inf
        self._previous_s = math.inf
        self._window_ends_s = -math.inf

    def local_s(self, stamp_s: float, received_s: float) -> float:
        """Return when a message was stamped, in seconds of the receiver's clock; never later than `received_s`.

        Args:
            stamp_s: the stamp, seconds of the sender's clock; zero or not finite where it sets none.
            received_s: when the message came, seconds of the receiver's clock.
        """
        if not math.isfinite(stamp_s) or stamp_s <= 0.0:
            return received_s
        if received_s >= self._window_ends_s:
            expired = received_s >= self._window_ends_s + WINDOW_S
            self._previous_s = math.inf if expired else self._offset_s
            self._offset_s = math.inf
            self._window_ends_s = received_s + WINDOW_S
        seen_s = received_s - stamp_s
        known_s = min(self._offset_s, self._previous_s)
        if math.isfinite(known_s) and not -JUMP_S <= seen_s - known_s <= LATEST_S:
            self._previous_s = self._offset_s = known_s = seen_s
        self._offset_s = min(self._offset_s, seen_s)
        return min(received_s, stamp_s + min(known_s, seen_s))


def to_wall_s(stamp_s: float) -> float:
    """A stamp of this machine's monotonic clock as seconds since 1970, which is what ROS headers carry."""
    return stamp_s + time.time() - time.monotonic()


def from_wall_s(stamp_s: float) -> float:
    """A stamp of this machine's wall clock, seconds since 1970, on its monotonic one, which nobody sets."""
    return stamp_s - time.time() + time.monotonic()
