"""Decides which client commands the robot: one at a time, by priority; a stop takes command from all of them."""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Leases


@dataclass(frozen=True)
class Handover:
    """The answer to a client that asks for command: refused with a reason, or granted, and taken from whom
    (empty: nobody was in command)."""

    refusal: Reason | None = None
    from_source: str = ""


class CommandArbiter:
    """Who may move the robot now."""

    def __init__(self, leases: Leases, epoch: StopEpoch) -> None:
        self._leases = leases
        self._epoch = epoch
        self._lease_id = ""
        self._taken_in = -1

    def holder(self, now_s: float) -> str:
        """The lease that holds it, empty where none does. A lapsed lease or a stop lets go."""
        held = self._taken_in == self._epoch.value and self._leases.is_valid(self._lease_id, now_s)
        return self._lease_id if held else ""

    def take(self, lease_id: str, now_s: float) -> Handover:
        """Take it for a valid lease, from nobody or from a source of lower priority."""
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
