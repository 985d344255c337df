"""Who may command the robot: clients that speak by envelopes, under leases that they keep."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import islice

from chatrobot.core.clock import LOCAL_TERM_S
from chatrobot.core.process import watch_process
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Leases
from chatrobot.link.envelope import PROTOCOL, Envelope, other_protocol, protocol_of, seconds

LONGEST_TERM_S = 1.0
"""No source may be silent for longer than this, whatever term it asks for."""
MANY_SOURCES = 256
"""With more the longest-silent that are gone are forgotten."""
MOST_SOURCES = 4 * MANY_SOURCES
"""So many that are there at once are a flood: no further one may move the robot. A stop needs no lease."""
_LOOKED_AT = 32
"""So many of the longest-silent are looked at: where none of them is gone, hardly any is."""


class Clients:
    """Keeps the leases of those who speak to Motion. Belongs to the control thread, but for `lose`.

    Args:
        is_engaged: whether something is driven or waits in that lease's name; such a one is never forgotten.
        forget: hears of each lease that is.
    """

    def __init__(
        self, leases: Leases, is_engaged: Callable[[str], bool], forget: Callable[[str], None]
    ) -> None:
        self._leases = leases
        self._is_engaged = is_engaged
        self._forget = forget
        self._known: dict[str, None] = {}
        self._leaving: set[str] = set()
        self._strangers: dict[str, int] = {}
        """The protocol of each lease whose half speaks another than we do."""

    def note(self, lease: str, now_s: float) -> None:
        """Note that something came in its name. With one too many, forget those that are gone."""
        is_new = lease not in self._known
        self._known.pop(lease, None)
        if is_new and len(self._known) >= MANY_SOURCES:
            self._make_room(now_s)
        self._known[lease] = None  # the longest-silent stand first

    def _make_room(self, now_s: float) -> None:
        gone = [one for one in islice(self._known, _LOOKED_AT) if self._is_gone(one, now_s)]
        if not gone and len(self._known) >= MOST_SOURCES:
            gone = [next(one for one in self._known if not self._is_engaged(one))]
        for lease in gone:
            del self._known[lease]
            self._strangers.pop(lease, None)
            if lease in self._leaving:
                self._leases.end(lease)  # it was entrusted with what it had said, and that is done
                self._leaving.discard(lease)
            self._forget(lease)
        if len(self._leaving) > MOST_SOURCES:  # lost after they had been forgotten; their leases have ended
            self._leaving.intersection_update(self._known)

    def _is_gone(self, lease: str, now_s: float) -> bool:
        is_there = lease not in self._leaving and self._leases.is_valid(lease, now_s)
        return not is_there and not self._is_engaged(lease)

    def hear(self, envelope: Envelope, now_s: float) -> None:
        """Keep the lease of whoever says something; a hello opens it.

        Args:
            now_s: when the envelope came.
        """
        self._leases.beat(envelope.lease, now_s - seconds(envelope.payload.get("age_s", 0.0), math.inf))
        if self.has_left(envelope.lease):
            return
        if len(self._known) >= MOST_SOURCES and not self._leases.is_known(envelope.lease):
            return
        if envelope.word == "hello" or self._was_there_before_us(envelope):
            term_s = min(seconds(envelope.payload.get("term_s"), LOCAL_TERM_S), LONGEST_TERM_S)
            self._strangers.pop(envelope.lease, None)
            if (protocol := protocol_of(envelope.payload)) != PROTOCOL:
                self._strangers[envelope.lease] = protocol
            is_stopped = watch_process(str(envelope.payload.get("process", "")))
            self._leases.open(envelope.lease, envelope.source, term_s, now_s, is_stopped)

    def leave(self, lease: str) -> None:
        """Take a goodbye: what is queued is still done, without beats."""
        self._leases.entrust(lease)
        self._leaving.add(lease)

    def lose(self, lease: str) -> None:
        """Do nothing more in the name of a source that is gone without a goodbye. From any thread."""
        self._leases.end(lease)
        self._leaving.add(lease)

    def has_left(self, lease: str) -> bool:
        """Return whether no beat of it is waited for any more: what it says now could never lapse."""
        return lease in self._leaving

    def refusal(self, envelope: Envelope) -> Reason | None:
        """Say why nothing is driven for that source: it has left, or its half misunderstands ours. Stops are heeded."""
        if self.has_left(envelope.lease):
            return Reason("lease_lapsed", {"source": envelope.source})
        protocol = self._strangers.get(envelope.lease, PROTOCOL)
        return None if protocol == PROTOCOL else other_protocol(motion=PROTOCOL, dialogue=protocol)

    def _was_there_before_us(self, envelope: Envelope) -> bool:
        """Its hello went by before we listened; it names its term with what it says."""
        return "term_s" in envelope.payload and not self._leases.is_known(envelope.lease)
