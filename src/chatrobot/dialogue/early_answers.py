"""What was said to a moving robot and cannot be understood is answered at once, not when the motion is over."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.dialogue.llm.requests import ModelRequests
from chatrobot.dialogue.programs.authoring import Authoring, NotWrittenError
from chatrobot.dialogue.request_log import RequestLog
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.utterances import Utterance
from chatrobot.language.interpretation import Interpretation
from chatrobot.plan.steps import Remember, Step

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
