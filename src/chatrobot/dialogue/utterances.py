"""Queues utterances that have not been taken up yet, in order; a stop makes void what was said before it."""

from __future__ import annotations

import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Literal, NamedTuple

from chatrobot.core.reason import Reason
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.link.envelope import QUEUE_LIMIT

Kind = Literal[
    "text", "plan", "edited_plan", "program", "draft", "source", "stop", "emergency_stop", "pause", "resume",
    "too_many",
]  # fmt: skip
INSTRUCTIONS: tuple[Kind, ...] = ("text", "plan", "edited_plan", "program", "draft", "source")
"""What may have to wait, and what a stop clears; the others are answered at once."""


@dataclass(frozen=True)
class Utterance:
    """One text. `at_s` is when it was said (monotonic), `about` a program that is there, the name of one to be, what a
    person made of the source of the one that `text` names, or the plan that `text` was made of."""

    turn: int
    text: str
    kind: Kind
    at_s: float
    about: Draft | str = ""

    @property
    def is_instruction(self) -> bool:
        return self.kind in INSTRUCTIONS


class _Hold(NamedTuple):
    """`turn` is the last that was said before that pause; `keeps_unbegun`: nothing was under way then, so that what
    waits is itself what is paused."""

    number: int
    turn: int
    keeps_unbegun: bool = False


class UtteranceQueue:
    """`add`, `void` and `hold` may be called from any thread; the rest belongs to the thread that pumps."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._texts: deque[Utterance] = deque()
        self._turns = 0
        self._void_turn = self._dropped_turn = 0
        self._hold = self._released = _Hold(0, 0)
        self.stopped_by = Reason("cause_unknown")
        """The last stop."""
        self._dropped_by = Reason("cause_unknown")
        self._gone_on_turn = 0

    def add(self, text: str, kind: Kind, about: Draft | str = "", *, is_moving: bool) -> int:
        """Take in a text; the number of its turn. Where too many wait for a moving robot it is one too many."""
        with self._lock:
            self._turns += 1
            if kind in INSTRUCTIONS and is_moving and self._count_waiting() >= QUEUE_LIMIT:
                kind = "too_many"
            self._texts.append(Utterance(self._turns, text, kind, time.monotonic(), about))
            return self._turns

    def void(self, why: str) -> int:
        """A stop, and why: what was said up to now is void; the last turn of it. No lock: a stop waits for nothing."""
        self.stopped_by = Reason("stopped_by", {"why": why})
        self._void_turn = self._turns
        return self._void_turn

    def hold(self, *, is_under_way: bool) -> None:
        """A pause: what was said up to now and waits goes on waiting. No lock: it waits for nothing.

        Args:
            is_under_way: something is driven or thought about, which is what is paused.
        """
        self._hold = _Hold(self._hold.number + 1, self._turns, not is_under_way)

    @property
    def pauses(self) -> int:
        """How many pauses there were."""
        return self._hold.number

    @property
    def is_holding(self) -> bool:
        """There was a pause, and what was said before it has neither been released nor dropped."""
        return self._hold is not self._released

    @property
    def is_unbegun_held(self) -> bool:
        """Something waits behind a pause for a word, not for a plan that is paused."""
        return self.is_holding and self._hold.keeps_unbegun and bool(self.held)

    @property
    def held(self) -> tuple[Utterance, ...]:
        """What waits behind the pause, oldest first."""
        return tuple(
            utterance for utterance in self.waiting if self.is_held(utterance) and not self.is_void(utterance)
        )

    def is_held(self, utterance: Utterance) -> bool:
        """It waits behind what is paused."""
        return utterance.is_instruction and self.is_holding and utterance.turn <= self._hold.turn

    def release(self) -> None:
        """What was paused is gone on with: what waits behind it waits its turn again."""
        self._released = self._hold
        self._gone_on_turn = self._hold.turn

    def drop_held(self, why: Reason) -> None:
        """What was paused is not gone on with, for that reason: what waits behind it is not done."""
        hold = self._hold
        self._dropped_by = why
        self._dropped_turn, self._released = hold.turn, hold

    def is_void_turn(self, turn: int) -> bool:
        """A stop came after that turn was said."""
        return turn <= max(self._void_turn, self._dropped_turn)

    def why_void(self, turn: int) -> Reason:
        """Why that turn, which is void, is not done."""
        return self.stopped_by if turn <= self._void_turn else self._dropped_by

    def waited_behind_pause(self, turn: int) -> bool:
        """That turn was said before a pause that was not gone on with."""
        return self._gone_on_turn < turn <= self._hold.turn

    def is_void(self, utterance: Utterance) -> bool:
        """A stop came after it was said; what is no instruction is answered all the same."""
        return utterance.is_instruction and self.is_void_turn(utterance.turn)

    @property
    def waiting(self) -> tuple[Utterance, ...]:
        """Oldest first."""
        return tuple(self._texts)

    def take(self, utterance: Utterance) -> Utterance | None:
        """It waits no longer; None where a pause came in the same moment, so that it does."""
        if self.is_held(utterance) and not self.is_void(utterance):
            return None
        with self._lock:
            self._texts.remove(utterance)
        return utterance

    def put_back(self, utterance: Utterance) -> None:
        """It waits again, before all others."""
        with self._lock:
            self._texts.appendleft(utterance)

    def take_too_many(self) -> list[Utterance]:
        """Those that may not even wait."""
        return [
            utterance for utterance in self.waiting if utterance.kind == "too_many" and self.take(utterance)
        ]

    def _count_waiting(self) -> int:
        return sum(utterance.is_instruction and not self.is_void(utterance) for utterance in self._texts)
