"""What a person makes of a plan or a program at the question; what cannot be read is there again at the next edit."""

from __future__ import annotations

from typing import Protocol

from chatrobot.core.events import Event, Finished, Notice, ProgramWritten, Started

UNREADABLE = "edit_unreadable"
"""The code of the notice that what was edited is asked about as it was before."""


class TakesEdits(Protocol):
    """A `Session`, as far as an edit needs it."""

    def say_edited_plan(self, plan_text: str, instead_of: str = "") -> int: ...

    def say_source(self, name: str, source: str) -> int: ...


class Edited:
    """One edit at a time: `begin` it, then `say` what came of it; `hear` every event."""

    def __init__(self) -> None:
        self._before = self._typed = self._unreadable = ""
        self._program: ProgramWritten | None = None
        self._turn = 0

    def begin(self, plan_text: str, program: ProgramWritten | None) -> str:
        """The text to be edited: that plan, or that program, or what was made of it before and could not be read."""
        self._program = program
        self._before = program.source if program is not None else plan_text
        text, self._unreadable = self._unreadable or self._before, ""
        return text

    @property
    def is_program(self) -> bool:
        return self._program is not None

    def say(self, session: TakesEdits, text: str) -> int:
        """Have it read, rehearsed and asked about; the number of its turn."""
        self._typed = text
        if self._program is not None:
            self._turn = session.say_source(self._program.program, text)
        else:
            self._turn = session.say_edited_plan(text, self._before)
        return self._turn

    def hear(self, event: Event) -> None:
        if isinstance(event, Notice) and event.reason.code == UNREADABLE:
            self._unreadable = self._typed
        elif isinstance(event, (Started, Finished)) and event.turn == self._turn:
            self._unreadable = ""
