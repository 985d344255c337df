"""A program on its way: which version it is, who wrote it, and what is known of it before it runs."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass, replace

from chatrobot.core.events import FindingSeen, ProgramWritten
from chatrobot.core.reason import Reason
from chatrobot.models.seam import Message
from chatrobot.programs.check import Checked
from chatrobot.programs.library import KeptProgram
from chatrobot.programs.ros_args import check_args, read_ros_args


@dataclass(frozen=True)
class Draft:
    """One version of a program.

    `is_new`: it was written in this turn, so it is kept once it stands. `asks`: a person's yes is waited for, whatever
    the options. `place` is the file of its source, "" where it is in none. `messages` is the conversation with the
    model that wrote it, empty where none did. `args` is the command line it gets. `promises` are what the request says
    and its numbers do not give.
    """

    program: KeptProgram
    checked: Checked
    is_new: bool = False
    asks: bool = False
    place: str = ""
    version: int = 1
    diff: str = ""
    args: tuple[str, ...] = ()
    promises: tuple[Reason, ...] = ()
    messages: tuple[Message, ...] = ()

    @property
    def remap(self) -> dict[str, str]:
        """Return what its topics are led to, but for those that its arguments lead elsewhere."""
        named = {rule.what.strip("/") for rule in read_ros_args(self.args).remaps}
        return {topic: to for topic, to in self.program.remap.items() if topic.strip("/") not in named}

    def with_args(self, args: Sequence[str]) -> Draft:
        """Return it with a command line of its own.

        Raises:
            RosArgumentsError: they cannot be given to a program.
        """
        check_args(args)
        return replace(self, args=tuple(args))

    @property
    def by_model(self) -> bool:
        """Tell whether a model wrote it, and can mend it."""
        return bool(self.messages)

    def next(self, source: str, checked: Checked, messages: tuple[Message, ...] = ()) -> Draft:
        """Return the version after this one: a model's where there are `messages`, otherwise a person's."""
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
        """Return what the displays show of it."""
        led = self.remap
        marks = [
            FindingSeen(turn, m.severity, m.reason, (m.line,) if m.line else ())
            for m in self.checked.marks
            if m.reason.code != "other_topic" or m.reason.values["topic"] in led
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
    """Return what changed between two versions, as a unified diff."""
    lines = difflib.unified_diff(old.splitlines(), new.splitlines(), "before", "after", lineterm="", n=2)
    return "\n".join(lines)
