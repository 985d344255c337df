"""asyncio without a socket: the sandbox has none, on virtual time or live. The loop waits on an event instead."""

from __future__ import annotations

import asyncio
import selectors
import threading
import warnings
from typing import Any, cast


class _EventSelector(selectors.BaseSelector):
    """A selector with nothing to select: it waits for its time or for `wake`."""

    def __init__(self) -> None:
        self._event = threading.Event()

    def wake(self) -> None:
        self._event.set()

    def register(self, fileobj: Any, _events: int, _data: Any = None) -> selectors.SelectorKey:
        raise OSError(f"there is nothing to wait for in the sandbox: {fileobj!r}")

    def unregister(self, fileobj: Any) -> selectors.SelectorKey:
        raise KeyError(fileobj)

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is None or timeout > 0:
            self._event.wait(timeout)
        self._event.clear()
        return []

    def get_map(self) -> dict[Any, selectors.SelectorKey]:
        return {}


class _SandboxedEventLoop(asyncio.SelectorEventLoop):
    """Woken by its selector, not by a pair of sockets."""

    def __init__(self) -> None:
        super().__init__(_EventSelector())

    def _make_self_pipe(self) -> None:
        self._ssock = self._csock = None

    def _close_self_pipe(self) -> None:
        self._ssock = self._csock = None

    def _write_to_self(self) -> None:
        cast(Any, self)._selector.wake()

    def _process_events(self, event_list: Any) -> None:
        """There are none."""


def install() -> None:
    """Have every loop that the program asks for be one of ours."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # policies go with Python 3.16, and so will this
        policy = asyncio.get_event_loop_policy()
    cast(Any, type(policy))._loop_factory = _SandboxedEventLoop
    cast(Any, asyncio).SelectorEventLoop = _SandboxedEventLoop
