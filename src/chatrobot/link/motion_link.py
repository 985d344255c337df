"""The link between the two halves: envelopes one way, events the other. Three carriers, one contract suite."""

from __future__ import annotations

import itertools
import queue
import uuid
from typing import Any, Protocol

from chatrobot.core.events import Event
from chatrobot.link.envelope import PROTOCOL, Envelope, Word


class MotionLink(Protocol):
    """What a session holds of Motion. `send` may be called from any thread.

    `beats` is true while the source keeps its lease; a source that is to be taken for frozen sets it to false.
    """

    beats: bool
    is_simulated: bool
    """Time passes only while somebody waits for an event."""

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

    @property
    def is_lost(self) -> bool:
        """Motion is gone, and we did not ask it to go."""
        ...

    def abandon(self) -> None:
        """Leave without a goodbye, as a crash would: Motion stops the robot at once."""
        ...

    def close(self) -> None:
        """Say goodbye, let what is queued be done, and end. Closing twice does no harm."""
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
