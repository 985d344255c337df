"""What a session holds of Motion: envelopes one way, events the other. Three carriers, one contract suite.

Several clients may share one Motion, each on a line of its own that keeps their turns apart (`ClientLine`).
"""

from __future__ import annotations

import itertools
import math
import queue
import uuid
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

from chatrobot.core.events import Event, Limited, Notice, Ordered, Remembered, Scan, Telemetry
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Priority, priority_of
from chatrobot.link.envelope import PROTOCOL, Envelope, Word


class MotionLink(Protocol):
    """A session's end of the way to Motion. `send` may be called from any thread.

    `beats` is true while the source keeps its lease; a source that is to be taken for frozen sets it to false.
    """

    beats: bool = True
    is_simulated: bool = False
    """Time passes only while somebody waits for an event."""
    age_s: Callable[[], float] = staticmethod(lambda: 0.0)
    """How long ago whoever gives the orders was heard, where that is somebody else than this process: beats carry it,
    so that Motion slows and stops the robot for a person who is gone as it does for a process that is."""
    is_lost: bool = False
    """Motion is gone, and we did not ask it to go."""

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        """Say one word.

        Raises:
            LinkError: Motion is gone.
        """
        ...

    def next_event(self, timeout_s: float) -> Event | None:
        """The next event, waiting up to `timeout_s` (of simulated time where time is simulated)."""
        ...

    def wake(self) -> None:
        """Have a waiting `next_event` return None at once."""
        ...

    def close(self) -> None:
        """Say goodbye, let what is queued be done, and end. Closing twice does no harm."""
        ...


class SecondLinks(Protocol):
    """A link that makes room for another client."""

    def second(self, source: str) -> MotionLink:
        """Return a link of another client, an agent, to the same Motion.

        Raises:
            LinkError: there was one already, or Motion is gone.
        """
        ...


class Sender:
    """Makes the envelopes of one source."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.lease = uuid.uuid4().hex
        self._sequence = itertools.count(1)

    def envelope(self, word: Word, turn: int = 0, **payload: Any) -> Envelope:
        """Make the next envelope; one that may open the lease says which protocol we speak."""
        if word == "hello" or "term_s" in payload:
            payload["protocol"] = PROTOCOL
        return Envelope(word, self.source, self.lease, next(self._sequence), turn, payload)


class EventQueue:
    """Events in order, from any thread; a link is one of these that knows where they come from."""

    def __init__(self) -> None:
        # Not a SimpleQueue: where a signal comes in the last moment of its timeout, it waits for ever.
        self._events: queue.Queue[Event | None] = queue.Queue()

    def next_event(self, timeout_s: float) -> Event | None:
        """The next event; None after so long, or when `wake` was called."""
        try:
            return self._events.get(timeout=timeout_s)
        except queue.Empty:
            return None

    def wake(self) -> None:
        """End a wait for an event now; from any thread."""
        self._events.put(None)


LAPSES_AFTER_S = 30.0
LAPSES_AFTER_M = 0.05
LAPSES_AFTER_RAD = math.radians(5.0)
"""Over a metre it is the same as 9 cm aside; a gyro at rest drifts far less."""


@dataclass(frozen=True)
class Approval:
    """A question that a yes would answer: when it was asked, and from where."""

    asked_s: float
    start: Pose

    def lapsed(self, now_s: float, pose: Pose) -> Reason | None:
        """Return why a yes is worth nothing any more, or None."""
        if now_s - self.asked_s > LAPSES_AFTER_S:
            return Reason("approval_too_late", {"limit_s": LAPSES_AFTER_S})
        if pose.distance_to(self.start) > LAPSES_AFTER_M:
            return Reason("approval_robot_moved", {"limit_m": LAPSES_AFTER_M})
        if abs(pose.yaw_rad - self.start.yaw_rad) > LAPSES_AFTER_RAD:
            return Reason("approval_robot_moved", {"limit_deg": round(math.degrees(LAPSES_AFTER_RAD))})
        return None


TURNS = 1_000_000
"""Each client counts its turns from 1. Inside Motion, and for the first client, the turns of line `n` begin at
`n * TURNS`: so no number means two turns, and the first client, a person, can show and answer what the others ask for.
"""
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
