"""One thread with an event loop for all calls of the process: callers are never made to wait by a library."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from typing import Any

_lock = threading.Lock()
_loop: asyncio.AbstractEventLoop | None = None


def loop() -> asyncio.AbstractEventLoop:
    """The loop, started at first use. It is a daemon: a call under way holds no program up that ends."""
    global _loop
    with _lock:
        if _loop is None:
            _loop = asyncio.new_event_loop()
            threading.Thread(target=_loop.run_forever, name="models", daemon=True).start()
        return _loop


def start(work: Coroutine[Any, Any, None], started: Callable[[asyncio.Task[None]], None]) -> None:
    """Begin `work` in the background; `started` is told its task there. Returns at once."""

    def begin() -> None:
        started(asyncio.ensure_future(work))

    loop().call_soon_threadsafe(begin)


def soon(call: Callable[[], object]) -> None:
    """Have it called in the background thread."""
    loop().call_soon_threadsafe(call)
