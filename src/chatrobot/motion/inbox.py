"""What is to be done on the control thread with its next tick, and what is fetched for it from elsewhere."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


class Inbox:
    """`post` may be called from any thread; the rest belongs to the control thread.

    Args:
        background: runs a function off the control thread; a simulation runs it at once.
    """

    def __init__(self, background: Callable[[Callable[[], None]], None]) -> None:
        self._background = background
        self._actions: deque[Callable[[], None]] = deque()

    def post(self, action: Callable[[], None]) -> None:
        """Have `action` done with the next tick."""
        self._actions.append(action)

    def fetch(self, work: Callable[[], T], take: Callable[[T], None]) -> None:
        """Have `work` done off the control thread; what it gives is taken on it, with a tick to come."""

        def run() -> None:
            result = work()
            self.post(lambda: take(result))

        self._background(run)

    def take(self) -> Callable[[], None] | None:
        """The next action, None where there is none."""
        return self._actions.popleft() if self._actions else None

    def __bool__(self) -> bool:
        return bool(self._actions)
