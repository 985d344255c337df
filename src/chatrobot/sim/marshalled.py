"""A wire whose callbacks come on the physics thread, for wires that deliver on threads of their own."""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import WireError
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import M, Wire


class MarshalledWire(Wire):
    """One end of `wire` that delivers in `poll` alone, as a `LocalHub` does.

    Args:
        after_publishing: called with each message that has been published.
    """

    def __init__(
        self, wire: Wire, after_publishing: Callable[[str, Message], None] = lambda _topic, _message: None
    ) -> None:
        self._wire = wire
        self._after_publishing = after_publishing
        # Not a SimpleQueue: where a signal comes in the last moment of its timeout, it waits for ever.
        self._waiting: queue.Queue[tuple[Callable[[Any], None], Any]] = queue.Queue()

    def publish(self, topic: str, message: Message) -> None:
        with contextlib.suppress(WireError):  # a robot lives on while its network is gone
            self._wire.publish(topic, message)
            self._after_publishing(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        self._wire.subscribe(topic, kind, lambda message: self._waiting.put((callback, message)))

    def poll(self, timeout_s: float) -> None:
        """Wait up to `timeout_s` for a message and deliver all that are there."""
        try:
            callback, message = self._waiting.get(timeout=max(0.0, timeout_s))
            while True:
                callback(message)
                callback, message = self._waiting.get_nowait()
        except queue.Empty:
            return

    def close(self) -> None:
        self._wire.close()
