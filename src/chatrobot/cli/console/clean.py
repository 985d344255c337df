"""What comes out of a keyboard or a paste, made fit to be understood, shown and stored."""

from __future__ import annotations

LONGEST_CHARS = 4000
"""One instruction or one edited plan; what is longer is a mistake."""


def clean(text: str) -> str:
    """Printable text in valid Unicode: what else it held becomes "�"; line breaks and tabs stay."""
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if text.isascii() and text.isprintable():
        return text
    return "".join(char if _is_fine(char) else "�" for char in text)


def _is_fine(char: str) -> bool:
    return char.isprintable() or char in "\n\t\u3000\u00a0"
