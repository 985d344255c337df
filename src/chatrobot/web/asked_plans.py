"""The plans that people at pages are asked about, and what they make of them: an agent hears what its plan became."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.events import Event, Interpreted, Ordered, Result
from chatrobot.dialogue.question import Question
from chatrobot.dialogue.session import Session
from chatrobot.link.client_line import TURNS

_KEPT = 50
"""Plans whose text is kept, so that an edit that cannot be read leaves the one before it."""
OnEdited = Callable[[int, str, Result], None]
"""Hears what became of the edit of an agent's plan: the agent's turn, the plan that was asked about, how that ended."""


class AskedPlans:
    """Of one robot. `hear` every event; have a lock around all of it."""

    def __init__(self) -> None:
        self._question = Question()
        self._texts: dict[int, str] = {}
        self._edits: dict[int, int] = {}
        """Turns of edits, each with the agent's turn whose plan was edited."""
        self.on_edited: OnEdited | None = None

    @property
    def turn(self) -> int | None:
        """Return the turn of the plan that waits for a yes; None where none does."""
        return self._question.turn

    def hear(self, event: Event) -> None:
        """Take an event in."""
        self._question.hear(event)
        if isinstance(event, (Interpreted, Ordered)):
            self._texts[event.turn] = event.plan_text
            if len(self._texts) > _KEPT:
                self._texts.pop(next(iter(self._texts)))
        elif isinstance(event, Result) and event.turn in self._edits:
            agents_turn = self._edits.pop(event.turn)
            if self.on_edited is not None:
                self.on_edited(agents_turn, self._texts.get(event.turn, ""), event)

    def answer(self, session: Session, *, yes: bool) -> None:
        """Answer the plan that waits."""
        self._question.answer(session, yes)

    def edit(self, session: Session, turn: int, plan_text: str) -> int:
        """Have `plan_text` asked about in place of the plan of that turn; the number of its own turn.

        An edit of an edit is one of the same plan. What an agent was told has lapsed may still be edited.
        """
        if self._question.turn == turn:
            self._question.answer(session, False, edited=True)
        edited = session.say_edited_plan(plan_text, self._texts.get(turn, ""))
        agents_turn = turn if turn >= TURNS else self._edits.pop(turn, 0)
        if agents_turn:
            self._edits[edited] = agents_turn
        return edited
