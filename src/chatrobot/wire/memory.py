"""A wire within one process: publishing calls the subscribers at once, in order, on the publisher's thread."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import WireError
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import M, Wire


class MemoryHub:
    """What the ends of one in-process wire share."""

    def __init__(self) -> None:
        self.subscribers: dict[str, list[tuple[MemoryWire, type, Callable[[Any], None]]]] = {}

    def connect(self) -> MemoryWire:
        """Make another end of this wire."""
        return MemoryWire(self)


class MemoryWire(Wire):
    """One end of a `MemoryHub`."""

    def __init__(self, hub: MemoryHub) -> None:
        self._hub = hub
        self._closed = False

    def publish(self, topic: str, message: Message) -> None:
        if self._closed:
            raise WireError("this end of the wire is closed")
        # A copy: a callback may subscribe or close while it is being called.
        for wire, kind, callback in tuple(self._hub.subscribers.get(topic, ())):
            if type(message) is kind and not wire._closed:
                callback(message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        if self._closed:
            raise WireError("this end of the wire is closed")
        self._hub.subscribers.setdefault(topic, []).append((self, kind, callback))

    def close(self) -> None:
        self._closed = True
        for entries in self._hub.subscribers.values():
            entries[:] = [entry for entry in entries if entry[0] is not self]
