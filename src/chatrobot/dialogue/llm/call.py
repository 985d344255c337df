"""Calls a model in a thread of its own: its pieces wait for the pumping thread, which never waits for them.

Every call of a model goes this way, whether it plans or writes a program.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from chatrobot.core.events import ModelCalled
from chatrobot.core.reason import Reason
from chatrobot.models.seam import CallLimits, Message, Model, ModelError, Reply, Usage

CHARS_PER_TOKEN = 4


@dataclass(frozen=True)
class CallEnd:
    """End of a call: `problem` is None where the reply is whole, or the call was cancelled."""

    problem: Reason | None
    usage: Usage
    duration_s: float


class ModelCall:
    """Begins at once, and belongs to the pumping thread but for `cancel`.

    Args:
        wake: called from the call's thread when there is something to take.
    """

    def __init__(
        self, model: Model, messages: Sequence[Message], limits: CallLimits, wake: Callable[[], None]
    ) -> None:
        self.text = ""
        """All that has been taken."""
        self.end: CallEnd | None = None
        self.is_cancelled = False
        self.began_s = time.monotonic()
        self._name = model.name
        self._prompt_chars = sum(len(message.text) for message in messages)
        self._items: queue.SimpleQueue[str | Reason | None] = queue.SimpleQueue()
        self._ended_s: float | None = None
        self._wake = wake
        self._news = threading.Event()
        self._reply: Reply | None = None
        threading.Thread(
            target=self._run, args=(model, tuple(messages), limits), name="model call", daemon=True
        ).start()

    @property
    def has_ended(self) -> bool:
        """True once all that was said has been taken."""
        return self.end is not None

    @property
    def asked_at_s(self) -> float | None:
        """Return since when the model is being asked (monotonic); None once the call has ended."""
        return self.began_s if self.end is None else None

    def take(self) -> list[str]:
        """Return the pieces that have come since, without waiting; `end` is there once all are taken."""
        self._news.clear()
        pieces: list[str] = []
        while self.end is None and not self._items.empty():
            item = self._items.get_nowait()
            if isinstance(item, str):
                self.text += item
                pieces.append(item)
            else:
                self._finish(item)
        if self.is_cancelled:
            self._finish(None)  # a model that does not hear of it holds nobody up
        return pieces

    def wait(self, timeout_s: float) -> None:
        """Wait until there may be something to take."""
        self._news.wait(timeout_s)

    def cancel(self) -> None:
        """End the call, from any thread, and return at once."""
        self.is_cancelled = True
        if self._reply is not None:
            self._reply.cancel()

    def told(self, turn: int, number: int) -> ModelCalled:
        """Return what the call has used, as the event of that turn's call `number`; one under way ends here."""
        end = self._finish(None)
        usage = end.usage
        return ModelCalled(
            turn, self._name, number, usage.prompt_tokens, usage.cached_tokens, usage.reply_tokens,
            usage.cost_usd, usage.counted, end.duration_s,
        )  # fmt: skip

    def _run(self, model: Model, messages: Sequence[Message], limits: CallLimits) -> None:
        problem: Reason | None = None
        try:
            reply = self._reply = model.ask(messages, limits)
            if self.is_cancelled:
                reply.cancel()
            for piece in reply:
                if self.is_cancelled:
                    break
                self._put(piece)
        except ModelError as error:
            problem = error.reason
        except Exception as error:  # noqa: BLE001  # the outermost boundary of a thread; a provider may be anybody's
            problem = Reason("model_broken_reply", {"host": model.name, "said": type(error).__name__})
        self._ended_s = time.monotonic()
        self._put(None if self.is_cancelled else problem)

    def _put(self, item: str | Reason | None) -> None:
        self._items.put(item)
        self._news.set()
        self._wake()

    def _finish(self, problem: Reason | None) -> CallEnd:
        """Set `end`, once; what nobody counted is estimated."""
        if self.end is None:
            usage = self._reply.usage if self._reply is not None else None
            prompt, reply = (chars // CHARS_PER_TOKEN for chars in (self._prompt_chars, len(self.text)))
            usage = usage or Usage(prompt_tokens=prompt, reply_tokens=reply, counted=False)
            self.end = CallEnd(problem, usage, (self._ended_s or time.monotonic()) - self.began_s)
        return self.end
