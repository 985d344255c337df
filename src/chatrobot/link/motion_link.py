"""What a session holds of Motion: envelopes one way, events the other. Three carriers, one contract suite."""

from __future__ import annotations

import itertools
import math
import queue
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from chatrobot.core.events import Event
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
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

    def abandon(self) -> None:
        """Leave without a goodbye, as a crash would: Motion stops the robot at once."""
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
