"""One call of a model in a thread of its own: its pieces wait for the pumping thread, which never waits for them."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Union

from chatrobot.core.reason import Reason
from chatrobot.models.seam import CallLimits, Message, Model, ModelError, Reply, Usage


@dataclass(frozen=True)
class CallEnd:
    """How a call ended: `problem` is None where the reply is whole (or we have cancelled it)."""

    problem: Reason | None
    usage: Usage
    duration_s: float


Item = Union[str, CallEnd]


def estimated(messages: Sequence[Message], reply: str = "") -> Usage:
    """What a call has used where nobody counted: a token for four characters."""
    prompt = sum(len(message.text) for message in messages) // 4
    return Usage(prompt_tokens=prompt, reply_tokens=len(reply) // 4, counted=False)


class ModelCall:
    """Begins at once. `take` gives what has come since; `cancel` may be called from any thread.

    Args:
        wake: called from the call's thread when there is something to take.
    """

    def __init__(
        self, model: Model, messages: Sequence[Message], limits: CallLimits, wake: Callable[[], None]
    ) -> None:
        self._items: queue.SimpleQueue[Item] = queue.SimpleQueue()
        self._wake = wake
        self._news = threading.Event()
        self._reply: Reply | None = None
        self._is_cancelled = False
        self.began_s = time.monotonic()
        self.has_spoken = False
        self.has_ended = False
        self._estimate = estimated(messages)
        threading.Thread(
            target=self._run, args=(model, tuple(messages), limits), name="model call", daemon=True
        ).start()

    def take(self) -> list[Item]:
        """What has come; never waits. Nothing more comes after a `CallEnd`."""
        self._news.clear()
        items: list[Item] = []
        while not self.has_ended:
            try:
                item = self._items.get_nowait()
            except queue.Empty:
                break
            self.has_spoken = self.has_spoken or isinstance(item, str)
            self.has_ended = isinstance(item, CallEnd)
            items.append(item)
        return items

    def wait(self, timeout_s: float) -> None:
        """Until there may be something to take."""
        self._news.wait(timeout_s)

    def cancel(self) -> None:
        """End the call. Returns at once; what it says after this is not taken any more."""
        self._is_cancelled = True
        reply = self._reply
        if reply is not None:
            reply.cancel()

    def _run(self, model: Model, messages: Sequence[Message], limits: CallLimits) -> None:
        problem: Reason | None = None
        reply: Reply | None = None
        try:
            reply = self._reply = model.ask(messages, limits)
            if self._is_cancelled:
                reply.cancel()
            for piece in reply:
                if self._is_cancelled:
                    break
                self._put(piece)
        except ModelError as error:
            problem = error.reason
        except Exception as error:  # noqa: BLE001  # the outermost boundary of a thread; a provider may be anybody's
            problem = Reason("model_broken_reply", {"host": model.name, "said": type(error).__name__})
        usage = (reply.usage if reply is not None else None) or self._estimate
        took_s = time.monotonic() - self.began_s
        self._put(CallEnd(None if self._is_cancelled else problem, usage, took_s))

    def _put(self, item: Item) -> None:
        self._items.put(item)
        self._news.set()
        self._wake()
