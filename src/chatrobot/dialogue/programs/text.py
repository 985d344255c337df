"""A program for people: what it is, where it is, and its source with what is risky in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from chatrobot.core.events import FindingSeen, ProgramWritten
from chatrobot.language.phrases import render_reason, say
from chatrobot.programs.check import Mark

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
