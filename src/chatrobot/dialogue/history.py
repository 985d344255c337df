"""What was said and done before, as messages for a model: the last turns, and one line about those before them.

It is bounded, and shortened by half at a time, so that a provider's cache hits for many turns in a row.
"""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.core.reason import one_line
from chatrobot.models.seam import Message

BUDGET_CHARS = 2400
"""About 600 tokens of earlier turns in a prompt."""

SUMMARY_CHARS = 240
ANSWER_CHARS = 800


@dataclass(frozen=True)
class Exchange:
    """One turn. `request` is the message as the model got it, empty where it was not asked; `answer` is its reply or
    the plan that was understood without it; `end` is what became of it."""

    text: str
    answer: str
    end: str
    request: str = ""

    @property
    def chars(self) -> int:
        return len(self.request or self.text) + len(self.answer) + len(self.end)


class History:
    """The exchanges of one conversation. `pinned` ones stay whatever happens (the tutorial's first instruction)."""

    def __init__(self) -> None:
        self._pinned: list[Exchange] = []
        self._kept: list[Exchange] = []
        self._forgotten: list[str] = []
        self._count = 0

    def add(self, exchange: Exchange, *, pin: bool = False) -> None:
        (self._pinned if pin else self._kept).append(exchange)
        if sum(kept.chars for kept in self._kept) > BUDGET_CHARS:
            while len(self._kept) > 1 and sum(kept.chars for kept in self._kept) > BUDGET_CHARS / 2:
                self._forget(self._kept.pop(0))

    def _forget(self, exchange: Exchange) -> None:
        self._count += 1
        self._forgotten.append(f"{one_line(exchange.text, 40)} ({one_line(exchange.end, 40)})")
        while len("; ".join(self._forgotten)) > SUMMARY_CHARS:
            self._forgotten.pop(0)

    def messages(self) -> tuple[list[Message], list[str]]:
        """Earlier messages, and the news since the model last spoke, a line each, for the next one."""
        messages: list[Message] = []
        news = (
            [f"data: {self._count} earlier turns, the last: {'; '.join(self._forgotten)}"]
            if self._count
            else []
        )
        for exchange in (*self._pinned, *self._kept):
            if exchange.request:
                messages.append(Message("user", "\n".join([*news, exchange.request])))
                messages.append(Message("assistant", exchange.answer[:ANSWER_CHARS] or "# nothing"))
                news = [f"data: that ended: {one_line(exchange.end, 200)}"] if exchange.end else []
            else:
                said, did = one_line(exchange.text, 120), one_line(exchange.answer, 160)
                news.append(f"data: understood without you: {said} → {did}: {one_line(exchange.end, 160)}")
        return messages, news
