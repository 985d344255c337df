"""The programs that are kept, as pages list, read and run them. The library is read by the thread that pumps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from chatrobot.core.errors import InputError
from chatrobot.dialogue.session import Session
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.phrases import render_reason
from chatrobot.programs.library import KeptProgram
from chatrobot.robots.profile import RobotProfile
from chatrobot.web.outbox import Face, Message
from chatrobot.web.words import refused, told

Post = Callable[[Callable[[], None]], None]
Say = Callable[[], int]


class Programs:
    """See the module.

    Args:
        post: has something done by the thread that pumps the session.
    """

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
        "by": program.provenance.by,
        "versions": program.provenance.versions,
        "rehearsal": dict(program.rehearsal),
        "runs": len(program.runs),
        "last_run": vars(last) if last is not None else None,
    }
