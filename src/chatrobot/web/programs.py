"""Plans and programs at pages: the plans that people are asked about, and what they make of them; the programs that are
kept, as pages list, read and run them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import InputError
from chatrobot.core.events import Event, Interpreted, Ordered, Result
from chatrobot.dialogue.question import Question
from chatrobot.dialogue.session import Session
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.phrases import render_reason
from chatrobot.link.motion_link import TURNS
from chatrobot.programs.library import KeptProgram
from chatrobot.robots.profile import RobotProfile
from chatrobot.web.outbox import Face, Message
from chatrobot.web.words import refused, told

Post = Callable[[Callable[[], None]], None]
Say = Callable[[], int]
_KEPT = 50
"""Plans whose text is kept, so that an edit that cannot be read leaves the one before it."""
OnEdited = Callable[[int, str, Result], None]
"""Hears what became of the edit of an agent's plan: the agent's turn, the plan that was asked about, how that ended."""


class AskedPlans:
    """Of one robot; an agent hears what its plan became. `hear` every event; have a lock around all of it."""

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


class Programs:
    """The programs of one robot. The library is read by the thread that pumps the session: `post` gives it work."""

    def __init__(self, session: Session, profile: RobotProfile, post: Post) -> None:
        self._session = session
        self._profile = profile
        self._post = post

    @property
    def are_kept(self) -> bool:
        """Programs are written and kept here."""
        return self._session.authoring is not None

    def list_all(self, face: Face) -> None:
        """Tell which there are."""
        self._read(face, "programs", lambda: face.put(told("programs", programs=self._all())))

    def show(self, face: Face, name: str) -> None:
        """Tell one with its source, and what is risky in it."""
        self._read(face, "program", lambda: self._tell(face, self._get(name)))

    def run(self, face: Face, name: str, say_as: Callable[[Say], int]) -> None:
        """Have one rehearsed and run; `say_as` notes who said so."""

        def begin() -> None:
            assert self._session.authoring is not None
            draft = self._session.authoring.draft_of(self._get(name))
            say_as(lambda: self._session.say_draft(draft))

        self._read(face, "run_program", begin)

    def _read(self, face: Face, do: str, act: Callable[[], None]) -> None:
        if not self.are_kept:
            face.put(refused("no_programs", do))
            return

        def attempt() -> None:
            try:
                act()
            except InputError as error:
                face.put(refused("problem", do, problem=str(error)))

        self._post(attempt)

    def _get(self, name: str) -> KeptProgram:
        assert self._session.authoring is not None
        return self._session.authoring.library.get(name)

    def _all(self) -> list[dict[str, Any]]:
        assert self._session.authoring is not None
        return [_about(program) for program in self._session.authoring.library.all()]

    def _tell(self, face: Face, program: KeptProgram) -> None:
        from chatrobot.programs.check import check

        marks = check(program.source, self._profile).marks

        def make(language: LanguageCode) -> dict[str, Any]:
            lines = [
                {"line": mark.line, "severity": mark.severity, "text": render_reason(mark.reason, language)}
                for mark in marks
            ]
            return {"is": "program", **_about(program), "source": program.source, "marks": lines}

        face.put(Message(make))


def _about(program: KeptProgram) -> dict[str, Any]:
    last = program.runs[-1] if program.runs else None
    return {
        "name": program.name,
        "description": program.description,
        "by": program.provenance.author,
        "versions": program.provenance.versions,
        "rehearsal": dict(program.rehearsal),
        "runs": len(program.runs),
        "last_run": vars(last) if last is not None else None,
    }
