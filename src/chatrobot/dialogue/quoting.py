"""Foreign text on its way into a prompt or onto a screen: one line, printable, quoted, short."""

from __future__ import annotations

import json

SHOWN_CHARS = 300


def one_line(text: str, limit: int = SHOWN_CHARS) -> str:
    """Printable text on one line: control characters, line breaks and direction marks become spaces."""
    tidy = " ".join("".join(char if char.isprintable() else " " for char in text[: 4 * limit]).split())
    return tidy if len(tidy) <= limit else f"{tidy[: limit - 1]}…"


def quoted(text: str, limit: int = 40) -> str:
    """A name from outside as a quoted string: it cannot end its quotation, nor begin a line of its own."""
    return json.dumps(one_line(text, limit), ensure_ascii=False)
