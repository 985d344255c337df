"""Keys and tokens: wrapped so that none is printed by accident, and scrubbed from what providers send back."""

from __future__ import annotations

import re
from urllib.parse import quote

HIDDEN = "•••"
_SHORTEST = 6
"""Shorter "keys" (`none`, `x`) are placeholders; hiding them would mutilate ordinary words."""
_LOOKS_LIKE_ONE = re.compile(
    r"\b(?:sk|pk|rk|gsk|hf|xai)[-_][A-Za-z0-9_\-*]{8,}|\bAIza[A-Za-z0-9_\-*]{8,}|(?i:\bbearer\s+)[A-Za-z0-9._~+/=\-]{8,}"
)


class Secret:
    """A key. `reveal` is the one way to it; printing, formatting, pickling and comparing show nothing."""

    __slots__ = ("_value",)

    def __init__(self, value: str) -> None:
        self._value = value.strip()

    def reveal(self) -> str:
        """The key itself, for the header of a request and for the keyring."""
        return self._value

    def __bool__(self) -> bool:
        return bool(self._value)

    def __repr__(self) -> str:
        return f"Secret({HIDDEN})"

    __str__ = __repr__

    def __format__(self, _: str) -> str:
        return repr(self)

    def __reduce__(self) -> str | tuple[object, ...]:
        raise TypeError("a secret is not stored")


def scrub(text: str, secret: Secret | None) -> str:
    """The text without the key, however it was quoted, and without anything that looks like one."""
    value = secret.reveal() if secret is not None else ""
    if len(value) >= _SHORTEST:
        for form in (value, quote(value, safe=""), value.encode("unicode_escape").decode("ascii")):
            text = text.replace(form, HIDDEN)
    return _LOOKS_LIKE_ONE.sub(HIDDEN, text)


class PieceScrubber:
    """Takes the key out of a text that arrives in pieces.

    What might be the beginning of the key is held back
    until the next piece tells; ordinary text passes at once.
    """

    def __init__(self, secret: Secret | None) -> None:
        value = secret.reveal() if secret is not None else ""
        self._value = value if len(value) >= _SHORTEST else ""
        self._held = ""

    def feed(self, piece: str) -> str:
        """What may be shown now."""
        if not self._value:
            return piece
        text = (self._held + piece).replace(self._value, HIDDEN)
        self._held = self._beginning(text)
        return text[: len(text) - len(self._held)]

    def rest(self) -> str:
        """What was held back, when nothing follows."""
        held, self._held = self._held, ""
        return held

    def _beginning(self, text: str) -> str:
        """The longest end of the text that the key begins with."""
        for length in range(min(len(self._value) - 1, len(text)), 0, -1):
            if text.endswith(self._value[:length]):
                return text[-length:]
        return ""
