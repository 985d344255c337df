"""Numbers and foreign text as people and models are shown them."""

from __future__ import annotations

import json

LENGTH_PLACES, ANGLE_PLACES = 3, 1
_NOISE = 1e-6
"""What is smaller is rounding of floats, and nothing that anybody has asked for."""


def fixed(value: float, places: int) -> str:
    """`value` with exactly so many decimals; what is rounded to nothing has no sign."""
    text = f"{value:.{places}f}"
    return text.lstrip("-") if not float(text) else text


def number(value: float, places: int = LENGTH_PLACES) -> str:
    """`value` with at most so many decimals. One that is smaller, and no noise, keeps its first digit."""
    text = fixed(value, places)
    if not float(text) and abs(value) >= _NOISE:
        return fixed(value, -_exponent(value))
    return text.rstrip("0").rstrip(".") if "." in text else text


def _exponent(value: float) -> int:
    """Of ten, where the first digit of `value` stands."""
    return int(f"{value:e}".partition("e")[2])


SHOWN_CHARS = 300


def one_line(text: str, limit: int = SHOWN_CHARS) -> str:
    """Printable text on one line: control characters, line breaks and direction marks become spaces."""
    tidy = " ".join("".join(char if char.isprintable() else " " for char in text[: 4 * limit]).split())
    return tidy if len(tidy) <= limit else f"{tidy[: limit - 1]}…"


def quoted(text: str, limit: int = 40) -> str:
    """A name from outside as a quoted string: it cannot end its quotation, nor begin a line of its own."""
    return json.dumps(one_line(text, limit), ensure_ascii=False)
