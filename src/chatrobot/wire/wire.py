"""The contract of a wire: publish and subscribe by topic. Every backend runs one contract suite (tests/wire)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from chatrobot.wire.messages import Message

M = TypeVar("M", bound=Message)


class Wire(Protocol):
    """One process's end of a wire.

    Topics are relative names without a leading slash (`cmd_vel`). Nothing blocks: a message for a receiver that
    does not read is dropped, the rest stays in order. A sender that listens hears itself. Callbacks come on a
    thread of the backend (the memory wire: the publisher's) and must return at once.
    """

    def publish(self, topic: str, message: Message) -> None:
        """Send to all who listen.

        Raises:
            WireError: the wire is closed or its other end is gone.
        """
        ...

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        """Call `callback` for each message of type `kind` on `topic`; others on it are dropped."""
        ...

    def close(self) -> None:
        """Leave. Closing twice does no harm."""
        ...
