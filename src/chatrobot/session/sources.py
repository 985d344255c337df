"""Who speaks to Motion. Each source has a lease: opened, kept by what it says, and ended by a goodbye or a loss."""

from __future__ import annotations

from chatrobot.governor.lease import LOCAL_TERM_S, Leases
from chatrobot.session.envelope import Envelope, seconds

LONGEST_TERM_S = 1.0
"""No source may be silent for longer than this, whatever term it asks for."""


class Sources:
    """Belongs to the control thread, but for `lose`."""

    def __init__(self, leases: Leases) -> None:
        self._leases = leases
        self._leaving: set[str] = set()

    def hear(self, envelope: Envelope, now_s: float) -> None:
        """Whatever a source says keeps its lease; a hello opens it."""
        self._leases.beat(envelope.lease, now_s)
        if self.has_left(envelope.lease):
            return
        if envelope.word == "hello" or self._was_there_before_us(envelope):
            term_s = min(seconds(envelope.payload.get("term_s"), LOCAL_TERM_S), LONGEST_TERM_S)
            self._leases.open(envelope.lease, envelope.source, term_s, now_s)

    def leave(self, lease: str) -> None:
        """A goodbye: what is queued is still done, without beats."""
        self._leases.entrust(lease)
        self._leaving.add(lease)

    def lose(self, lease: str) -> None:
        """Gone without one: nothing more is done in its name. From any thread."""
        self._leases.end(lease)
        self._leaving.add(lease)

    def has_left(self, lease: str) -> bool:
        """No beat of it is waited for any more: what it says now could never lapse."""
        return lease in self._leaving

    @property
    def some_have_left(self) -> bool:
        return bool(self._leaving)

    def _was_there_before_us(self, envelope: Envelope) -> bool:
        """Its hello went by before we listened; it names its term with what it says."""
        return "term_s" in envelope.payload and not self._leases.is_known(envelope.lease)
