"""Carries a reply from the background thread to whoever iterates over it, and keeps its time limits and `cancel`.

One thread with an event loop serves all calls of the process: no caller waits for a library. The limits are kept by the
waiting side: they hold even if that thread hangs in a name look-up.
"""

from __future__ import annotations

import asyncio
import queue
import threading
import time
from collections.abc import Callable, Coroutine, Iterator
from typing import Any

from chatrobot.core.reason import Reason
from chatrobot.models.seam import CallLimits, ModelError, Usage

STARTUP_S = 60.0
"""What loading the library and asking the keyring may take before a call's own time begins."""
CHARS_PER_TOKEN = 4

_lock = threading.Lock()
_loop: asyncio.AbstractEventLoop | None = None


def in_background(work: Coroutine[Any, Any, None], started: Callable[[asyncio.Task[None]], None]) -> None:
    """Begin `work` in the background thread; `started` is told its task there. Returns at once."""
    _background().call_soon_threadsafe(lambda: started(asyncio.ensure_future(work)))


def _background() -> asyncio.AbstractEventLoop:
    """Return the loop, started at first use. It is a daemon: a call under way holds no program up that ends."""
    global _loop
    with _lock:
        if _loop is None:
            _loop = asyncio.new_event_loop()
            threading.Thread(target=_loop.run_forever, name="models", daemon=True).start()
        return _loop


class StreamedReply:
    """`Reply` (see `seam`) that `produce` fills from the background thread.

    `prompt_chars` serves the estimate of tokens where a provider counts none; `on_end` hears the usage once, in the
    background thread.
    """

    def __init__(
        self,
        produce: Callable[[StreamedReply], Coroutine[Any, Any, None]],
        limits: CallLimits,
        *,
        prompt_chars: int = 0,
        price: Callable[[Usage], Usage] = lambda usage: usage,
        on_end: Callable[[Usage], None] = lambda _: None,
    ) -> None:
        self._produce = produce
        self._limits = limits
        self._prompt_chars = prompt_chars
        self._price = price
        self._on_end = on_end
        self._items: queue.Queue[str | ModelError | None] = queue.Queue()
        self._asked_s = time.monotonic()
        self._began_s: float | None = None
        self._has_piece = False
        self._chars = 0
        self._usage: Usage | None = None
        self._ended = self._cancelled = False
        self._task: asyncio.Task[None] | None = None
        in_background(self._run(), self._keep)

    @property
    def usage(self) -> Usage | None:
        """Return what the call used, once it has ended; an estimate where the provider did not count."""
        if not self._ended:
            return None
        return self._usage or (self._estimate() if self._began_s is not None else Usage(counted=False))

    def __iter__(self) -> Iterator[str]:
        """Yield the pieces as they arrive; see `seam.Reply`."""
        try:
            while (item := self._next()) is not None:
                if isinstance(item, ModelError):
                    raise item
                self._has_piece = True
                yield item
        finally:
            self.cancel()

    def cancel(self) -> None:
        """End the call now, from any thread; the iteration ends without an error."""
        if self._cancelled:
            return
        self._cancelled = True
        self._items.put(None)
        if not self._ended:
            self._ended = True
            _background().call_soon_threadsafe(self._end_task)

    def _next(self) -> str | ModelError | None:
        if self._cancelled:
            return None
        while True:
            try:
                item = self._items.get(timeout=max(0.0, self._deadline_s() - time.monotonic()))
            except queue.Empty:
                if time.monotonic() < self._deadline_s():
                    continue  # the request went out while we waited, and its own time counts now
                return self._too_late()
            if item == "":
                continue
            return None if self._cancelled else item

    def _deadline_s(self) -> float:
        if self._began_s is None:
            return self._asked_s + STARTUP_S
        total_s = self._began_s + self._limits.total_s
        return total_s if self._has_piece else min(total_s, self._began_s + self._limits.first_piece_s)

    def _too_late(self) -> ModelError:
        limits, code = self._limits, "model_timeout"
        limit_s = STARTUP_S if self._began_s is None else limits.total_s
        if self._began_s is not None and not self._has_piece and limits.first_piece_s < limits.total_s:
            code, limit_s = "model_first_piece_timeout", limits.first_piece_s
        return ModelError(Reason(code, {"limit_s": limit_s}))

    def _keep(self, task: asyncio.Task[None]) -> None:
        self._task = task
        self._end_task()

    def _end_task(self) -> None:
        if self._task is not None and self._cancelled:
            self._task.cancel()

    async def _run(self) -> None:
        # For whatever else should be raised:
        end: ModelError | None = ModelError(Reason("model_broken_reply", {"host": "?", "said": "?"}))
        try:
            await self._produce(self)
            end = None
        except ModelError as error:
            end = error
        except asyncio.CancelledError:  # a call that was given up has used tokens, too
            end = None
            raise
        finally:
            was_answered = end is None or self._chars > 0 or self._usage is not None
            self._usage = self._usage or (self._estimate() if was_answered else Usage())
            if self._began_s is not None and was_answered:
                self._on_end(self._usage)
            self._ended = True
            self._items.put(end)

    # What `produce` puts in, in the background thread.

    def begin(self) -> None:
        """Begin the call's own time: its first request goes out now."""
        if self._began_s is None:
            self._began_s = time.monotonic()
            self._items.put("")  # wakes the waiting side, whose time limit has changed

    def put(self, piece: str) -> None:
        """Take one piece of text.

        Raises:
            ModelError: the reply is longer than allowed.
        """
        room = self._limits.reply_chars - self._chars
        self._chars += len(piece)
        if piece and room > 0:
            self._items.put(piece[:room])
        if self._chars > self._limits.reply_chars:
            raise ModelError(Reason("model_too_long", {"limit_chars": self._limits.reply_chars}))

    def count(self, usage: Usage) -> None:
        """Take what the provider says the call has used."""
        self._usage = self._price(usage)

    def _estimate(self) -> Usage:
        prompt, reply = (-(-chars // CHARS_PER_TOKEN) for chars in (self._prompt_chars, self._chars))
        return self._price(Usage(prompt_tokens=prompt, reply_tokens=reply, counted=False))
