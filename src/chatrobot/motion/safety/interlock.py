"""Allows motion, or says why nothing may move: emergency stop, wire, guard, lease."""

from __future__ import annotations

from chatrobot.core.process import is_machine_busy
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import Governor
from chatrobot.motion.safety.watchdog import GuardLink


class Interlock:
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
        barrier, leases = self.barrier(), self._governor.leases
        if barrier is not None:
            return barrier
        is_late = leases.is_late(lease, now_s)
        is_stopped = is_late and leases.is_stopped(lease)
        if leases.is_valid(lease, now_s) and not is_stopped:
            return None
        if is_late and not is_stopped and is_machine_busy():
            return leases.lateness(lease, now_s)
        return Reason("lease_lapsed", {"source": leases.source_of(lease)})
