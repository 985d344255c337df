"""The screen, and lines for it that wrap under themselves, without blanks at their ends.

So they can be copied, and survive a resize.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Protocol

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from chatrobot.cli.narrator import PLAN_STYLE, Line

INDENT = 2
LEAST_TABLE_WIDTH = 72
"""Columns below which a table leaves its last column no room."""
_CLOSING = frozenset("，。、；：！？）》”’…,.;:!?)")
_OPENING = frozenset("（《“‘(")
_VERB = re.compile(r"^ *(?:\d+ × \(?)*([a-z_]+)")


@dataclass(frozen=True)
class _Hanging:
    """`text` behind `prefix`, its further lines under its first."""

    prefix: Text
    text: Text

    def __rich_console__(self, _: Console, options: ConsoleOptions) -> RenderResult:
        indent = self.prefix.cell_len
        prefix = self.prefix
        for line in wrapped(self.text, max(8, options.max_width - indent)):
            yield Text.assemble(prefix, line)
            prefix = Text(" " * indent)


class Rows:
    """Rows as a table; where that would be too narrow to read, each as a line with the rest of it below."""

    def __init__(self, *heads: str) -> None:
        self._heads = heads
        self._rows: list[tuple[Text, ...]] = []

    def add(self, *cells: str | Text) -> None:
        """Add a row; the first cell names it."""
        self._rows.append(tuple(Text(cell) if isinstance(cell, str) else cell for cell in cells))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        if options.max_width >= LEAST_TABLE_WIDTH:
            yield self._table()
            return
        for name, *rest in self._rows:
            yield name
            yield Padding(Text(" · ").join(cell for cell in rest if cell.plain), (0, 0, 0, INDENT))

    def _table(self) -> Table:
        heads = self._heads
        table = Table(box=None, show_header=bool(heads), pad_edge=False, padding=(0, 2), header_style="dim")
        table.add_column(heads[0] if heads else "", no_wrap=True)
        for head in heads[1:] or ("",):
            table.add_column(head, overflow="fold")
        for row in self._rows:
            table.add_row(*row)
        return table


def indented(text: Text) -> RenderableType:
    """Indent `text`, however many lines it takes."""
    return _Hanging(Text(" " * INDENT), text)


def marked(mark: str, style: str, text: str | Text) -> RenderableType:
    """Put `text` behind a mark of one character."""
    return _Hanging(
        Text.assemble(" " * INDENT, (mark.ljust(2), style)), Text(text) if isinstance(text, str) else text
    )


def shown(line: Line) -> RenderableType:
    """Put a line into colours; the first verb of a plan's line in bold, so that a plan reads at a glance."""
    is_plan = line.style == PLAN_STYLE
    text = Text(line.text, "" if is_plan else line.style)
    if is_plan and (verb := _VERB.match(line.text)):
        text.stylize("bold cyan", *verb.span(1))
    return _Hanging(Text(line.lead, line.lead_style), text)


def wrapped(text: Text, columns: int) -> list[Text]:
    """Break `text` into lines of at most `columns` cells, broken at blanks and between Chinese characters."""
    lines: list[Text] = []
    for line in text.split("\n", allow_blank=True):
        lines += line.divide(_breaks(line.plain, columns))
    for line in lines:
        line.rstrip()
    return lines


def _breaks(line: str, columns: int) -> list[int]:
    """List where a new line begins."""
    breaks: list[int] = []
    cells, begin, may_break = 0, 0, 0
    for number, char in enumerate(line):
        if number and _may_part(line[number - 1], char):
            may_break = number
        cells += cell_len(char)
        if cells > columns and not char.isspace():
            begin = may_break if may_break > begin else number
            breaks.append(begin)
            cells = cell_len(line[begin : number + 1])
    return breaks


def _may_part(before: str, char: str) -> bool:
    if char.isspace() or char in _CLOSING or before in _OPENING:
        return False
    return before.isspace() or cell_len(before) == 2 or cell_len(char) == 2


class Display(Protocol):
    """A screen. All of it may be called from any thread."""

    @property
    def echoes(self) -> bool:
        """What was typed stays to be seen without our help."""
        ...

    @property
    def width(self) -> int:
        """Columns."""
        ...

    def print(self, *lines: RenderableType) -> None:
        """Show lines above the prompt."""
        ...

    def refresh(self) -> None:
        """Something that the status bar shows has changed."""
        ...

    def edit(self, plan_text: str) -> None:
        """Let the person change a plan; it comes back through `ChatController.take_edited`."""
        ...

    def leave(self, code: int) -> None:
        """End the conversation; `code` is the exit code."""
        ...
