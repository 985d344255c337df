"""Lines that wrap under themselves, without blanks at their ends: they can be copied, and survive a resize."""

from __future__ import annotations

from dataclasses import dataclass

from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.text import Text

INDENT = 2


@dataclass(frozen=True)
class _Hanging:
    """`text` behind `prefix`, its further lines under its first."""

    prefix: Text
    text: Text

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        indent = self.prefix.cell_len
        prefix = self.prefix
        for line in self.text.wrap(console, max(8, options.max_width - indent)):
            line.rstrip()
            yield Text.assemble(prefix, line)
            prefix = Text(" " * indent)


def indented(text: Text) -> RenderableType:
    """`text`, indented, however many lines it takes."""
    return _Hanging(Text(" " * INDENT), text)


def marked(mark: str, style: str, text: str | Text) -> RenderableType:
    """`text` behind a mark of one character."""
    return _Hanging(
        Text.assemble(" " * INDENT, (mark.ljust(2), style)), Text(text) if isinstance(text, str) else text
    )
