"""Leases: a source may move the robot while its heartbeat beats. The lease expires, never the single message."""

from __future__ import annotations

import math
from dataclasses import dataclass

from chatrobot.governor.priority import Priority, priority_of

BEAT_HZ = 10.0
TERM_S = 0.3
"""A source beats at `BEAT_HZ`; `TERM_S` without a beat ends its motion."""

LOCAL_BEAT_HZ = 25.0
LOCAL_TERM_S = 0.18
"""On one machine beats are cheap, and a frozen console must be noticed so that zeros arrive within 250 ms."""


@dataclass
class Lease:
    """One source's right to move. Times are on the governor's clock."""

    source: str
    term_s: float
    last_beat_s: float
    ended: bool = False

    def is_valid(self, now_s: float) -> bool:
        """A beat far in the future is as good as none: the clock went back."""
        return not self.ended and abs(now_s - self.last_beat_s) <= self.term_s


class Leases:
    """All leases of one robot, by their id."""

    def __init__(self) -> None:
        self._leases: dict[str, Lease] = {}

    def open(self, lease_id: str, source: str, term_s: float, now_s: float) -> None:
        self._leases[lease_id] = Lease(source, term_s, now_s)

    def is_known(self, lease_id: str) -> bool:
        """It has been opened before, whatever became of it."""
        return lease_id in self._leases

    def beat(self, lease_id: str, now_s: float) -> None:
        """A heartbeat. It revives a lease that lapsed (what moved under it has been stopped), not one that ended."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.last_beat_s = now_s

    def entrust(self, lease_id: str) -> None:
        """An orderly goodbye: what is queued may still be done, without beats."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.term_s = math.inf

    def end(self, lease_id: str) -> None:
        """For good: goodbye, end of file, or stop of a program."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.ended = True

    def is_valid(self, lease_id: str, now_s: float) -> bool:
        lease = self._leases.get(lease_id)
        return lease is not None and lease.is_valid(now_s)

    def priority_of(self, lease_id: str) -> Priority:
        """By its source; the lowest for a lease that nobody opened."""
        return priority_of(self.source_of(lease_id))

    def source_of(self, lease_id: str) -> str:
        lease = self._leases.get(lease_id)
        return lease.source if lease is not None else "unknown"
