"""Leases: a source may move the robot while its heartbeat beats, and one source at a time, by priority.

The lease expires, never the single message. A heartbeat that comes late slows the robot, to zero at the lease's term;
only after that the lease is over. In between lies the time that a busy machine may keep a heartbeat back, for sources
that can be seen to be running; a source that is stopped, or that nobody can see, has no such time. What moved under a
lease that is over never goes on by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum

from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason


class Priority(IntEnum):
    """Ranks a source of motion; the higher one drives. An emergency stop is above all: it is a latch, not a source."""

    FOREIGN = 0
    """Text from a topic that carries no envelope."""
    AGENT = 1
    """A language agent, over MCP or the like."""
    PLAN = 2
    """A person's instruction, or a program that a person started."""
    JOYSTICK = 3
    """A person with a joystick or a stick on a page, looking at the robot."""


PRIORITIES: Mapping[str, Priority] = {
    "joystick": Priority.JOYSTICK,
    "stick": Priority.JOYSTICK,
    "console": Priority.PLAN,
    "program": Priority.PLAN,
    "web": Priority.PLAN,
    "base": Priority.PLAN,
    "agent": Priority.AGENT,
    "mcp": Priority.AGENT,
    "chatgpt_node": Priority.FOREIGN,
}
RELEASERS = frozenset({"console"})
"""Who may release an emergency stop unless the composition root names others: a person at the local console."""


STEERERS = frozenset({"console", "web", "base"})
"""Behind whom a person may hold a stick."""


def may_steer(source: str) -> bool:
    """Return whether a client of that name may steer; one that is not listed may not."""
    return source in STEERERS


def priority_of(source: str) -> Priority:
    """Return the priority of a source by its name; one that is not listed comes last."""
    return PRIORITIES.get(source, Priority.FOREIGN)


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
        """Return how old the last beat may be, seconds, where this process has been held up for `held_up_s` in all."""
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
        """Open a lease; `is_stopped`: see `Lease`."""
        self._leases[lease_id] = Lease(source, term_s, now_s, is_stopped, self._held_up_s)

    def is_known(self, lease_id: str) -> bool:
        """Return True where it has been opened before, whatever became of it."""
        return lease_id in self._leases

    def beat(self, lease_id: str, at_s: float) -> None:
        """Take a heartbeat of `at_s`. It revives a lease that lapsed (what moved
        under it has been stopped), not one that ended."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.last_beat_s, lease.held_up_s = at_s, self._held_up_s

    def note_held_up(self, duration_s: float) -> None:
        """Note that this process was late itself by so long: it may have kept a beat waiting."""
        self._held_up_s += duration_s

    def entrust(self, lease_id: str) -> None:
        """Take an orderly goodbye: what is queued may still be done, without beats."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.term_s = math.inf

    def end(self, lease_id: str) -> None:
        """End it for good: goodbye, end of file, or stop of a program."""
        lease = self._leases.get(lease_id)
        if lease is not None:
            lease.ended = True

    def is_valid(self, lease_id: str, now_s: float) -> bool:
        """Return True while it is held. A beat far in the future is as good as none: the clock went back."""
        lease = self._leases.get(lease_id)
        if lease is None or lease.ended:
            return False
        age_s = now_s - lease.last_beat_s
        return -lease.term_s <= age_s <= lease.over_s(self._held_up_s)

    def is_late(self, lease_id: str, now_s: float) -> bool:
        """Return True where its last beat is older than it should be: a busy machine may keep the next one back."""
        lease = self._leases.get(lease_id)
        return lease is not None and not lease.ended and self.share(lease_id, now_s) < 1.0

    def is_stopped(self, lease_id: str) -> bool:
        """Look up whether its process is stopped or gone. False where nobody can tell."""
        lease = self._leases.get(lease_id)
        return lease is not None and lease.is_stopped is not None and lease.is_stopped()

    def share(self, lease_id: str, now_s: float) -> float:
        """Return the share of its speed, 0 to 1, that it may ask for: less where its beat is late, 0 from its term on.

        A lease that is over at its term is given no less before.
        """
        lease = self._leases.get(lease_id)
        if lease is None or lease.is_stopped is None or math.isinf(lease.term_s):
            return 1.0
        return max(0.0, min(1.0, (lease.term_s - (now_s - lease.last_beat_s)) / LATE_S))

    def lateness(self, lease_id: str, now_s: float) -> Reason:
        """Return how late the beat of that lease is, for people."""
        lease = self._leases[lease_id]
        late_s = round(min(now_s - lease.last_beat_s, 999.0), 2)
        return Reason("beat_late", {"source": lease.source, "late_s": late_s})

    def priority_of(self, lease_id: str) -> Priority:
        """Return the priority of its source; the lowest for a lease that nobody opened."""
        return priority_of(self.source_of(lease_id))

    def term_s_of(self, lease_id: str) -> float:
        """Return how long its source may be silent; 0 for a lease that nobody opened."""
        lease = self._leases.get(lease_id)
        return lease.term_s if lease is not None else 0.0

    def source_of(self, lease_id: str) -> str:
        """Return the name of its source."""
        lease = self._leases.get(lease_id)
        return lease.source if lease is not None else "unknown"


@dataclass(frozen=True)
class Handover:
    """The answer to a client that asks for command: refused with a reason, or granted, and taken from whom
    (empty: nobody was in command)."""

    refusal: Reason | None = None
    from_source: str = ""


class CommandArbiter:
    """Decides which source may move the robot now; a stop takes command from all of them."""

    def __init__(self, leases: Leases, epoch: StopEpoch) -> None:
        self._leases = leases
        self._epoch = epoch
        self._lease_id = ""
        self._taken_in = -1

    def holder(self, now_s: float) -> str:
        """Return the lease in command, empty where none is. A lapsed lease or a stop lets go."""
        held = self._taken_in == self._epoch.value and self._leases.is_valid(self._lease_id, now_s)
        return self._lease_id if held else ""

    def take(self, lease_id: str, now_s: float) -> Handover:
        """Take command for a valid lease, from nobody or from a source of lower priority."""
        holder = self.holder(now_s)
        from_source = ""
        if holder not in ("", lease_id):
            from_source = self._leases.source_of(holder)
            if self._leases.priority_of(lease_id) <= self._leases.priority_of(holder):
                return Handover(Reason("outranked", {"source": from_source}))
        self._lease_id, self._taken_in = lease_id, self._epoch.value
        return Handover(from_source=from_source)

    def leave(self, lease_id: str) -> None:
        """Let go; nothing happens where another holds it."""
        if self._lease_id == lease_id:
            self._taken_in = -1
