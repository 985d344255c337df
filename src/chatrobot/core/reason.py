"""Why something was refused, limited or ended: a code with numbers, put into words only at the very end.

Motion and the governor know no language. They say `Reason("obstacle_ahead", {"distance_m": 0.4})`; the phrase
tables of `language` turn that into a sentence in the language of the question. How numbers and names from outside are
written there is below.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Value = float | int | str


@dataclass(frozen=True)
class Reason:
    """A machine-readable reason. `code` is snake_case, `values` carry units in their names."""

    code: str
    values: Mapping[str, Value] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if "code" in self.values:
            raise ValueError(
                f"a value of {self.code!r} is named 'code': it would hide the reason's own in JSON"
            )

    def to_json(self) -> dict[str, Any]:
        """Make its JSON object, the code beside the values."""
        return {"code": self.code, **self.values}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Reason:
        """Read what `to_json` made."""
        values = {key: value for key, value in data.items() if key != "code"}
        return cls(str(data["code"]), values)


LENGTH_PLACES, ANGLE_PLACES = 3, 1
_NOISE = 1e-6
"""What is smaller is rounding of floats, and nothing that anybody has asked for."""


def fixed(value: float, decimals: int) -> str:
    """`value` with exactly so many decimals; what is rounded to nothing has no sign."""
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if not float(text) else text


def number(value: float, decimals: int = LENGTH_PLACES) -> str:
    """`value` with at most so many decimals. One that is smaller, and no noise, keeps its first digit."""
    text = fixed(value, decimals)
    if not float(text) and abs(value) >= _NOISE:
        return fixed(value, -_exponent(value))
    return text.rstrip("0").rstrip(".") if "." in text else text


def _exponent(value: float) -> int:
    """Of ten, where the first digit of `value` stands."""
    return int(f"{value:e}".partition("e")[2])


SHOWN_CHARS, QUOTED_CHARS = 300, 40


def one_line(text: str, max_chars: int = SHOWN_CHARS) -> str:
    """Printable text on one line: control characters, line breaks and direction marks become spaces."""
    tidy = " ".join("".join(char if char.isprintable() else " " for char in text[: 4 * max_chars]).split())
    return tidy if len(tidy) <= max_chars else f"{tidy[: max_chars - 1]}…"


_OBEYED = (
    *range(9),
    *range(11, 32),
    *range(127, 160),
    0x200E,
    0x200F,
    *range(0x202A, 0x202F),
    *range(0x2066, 0x206A),
)
_SHOWN = dict.fromkeys(_OBEYED, " ")
"""What a terminal obeys instead of showing it, but for tabs and line breaks: control characters, direction marks."""


def printable(text: str) -> str:
    """Text from a file or a person that changes nothing in a terminal but what is read there."""
    return text.translate(_SHOWN)


def quoted(text: str) -> str:
    """A name from outside as a quoted string: it cannot end its quotation, nor begin a line of its own."""
    return json.dumps(one_line(text, QUOTED_CHARS), ensure_ascii=False)
