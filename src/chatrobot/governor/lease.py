"""Leases: a source may move the robot while its heartbeat beats. The lease expires, never the single message.

A heartbeat that comes late slows the robot, to zero at the lease's term; only after that the lease is over. In between
lies the time that a busy machine may keep a heartbeat back, for sources that can be seen to be running; a source that
is stopped, or that nobody can see, has no such time. What moved under a lease that is over never goes on by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from chatrobot.core.reason import Reason
from chatrobot.governor.priority import Priority, priority_of

LATE_S = 0.05
"""So long before its term ends a lease's beat is late: the robot goes slower."""
OVER_S = 0.45
LONGEST_S = 1.0
"""A source that runs may be silent for `OVER_S`, and for as long as this process itself was held up meanwhile, up to
`LONGEST_S` in all."""


@dataclass
class Lease:
    """One source's right to move. Times are on the governor's clock.

    `is_stopped` tells whether the source's process is stopped or gone; None where nobody can tell.
    """

    source: str
    term_s: float
    last_beat_s: float
    is_stopped: Callable[[], bool] | None = None
    held_up_s: float = 0.0
    """How long this process had been held up in all when the last beat came."""
    ended: bool = False

    def over_s(self, held_up_s: float) -> float:
        """How old the last beat may be; `held_up_s`: how long this process has been held up in all by now."""
        if self.is_stopped is None:
            return self.term_s
        return max(self.term_s, min(OVER_S + held_up_s - self.held_up_s, LONGEST_S))


class Leases:
    """All leases of one robot, by their id."""

    def __init__(self) -> None:
        self._leases: dict[str, Lease] = {}
        self._held_up_s = 0.0

    def open(
        self,
        lease_id: str,
        source: str,
        term_s: float,
        now_s: float,
        is_stopped: Callable[[], bool] | None = None,
    ) -> None:
        """`is_stopped`: see `Lease`."""
        self._leases[lease_id] = Lease(source, term_s, now_s, is_stopped, self._held_up_s)

    def is_known(self, lease_id: str) -> bool:
        """It has been opened before, whatever became of it."""
        return lease_id in self._leases

    def beat(self, lease_id: str, at_s: float) -> None:
        """A heartbeat of `at_s`. It revives a lease that lapsed (what moved under it has been stopped), not one that
        ended."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.last_beat_s, lease.held_up_s = at_s, self._held_up_s

    def note_held_up(self, duration_s: float) -> None:
        """This process was late itself by so long: it may have kept a beat waiting."""
        self._held_up_s += duration_s

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
        """A beat far in the future is as good as none: the clock went back."""
        lease = self._leases.get(lease_id)
        if lease is None or lease.ended:
            return False
        age_s = now_s - lease.last_beat_s
        return -lease.term_s <= age_s <= lease.over_s(self._held_up_s)

    def is_late(self, lease_id: str, now_s: float) -> bool:
        """Its last beat is older than it should be, and it may be a busy machine that keeps the next one back."""
        lease = self._leases.get(lease_id)
        return lease is not None and not lease.ended and self.share(lease_id, now_s) < 1.0

    def is_stopped(self, lease_id: str) -> bool:
        """Its process is stopped or gone: looked up now. False where nobody can tell."""
        lease = self._leases.get(lease_id)
        return lease is not None and lease.is_stopped is not None and lease.is_stopped()

    def share(self, lease_id: str, now_s: float) -> float:
        """What share of its speed it may ask for: 1, less where its beat is late, 0 from its term on.

        A lease that is over at its term is given no less before.
        """
        lease = self._leases.get(lease_id)
        if lease is None or lease.is_stopped is None or math.isinf(lease.term_s):
            return 1.0
        return max(0.0, min(1.0, (lease.term_s - (now_s - lease.last_beat_s)) / LATE_S))

    def lateness(self, lease_id: str, now_s: float) -> Reason:
        """How late the beat of that lease is, for people."""
        lease = self._leases[lease_id]
        late_s = round(min(now_s - lease.last_beat_s, 999.0), 2)
        return Reason("beat_late", {"source": lease.source, "late_s": late_s})

    def priority_of(self, lease_id: str) -> Priority:
        """By its source; the lowest for a lease that nobody opened."""
        return priority_of(self.source_of(lease_id))

    def source_of(self, lease_id: str) -> str:
        lease = self._leases.get(lease_id)
        return lease.source if lease is not None else "unknown"
