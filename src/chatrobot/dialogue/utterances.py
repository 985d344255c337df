"""Queues utterances that have not been taken up yet, and finds the one to take next.

A stop makes void what was said before it. Most texts wait for what runs, is thought about or is paused.
"""

from __future__ import annotations

import math
import re
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from chatrobot.core.events import Event, Finished
from chatrobot.core.reason import Reason
from chatrobot.dialogue.goal_client import RequestLog
from chatrobot.dialogue.llm.requests import ModelRequests
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring, NotWrittenError
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.while_driving import WhileDriving
from chatrobot.language.consent import read_consent
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.program_request import read_request
from chatrobot.link.envelope import MOST_CHARACTERS, QUEUE_LIMIT, STOP_COMMAND, STOP_TOPIC
from chatrobot.plan.steps import Remember, Step

Kind = Literal[
    "text", "plan", "edited_plan", "program", "draft", "source", "stop", "emergency_stop", "pause", "resume",
    "too_many",
]  # fmt: skip
INSTRUCTIONS: tuple[Kind, ...] = ("text", "plan", "edited_plan", "program", "draft", "source")
"""What may have to wait, and what a stop clears; the others are answered at once."""
_UNDECODED = re.compile("[\ufffd\udc80-\udcff]")
"""What stands for a byte that is no UTF-8: on a line of the terminal, and in an argument of a command."""
_OUTSIDE_STOPS = (STOP_COMMAND, STOP_TOPIC)


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
        """True where it may have to wait, and a stop clears it."""
        return self.kind in INSTRUCTIONS

    @property
    def why_unreadable(self) -> str:
        """Return the code of why nobody can tell what a text says (it is cut, or has bytes that are none), or ""."""
        if self.kind != "text" or len(self.text) > MOST_CHARACTERS:
            return "text_too_long" if self.kind == "text" else ""
        return "text_undecoded" if _UNDECODED.search(self.text) else ""


class _Hold(NamedTuple):
    """`turn` is the last that was said before that pause; `keeps_unbegun`: nothing was under way then, so that what
    waits is itself what is paused."""

    number: int
    turn: int
    keeps_unbegun: bool = False


class UtteranceQueue:
    """Keeps utterances in their order. Any thread may call `add`, `void` and `hold`; the rest the pumping one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._texts: deque[Utterance] = deque()
        self._turns = 0
        self._void_turn = self._dropped_turn = 0
        self._hold = self._released = _Hold(0, 0)
        self.stopped_by = Reason("cause_unknown")
        """The last stop."""
        self._dropped_by = Reason("cause_unknown")
        self.stops = 0
        """Changes with every stop and pause: what was asked for before it does not count any more."""
        self._gone_on_turn = 0
        self._last_turn = math.inf

    def add(self, text: str, kind: Kind, about: Draft | str = "", *, is_moving: bool) -> int:
        """Take in a text; return the number of its turn. One too many for a moving robot becomes `too_many`."""
        with self._lock:
            self._turns += 1
            if kind in INSTRUCTIONS and is_moving and self._count_waiting() >= QUEUE_LIMIT:
                kind = "too_many"
            self._texts.append(Utterance(self._turns, text, kind, time.monotonic(), about))
            return self._turns

    def void(self, why: str, source: str = "") -> int:
        """Make void what was said up to now; return its last turn. No lock: a stop waits for nothing.

        Args:
            source: who stopped, where it was not said here.
        """
        self.stopped_by = Reason("stopped_by", {"why": why} | ({"source": source} if source else {}))
        self.stops += 1
        self._void_turn = self._turns
        return self._void_turn

    def hear(self, event: Event) -> bool:
        """Take an event in; tell whether it was a stop from outside this conversation, which voids as one in it."""
        why = event.reason if isinstance(event, Finished) else None
        if why is None or why.code != "stopped_by" or why.values.get("source") not in _OUTSIDE_STOPS:
            return False
        self.void(str(why.values.get("why", "")), str(why.values["source"]))
        return True

    def end_after(self, turn: int | None = None) -> None:
        """Have nothing done of what is said after that turn, or from now on: the person has said goodbye."""
        self._last_turn = min(self._last_turn, self._turns if turn is None else turn)

    def hold(self, *, is_under_way: bool) -> None:
        """Have what was said up to now and waits go on waiting, for a pause. No lock: it waits for nothing.

        Args:
            is_under_way: something is driven or thought about, which is what is paused.
        """
        self.stops += 1
        self._hold = _Hold(self._hold.number + 1, self._turns, not is_under_way)

    @property
    def pauses(self) -> int:
        """Return how many pauses there were."""
        return self._hold.number

    @property
    def is_holding(self) -> bool:
        """True from a pause until what was said before it has been released or dropped."""
        return self._hold is not self._released

    @property
    def is_unbegun_held(self) -> bool:
        """True while something waits behind a pause for a word, not for a plan that is paused."""
        return self.is_holding and self._hold.keeps_unbegun and bool(self.held)

    @property
    def held(self) -> tuple[Utterance, ...]:
        """Return what waits behind the pause, oldest first."""
        return tuple(one for one in self.waiting if self.is_held(one) and not self.is_void(one))

    def is_held(self, utterance: Utterance) -> bool:
        """Return whether it waits behind what is paused."""
        return utterance.is_instruction and self.is_holding and utterance.turn <= self._hold.turn

    def release(self) -> None:
        """Let what waits behind a pause wait its turn again: what was paused is resumed."""
        self._released = self._hold
        self._gone_on_turn = self._hold.turn

    def drop_held(self, why: Reason) -> None:
        """Drop what waits behind a pause: what was paused is not resumed, for that reason."""
        hold = self._hold
        self._dropped_by = why
        self._dropped_turn, self._released = hold.turn, hold

    def is_void_turn(self, turn: int) -> bool:
        """Return whether a stop came after that turn was said."""
        return turn <= max(self._void_turn, self._dropped_turn)

    def is_after_end(self, turn: int) -> bool:
        """Return whether that turn was said after the goodbye, and before no stop."""
        return turn > self._last_turn and not self.is_void_turn(turn)

    def why_void(self, turn: int) -> Reason:
        """Return why that turn, which is void, is not done."""
        return self.stopped_by if turn <= self._void_turn else self._dropped_by

    def waited_behind_pause(self, turn: int) -> bool:
        """Return whether that turn was said before a pause that was not resumed."""
        return self._gone_on_turn < turn <= self._hold.turn

    def is_void(self, utterance: Utterance) -> bool:
        """Return whether a stop came after it was said, or a goodbye before; what is no instruction is answered all
        the same."""
        turn = utterance.turn
        return utterance.is_instruction and (self.is_void_turn(turn) or turn > self._last_turn)

    @property
    def waiting(self) -> tuple[Utterance, ...]:
        """Return what waits, oldest first."""
        return tuple(self._texts)

    def take(self, utterance: Utterance) -> Utterance | None:
        """Remove and return it; None where a pause came in the same moment, so that it waits."""
        if self.is_held(utterance) and not self.is_void(utterance):
            return None
        with self._lock:
            self._texts.remove(utterance)
        return utterance

    def put_back(self, utterance: Utterance) -> None:
        """Let it wait again, before all others."""
        with self._lock:
            self._texts.appendleft(utterance)

    def take_too_many(self) -> list[Utterance]:
        """Remove and return those that may not even wait."""
        return [one for one in self.waiting if one.kind == "too_many" and self.take(one)]

    def _count_waiting(self) -> int:
        return sum(utterance.is_instruction and not self.is_void(utterance) for utterance in self._texts)


@dataclass(eq=False)
class NextUtterance:
    """Finds the text to take now. Belongs to the pumping thread."""

    _utterances: UtteranceQueue
    _requests: RequestLog
    _llm: ModelRequests
    _understanding: Understanding
    _resuming: Resuming
    _early: EarlyAnswers
    _awaits: Callable[[Utterance], bool]
    """Whether it answers a plan that waits for a yes."""

    def find(self, options: Options, waiting_turn: int | None) -> Utterance | None:
        """Return the one to take now: the first, unless it has to wait.

        Args:
            waiting_turn: the turn that is read again once what is under way has ended.
        """
        waiting = self._utterances.waiting
        for number, utterance in enumerate(waiting):
            if not utterance.is_instruction or self._utterances.is_void(utterance):
                is_about_a_pause = utterance.kind in ("pause", "resume")
                return None if is_about_a_pause and self.is_being_paused else utterance
            if self._utterances.is_held(utterance):
                continue
            if self._awaits(utterance):
                return utterance
            if self.is_being_paused or self._llm.is_writing:
                return None
            replaces = self._resuming.paused is not None or options.while_moving == "replace"
            if replaces and utterance.turn != waiting_turn:
                return utterance
            if self._requests.is_any_with_motion:
                if not options.answers_in_turn and self._early.is_about_motion(utterance):
                    return utterance
                answers = (one for one in waiting[number:] if self._awaits(one))
                early = self._early.find(waiting[number:]) if utterance.turn != waiting_turn else None
                return next(answers, None) or early
            if not self._llm.is_busy or self._overtakes(utterance):
                return utterance
        return None

    @property
    def is_being_paused(self) -> bool:
        """True from a pause until Motion has told what came of it."""
        is_moving = self._requests.is_any_with_motion or self._llm.is_moving
        return self._utterances.is_holding and self._resuming.paused is None and is_moving

    def drop_held(self) -> None:
        """Drop what waits behind a pause where nothing is paused any more, or something new is done instead."""
        utterances, llm = self._utterances, self._llm
        is_with_motion = self._requests.is_any_with_motion
        is_unbegun = utterances.is_unbegun_held
        is_over = is_with_motion or llm.is_busy if is_unbegun else not (is_with_motion or llm.is_moving)
        if utterances.is_holding and is_over:
            utterances.drop_held(Reason("replaced") if is_unbegun else self._resuming.ended_by)

    def _overtakes(self, utterance: Utterance) -> bool:
        """It needs no model, and the one that is being asked says nothing."""
        if not self._llm.may_be_overtaken(utterance.at_s):
            return False
        if utterance.kind in ("plan", "edited_plan"):
            return True
        meant = self._understanding.interpret(utterance.text)
        return not (meant.is_about_turn_before or self._llm.wants(utterance.text, meant))


NOT_UNDERSTOOD = frozenset({"unknown_part", "nothing_to_do", "empty", "too_long", "where_to"})
"""Of the questions back, those that what happens until then cannot answer."""


@dataclass(eq=False)
class EarlyAnswers:
    """Finds waiting texts that are answered before their turn. Belongs to the pumping thread; looks at each once."""

    _understanding: Understanding
    _llm: ModelRequests
    _requests: RequestLog
    _authoring: Authoring | None
    _while_driving: WhileDriving
    _meant: dict[int, Interpretation | None] = field(default_factory=dict, init=False)
    _looked_at: tuple[int, bool] = field(default=(0, False), init=False)

    def is_about_motion(self, utterance: Utterance) -> bool:
        """Return whether it changes the speed of what is driven, or asks for the rest, though it would wait here."""
        if self._looked_at[0] != utterance.turn and self._while_driving.is_any:
            is_about = utterance.kind == "text" and self._while_driving.concerns(utterance.text)
            self._looked_at = (utterance.turn, is_about)
        return self._looked_at == (utterance.turn, True)

    def find(self, waiting: Sequence[Utterance]) -> Utterance | None:
        """Return the first of them that nobody understands, and that those before it do not teach us to."""
        if self._llm.has_model or any(_teaches(one.meant) for one in self._requests.under_way):
            return None
        for utterance in waiting:
            meant = self._look_at(utterance)
            if meant is None or _teaches(meant) or meant.proposal or read_consent(utterance.text) is not None:
                return None  # what follows may be about it
            asks_back = meant.outcome == "unclear" and meant.code in NOT_UNDERSTOOD
            if asks_back and not meant.corrects:
                return utterance
        return None

    def _look_at(self, utterance: Utterance) -> Interpretation | None:
        """What it would mean now; None for what is no text to be understood."""
        if utterance.turn not in self._meant:
            is_text = utterance.kind == "text" and not self._is_about_a_program(utterance.text)
            under_way = self._requests.under_way
            self._meant[utterance.turn] = (
                self._understanding.interpret(utterance.text, under_way) if is_text else None
            )
        return self._meant[utterance.turn]

    def _is_about_a_program(self, text: str) -> bool:
        authoring = self._authoring
        if authoring is None:
            return False
        try:
            kept = authoring.told(text, "en") or authoring.kept(text, "")
        except NotWrittenError:
            return True
        return bool(kept) or read_request(text, is_asked_for=False) is not None


def _teaches(meant: Interpretation) -> bool:
    """After it, there is a word or a place that was not there before."""
    steps = meant.plan.steps if meant.plan is not None else ()
    return bool(meant.define or meant.remember_place) or any(map(_remembers, steps))


def _remembers(step: Step) -> bool:
    return isinstance(step, Remember) or any(map(_remembers, getattr(step, "steps", ())))
