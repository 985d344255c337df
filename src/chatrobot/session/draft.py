"""A program on its way: which version it is, who wrote it, and what is known of it before it runs."""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace

from chatrobot.core.events import FindingSeen, ProgramWritten
from chatrobot.core.reason import Reason
from chatrobot.models.seam import Message
from chatrobot.programs.check import Checked
from chatrobot.programs.library import KeptProgram


@dataclass(frozen=True)
class Draft:
    """One version of a program.

    `is_new`: it was written in this turn, so it is kept once it stands. `asks`: a person's yes is waited for, whatever
    the options. `place` is the file of its source, "" where it is in none. `messages` is the conversation with the
    model that wrote it, empty where none did. `promises` are what the request says and its numbers do not give.
    """

    program: KeptProgram
    checked: Checked
    is_new: bool = False
    asks: bool = False
    place: str = ""
    version: int = 1
    diff: str = ""
    promises: tuple[Reason, ...] = ()
    messages: tuple[Message, ...] = ()

    @property
    def by_model(self) -> bool:
        return bool(self.messages)

    def next(self, source: str, checked: Checked, messages: tuple[Message, ...] = ()) -> Draft:
        """The version after this one: a model's where there are `messages`, otherwise a person's."""
        origin = self.program.provenance
        program = replace(
            self.program,
            source=source,
            remap=dict(checked.remap),
            rehearsal={},
            provenance=replace(origin, by="model" if messages else "person", versions=self.version + 1),
        )
        return replace(
            self,
            program=program,
            checked=checked,
            is_new=True,
            version=self.version + 1,
            diff=difference(self.program.source, source),
            messages=messages,
        )

    def event(self, turn: int) -> ProgramWritten:
        """What the faces show of it."""
        marks = [
            FindingSeen(turn, m.severity, m.reason, (m.line,) if m.line else ()) for m in self.checked.marks
        ]
        marks += [FindingSeen(turn, "note", promise) for promise in self.promises]
        program = self.program
        return ProgramWritten(
            turn,
            program.name,
            program.provenance.by,
            program.source,
            program.description,
            self.version,
            self.diff,
            self.is_new,
            tuple(marks),
            self.place,
        )


def difference(old: str, new: str) -> str:
    """What changed between two versions, as a unified diff."""
    lines = difflib.unified_diff(old.splitlines(), new.splitlines(), "before", "after", lineterm="", n=2)
    return "\n".join(lines)
