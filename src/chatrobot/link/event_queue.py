"""What a link hears from Motion, on its way to the thread that pumps."""

from __future__ import annotations

import queue

from chatrobot.core.events import Event


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
