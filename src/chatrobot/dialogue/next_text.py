"""Which of the texts that wait is taken next: most wait for what runs, is thought about or is paused."""

from __future__ import annotations

from chatrobot.core.reason import Reason
from chatrobot.dialogue.early import EarlyAnswers
from chatrobot.dialogue.llm.thinking import Thinking
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.said import Said, SaidTexts
from chatrobot.dialogue.turn_book import TurnBook
from chatrobot.dialogue.understanding import Understanding


class NextText:
    """Belongs to the pumping thread."""

    def __init__(
        self,
        said: SaidTexts,
        book: TurnBook,
        thinking: Thinking,
        understanding: Understanding,
        resuming: Resuming,
        early: EarlyAnswers,
    ) -> None:
        self._said = said
        self._book = book
        self._thinking = thinking
        self._understanding = understanding
        self._resuming = resuming
        self._early = early

    def find(self, options: Options, waits_for_end: int | None) -> Said | None:
        """The one to take now: the first, unless it has to wait.

        Args:
            waits_for_end: the turn that is read again once what is under way has ended.
        """
        waiting = self._said.waiting
        for number, said in enumerate(waiting):
            if not said.is_instruction or self._said.is_void(said):
                is_about_a_pause = said.kind in ("pause", "resume")
                return None if is_about_a_pause and self.is_being_paused else said
            if self._said.is_held(said):
                continue
            if self.is_being_paused:
                return None
            replaces = self._resuming.paused is not None or options.while_moving == "replace"
            if replaces and said.turn != waits_for_end:
                return said
            if self._book.is_any_with_motion:
                return self._early.find(waiting[number:])
            if not self._thinking.is_busy or self._overtakes(said):
                return said
        return None

    @property
    def is_being_paused(self) -> bool:
        """A pause was said, and Motion has not told yet what came of it."""
        is_moving = self._book.is_any_with_motion or self._thinking.is_moving
        return self._said.is_holding and self._resuming.paused is None and is_moving

    def drop_held(self) -> None:
        """Drop what waits behind a pause where nothing is paused any more, or something new is done instead."""
        said, thinking = self._said, self._thinking
        has_begun = self._book.is_any_with_motion or thinking.is_busy
        is_moving = self._book.is_any_with_motion or thinking.is_moving
        is_unbegun = said.is_unbegun_held
        if said.is_holding and (has_begun if is_unbegun else not is_moving):
            said.drop_held(Reason("replaced") if is_unbegun else self._resuming.ended_by)

    def _overtakes(self, said: Said) -> bool:
        """It needs no model, and the one that is being asked says nothing."""
        if not self._thinking.may_be_overtaken(said.at_s):
            return False
        if said.kind in ("plan", "edited_plan"):
            return True
        meant = self._understanding.interpret(said.text)
        return not (meant.is_about_turn_before or self._thinking.wants(said.text, meant))
