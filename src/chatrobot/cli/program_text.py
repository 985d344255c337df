"""A program's source for people: numbered lines, and under each risky one why it is marked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from chatrobot.core.events import FindingSeen
from chatrobot.language.phrases import render_reason
from chatrobot.programs.check import Mark

SIGNS = {"refuse": "✗", "warn": "!", "note": "·"}


def marks_of(findings: Iterable[FindingSeen]) -> tuple[Mark, ...]:
    """The marks of a `program_written` event."""
    return tuple(Mark(f.severity, f.step[0] if f.step else 0, f.reason) for f in findings)


def numbered(source: str, marks: Iterable[Mark], language: str) -> Iterator[str]:
    """Every line with its number; marks under the line they are about, those about the whole at the end."""
    marks = tuple(marks)
    lines = source.splitlines()
    for number, line in enumerate(lines, start=1):
        yield f"  {number:4d}  {line}".rstrip()
        yield from _told(marks, number, language)
    yield from _told(marks, 0, language)


def marked_only(source: str, marks: Iterable[Mark], language: str) -> Iterator[str]:
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
