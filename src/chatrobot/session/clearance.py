"""Whether anything may move just now, and if not, why."""

from __future__ import annotations

from chatrobot.core.reason import Reason
from chatrobot.governor.governor import Governor
from chatrobot.session.guard_link import GuardLink


class Clearance:
    """Asked before every motion and with every tick of one. Belongs to the control thread but for `obstruction`."""

    def __init__(self, governor: Governor, guard: GuardLink) -> None:
        self._governor = governor
        self._guard = guard
        self.obstruction: Reason | None = None
        """Why nothing may move for now, by those who look after the wire; any thread may set it."""

    def barrier(self) -> Reason | None:
        """Why nothing may move, whoever asks: an emergency stop, the wire, or a guard that is not there."""
        if self._governor.latched is not None:
            return self._governor.latched
        if self.obstruction is not None:
            return self.obstruction
        return None if self._guard.is_alive() else Reason("guard_lost")

    def barrier_for(self, lease: str, now_s: float) -> Reason | None:
        """Why what asks under that lease may not move."""
        barrier = self.barrier()
        if barrier is None and not self._governor.leases.is_valid(lease, now_s):
            return Reason("lease_lapsed", {"source": self._governor.leases.source_of(lease)})
        return barrier
