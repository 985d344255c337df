"""Wraps keys and tokens so that none is printed by accident, and scrubs them from what providers send back."""

from __future__ import annotations

import json
import re
from typing import Literal
from urllib.parse import quote

HIDDEN = "•••"
_SHORTEST = 6
"""Shorter "keys" (`none`, `x`) are placeholders; hiding them would mutilate ordinary words."""
_QUOTES = {'"': '"', "'": "'", "`": "`", "“": "”", "‘": "’", "«": "»"}
_TOKENS = (
    r"\b(?:sk|pk|rk|gsk|hf|xai)[-_][A-Za-z0-9_\-*]{8,}|\bAIza[A-Za-z0-9_\-*]{8,}|"
    r"(?i:\bbearer\s+)[A-Za-z0-9._~+/=\-]{8,}"
)
_LOOKS_LIKE_ONE = re.compile(
    r"[^\s\"'“”‘’*]{0,40}\*{3,}[^\s\"'“”‘’]{0,40}|"  # as providers show one: its end behind asterisks
    + _TOKENS
)
_HAS_NO_ASTERISKS = re.compile(_TOKENS)
"""The same for texts without `***`, in less than half the time: recordings scrub each telemetry event."""


Flaw = Literal["not_ascii", "space"]
"""Why something can be no key, without a character of it. A header of HTTP takes printable ASCII."""


class Secret:
    """Key or token. `reveal` is the one way to it; printing, formatting, pickling and comparing show nothing.

    Blanks and quotation marks that were pasted around it are no part of it.
    """

    __slots__ = ("_value",)

    def __init__(self, value: str) -> None:
        self._value = _bare(value)

    def reveal(self) -> str:
        """Return the key itself, for the header of a request and for the keyring."""
        return self._value

    @property
    def flaw(self) -> Flaw | None:
        """Return what makes it no key that could be sent; None where it could."""
        if any(letter.isspace() for letter in self._value):
            return "space"
        return None if all("!" <= letter <= "~" for letter in self._value) else "not_ascii"

    def __bool__(self) -> bool:
        return bool(self._value)

    def __repr__(self) -> str:
        return f"Secret({HIDDEN})"

    __str__ = __repr__

    def __format__(self, _: str) -> str:
        return repr(self)

    def __reduce__(self) -> str | tuple[object, ...]:
        raise TypeError("a secret is not stored")


def _bare(value: str) -> str:
    value = value.strip()
    if len(value) >= 2 and _QUOTES.get(value[0]) == value[-1]:
        return value[1:-1].strip()
    return value


def _forms(value: str) -> tuple[str, ...]:
    """Return it as a text may show it: as it is, in a URL, in Python's and JSON's quotation marks."""
    return (
        value, quote(value, safe=""), quote(value), value.encode("unicode_escape").decode("ascii"),
        repr(value)[1:-1], json.dumps(value)[1:-1],
    )  # fmt: skip


def scrub(text: str, secret: Secret | None) -> str:
    """Return the text without the key, however it was quoted, and without anything that looks like one."""
    value = secret.reveal() if secret is not None else ""
    if len(value) >= _SHORTEST:
        for form in _forms(value):
            text = text.replace(form, HIDDEN)
    return (_LOOKS_LIKE_ONE if "***" in text else _HAS_NO_ASTERISKS).sub(HIDDEN, text)


class PieceScrubber:
    """Takes the key out of a text that arrives in pieces.

    What might be the beginning of the key is held back until the next piece tells; ordinary text passes at once.
    """

    def __init__(self, secret: Secret | None) -> None:
        value = secret.reveal() if secret is not None else ""
        self._value = value if len(value) >= _SHORTEST else ""
        self._held = ""

    def feed(self, piece: str) -> str:
        """Return what may be shown now."""
        if not self._value:
            return piece
        text = (self._held + piece).replace(self._value, HIDDEN)
        self._held = self._beginning(text)
        return text[: len(text) - len(self._held)]

    def rest(self) -> str:
        """Return what was held back, when nothing follows."""
        held, self._held = self._held, ""
        return held

    def _beginning(self, text: str) -> str:
        """Return the longest end of the text that the key begins with."""
        for length in range(min(len(self._value) - 1, len(text)), 0, -1):
            if text.endswith(self._value[:length]):
                return text[-length:]
        return ""
