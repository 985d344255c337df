"""A program on its way: its version, who wrote it, what is known before it runs; and all that for people."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from chatrobot.core.events import FindingSeen, ProgramWritten
from chatrobot.core.reason import Reason
from chatrobot.language.phrases import render_reason, say
from chatrobot.models.seam import Message
from chatrobot.programs.check import Checked, Mark
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


# --- for people ---

SIGNS = {"refuse": "✗", "warn": "!", "note": "·"}


def headline(event: ProgramWritten, language: str) -> str:
    """Return its name, who wrote this version, and its number."""
    by = say(language, f"written_by_{event.by}")
    return say(language, "program_shown", name=event.program, by=by, version=event.version)


def body(event: ProgramWritten, language: str) -> Iterator[str]:
    """Yield the file of its source; what changed, or the source where it is new; and what is risky in it."""
    marks = _marks_of(event.marks)
    if event.place:
        yield f"  {say(language, 'program_place', place=_from_home(event.place))}"
    if event.diff:
        yield from (f"  {line}" for line in event.diff.splitlines()[2:])
    shown = numbered if event.is_new and not event.diff else _marked_only
    yield from shown(event.source, marks, language)


def numbered(source: str, marks: Iterable[Mark], language: str) -> Iterator[str]:
    """Yield every line with its number; marks under the line they are about, those about the whole at the end."""
    marks = tuple(marks)
    lines = source.splitlines()
    for number, line in enumerate(lines, start=1):
        yield f"  {number:4d}  {line}".rstrip()
        yield from _told(marks, number, language)
    yield from _told(marks, 0, language)


def _marks_of(findings: Iterable[FindingSeen]) -> tuple[Mark, ...]:
    return tuple(Mark(f.severity, f.step[0] if f.step else 0, f.reason) for f in findings)


def _marked_only(source: str, marks: Iterable[Mark], language: str) -> Iterator[str]:
    """The lines that are marked, and why."""
    marks = tuple(marks)
    lines = source.splitlines()
    for number in sorted({mark.line for mark in marks}):
        if 0 < number <= len(lines):
            yield f"  {number:4d}  {lines[number - 1]}".rstrip()
        yield from _told(marks, number, language)


def _told(marks: tuple[Mark, ...], number: int, language: str) -> Iterator[str]:
    for mark in marks:
        if mark.line == number:
            yield f"  {SIGNS[mark.severity]} {render_reason(mark.reason, language)}"


def _from_home(place: str) -> str:
    """`place` as a person writes it."""
    path, home = Path(place), Path.home()
    return f"~/{path.relative_to(home)}" if path.is_relative_to(home) and path != home else place
