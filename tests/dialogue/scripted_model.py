"""A language model that says what it was told to say, in the test's own process."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from typing import Union

from tests.dialogue.talk import Talk

from chatrobot.core.events import Event, TruePose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.dialogue.options import Options
from chatrobot.models.seam import CallLimits, Message, ModelError, Usage

Line = Union[str, Reason, threading.Event, None]
"""What one reply says: text, then perhaps what goes wrong. It goes on once an event is set; None hangs for ever."""


class ScriptedReply:
    def __init__(self, lines: Sequence[Line]) -> None:
        self._lines = lines
        self._cancelled = threading.Event()
        self.usage: Usage | None = None

    def __iter__(self) -> Iterator[str]:
        text = 0
        try:
            for line in self._lines:
                if self._cancelled.is_set():
                    return
                if line is None:
                    self._cancelled.wait()
                elif isinstance(line, threading.Event):
                    while not line.wait(0.005) and not self._cancelled.is_set():
                        pass
                elif isinstance(line, Reason):
                    raise ModelError(line)
                else:
                    text += len(line)
                    yield line
        finally:
            self.usage = Usage(100, 0, text // 4)

    def cancel(self) -> None:
        self._cancelled.set()


class ScriptedModel:
    """`replies` are given one a call, the last one for ever; `asked` keeps what it was asked."""

    name = "test:scripted"

    def __init__(self, *replies: Line | Sequence[Line]) -> None:
        self._replies = [
            [reply] if isinstance(reply, (str, Reason, threading.Event)) or reply is None else reply
            for reply in replies
        ]
        self.asked: list[Sequence[Message]] = []
        self.limits: list[CallLimits] = []
        self.forgotten = 0

    def ask(self, messages: Sequence[Message], limits: CallLimits) -> ScriptedReply:
        self.asked.append(messages)
        self.limits.append(limits)
        return ScriptedReply(self._replies[min(len(self.asked), len(self._replies)) - 1])

    def forget(self) -> None:
        self.forgotten += 1

    @property
    def last(self) -> str:
        """The last message of the last call."""
        return self.asked[-1][-1].text


class ModelTalk(Talk):
    """A session with a scripted model, on simulated time, and everything it told."""

    def __init__(self, *replies: Line | Sequence[Line], **setup: object) -> None:
        self.model = ScriptedModel(*replies)
        super().__init__(**{"model": self.model, **setup})

    def pump_until_moving(self) -> None:
        self.pump_until(self.moved)

    def moved(self) -> bool:
        """The robot has moved, in truth."""
        return any(isinstance(e, TruePose) and (e.vx_mps or e.vy_mps or e.wz_radps) for e in self.events)

    def of(self, name: str) -> list[Event]:
        """The events of that name."""
        return [event for event in self.events if event.name == name]

    def codes(self) -> list[str]:
        """Of the notices."""
        return [event.reason.code for event in self.of("notice")]  # type: ignore[attr-defined]


__all__ = ["Line", "ModelOptions", "ModelTalk", "Options", "ScriptedModel"]
