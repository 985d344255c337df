"""Several clients on one Motion, each on a line of its own: whose turns are whose, and who hears of what.

Each client counts its turns from 1. Inside Motion, and for the first client, the turns of line `n` begin at
`n * TURNS`: so no number means two turns, and the first client, a person, can show and answer what the others ask for.
"""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.events import Event, Limited, Notice, Ordered, Remembered, Scan, Telemetry
from chatrobot.governor.lease import Priority, priority_of
from chatrobot.link.envelope import Envelope

TURNS = 1_000_000
COMMON = (Notice, Telemetry, Remembered)
"""Heard by everybody, as belonging to no turn where the turn is another's."""
_STOPS = ("stop", "emergency_stop")
_ORDERS = ("plan", "program")


class ClientLine:
    """The line of one client. Line 0 is a person's, who hears all; on the others nobody speaks as a person.

    Args:
        number: which line it is, from 0.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self._first = number * TURNS
        self._watches_scans = False

    @property
    def is_persons(self) -> bool:
        """True for the line that hears and answers what others ask for."""
        return self._number == 0

    def inward(self, envelope: Envelope) -> Envelope | None:
        """Return what Motion hears; None for what may not be said on this line. A stop is heard in any case."""
        is_stop, turn = envelope.word in _STOPS, envelope.turn
        if envelope.word == "watch":
            self._watches_scans = envelope.payload.get("scans") is True
        if self.is_persons:
            return envelope if envelope.word not in _ORDERS or turn < TURNS else None
        is_a_persons = priority_of(envelope.source) >= Priority.PLAN
        if not is_stop and (is_a_persons or not 0 <= turn < TURNS):
            return None
        return replace(envelope, turn=self._first + min(max(turn, 0), TURNS - 1))

    def outward(self, event: Event) -> Event | None:
        """Return what this client hears of an event; None where it is none of its business."""
        if isinstance(event, Scan) and not self._watches_scans:
            return None
        if self.is_persons:
            return event
        turn = event.turn - self._first
        if 0 <= turn < TURNS:
            return replace(event, turn=turn)
        if event.turn == 0:
            return event if not isinstance(event, Limited) else None
        return replace(event, turn=0) if isinstance(event, COMMON) else None

    def ordered(self, envelope: Envelope) -> Ordered | None:
        """Return what a person is told of an order that came on this line (as `inward` made it)."""
        payload = envelope.payload
        if self.is_persons or envelope.word not in _ORDERS or payload.get("mode") == "extend":
            return None
        return Ordered(
            envelope.turn,
            envelope.source,
            str(payload.get("plan_text", "")),
            str(payload.get("name", "")),
            bool(payload.get("rehearse_only")),
        )
