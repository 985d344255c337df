"""Which of the texts that wait is taken next: most wait for what runs, is thought about or is paused."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.requests import ModelRequests
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring, NotWrittenError
from chatrobot.dialogue.request_log import RequestLog
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.utterances import Utterance, UtteranceQueue
from chatrobot.language.interpretation import Interpretation
from chatrobot.plan.steps import Remember, Step


class NextUtterance:
    """Belongs to the pumping thread.

    Args:
        is_writing: a model writes a program; what is said meanwhile comes after it.
    """

    def __init__(
        self,
        utterance: UtteranceQueue,
        book: RequestLog,
        llm: ModelRequests,
        understanding: Understanding,
        resuming: Resuming,
        early: EarlyAnswers,
        is_writing: Callable[[], bool],
    ) -> None:
        self._utterances = utterance
        self._requests = book
        self._llm = llm
        self._understanding = understanding
        self._resuming = resuming
        self._early = early
        self._is_writing = is_writing

    def find(self, options: Options, waits_for_end: int | None) -> Utterance | None:
        """The one to take now: the first, unless it has to wait.

        Args:
            waits_for_end: the turn that is read again once what is under way has ended.
        """
        waiting = self._utterances.waiting
        for number, utterance in enumerate(waiting):
            if not utterance.is_instruction or self._utterances.is_void(utterance):
                is_about_a_pause = utterance.kind in ("pause", "resume")
                return None if is_about_a_pause and self.is_being_paused else utterance
            if self._utterances.is_held(utterance):
                continue
            if self.is_being_paused or self._is_writing():
                return None
            replaces = self._resuming.paused is not None or options.while_moving == "replace"
            if replaces and utterance.turn != waits_for_end:
                return utterance
            if self._requests.is_any_with_motion:
                return self._early.find(waiting[number:])
            if not self._llm.is_busy or self._overtakes(utterance):
                return utterance
        return None

    @property
    def is_being_paused(self) -> bool:
        """A pause was said, and Motion has not told yet what came of it."""
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


NOT_UNDERSTOOD = frozenset({"unknown_part", "nothing_to_do", "empty", "too_long"})
"""Of the questions back, those that what happens until then cannot answer."""


class EarlyAnswers:
    """Belongs to the pumping thread. Each text is looked at once."""

    def __init__(
        self, understanding: Understanding, llm: ModelRequests, book: RequestLog, authoring: Authoring | None
    ) -> None:
        self._understanding = understanding
        self._llm = llm
        self._requests = book
        self._authoring = authoring
        self._meant: dict[int, Interpretation | None] = {}

    def find(self, waiting: Sequence[Utterance]) -> Utterance | None:
        """The first of them that nobody understands, and that those before it do not teach us to."""
        if self._llm.has_model or any(_teaches(one.meant) for one in self._requests.under_way):
            return None
        for utterance in waiting:
            meant = self._look_at(utterance)
            if meant is None or _teaches(meant):
                return None
            if (
                meant.outcome == "unclear"
                and meant.code in NOT_UNDERSTOOD
                and not meant.proposal
                and not meant.corrects
            ):
                return utterance
        return None

    def _look_at(self, utterance: Utterance) -> Interpretation | None:
        """What it would mean now; None for what is no text to be understood."""
        if utterance.turn not in self._meant:
            is_text = utterance.kind == "text" and not self._is_about_a_program(utterance.text)
            self._meant[utterance.turn] = self._understanding.interpret(utterance.text) if is_text else None
        return self._meant[utterance.turn]

    def _is_about_a_program(self, text: str) -> bool:
        authoring = self._authoring
        if authoring is None:
            return False
        try:
            kept = authoring.kept(text, "")
        except NotWrittenError:
            return True
        return kept is not None or authoring.request(text, is_asked_for=False) is not None


def _teaches(meant: Interpretation) -> bool:
    """After it, there is a word or a place that was not there before."""
    steps = meant.plan.steps if meant.plan is not None else ()
    return bool(meant.define or meant.remember_place) or any(map(_remembers, steps))


def _remembers(step: Step) -> bool:
    return isinstance(step, Remember) or any(map(_remembers, getattr(step, "steps", ())))
