"""One line of plan text, token by token: its units, its numbers, and on a mistake what is allowed at that place."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import NoReturn

from chatrobot.core.errors import PlanTextError

Convert = Callable[[float], float]


def _same(value: float) -> float:
    return value


def _divided(divisor: float) -> Convert:
    """Division, not multiplication: 35 cm is 35/100, the double nearest to 0.35."""
    return lambda value: value / divisor


def _times(factor: float) -> Convert:
    return lambda value: value * factor


def _spellings(**groups: Convert) -> dict[str, Convert]:
    """Keys are spellings joined by two underscores."""
    return {word: convert for words, convert in groups.items() for word in words.split("__")}


LENGTHS: dict[str, Convert] = _spellings(
    m__metre__metres__meter__meters=_same,
    cm__centimetre__centimetres__centimeter__centimeters=_divided(100.0),
    mm__millimetre__millimetres__millimeter__millimeters=_divided(1000.0),
    km__kilometre__kilometres__kilometer__kilometers=_times(1000.0),
    ft__foot__feet=_times(0.3048),
)
TIMES: dict[str, Convert] = _spellings(
    s__sec__secs__second__seconds=_same,
    ms__millisecond__milliseconds=_divided(1000.0),
    min__mins__minute__minutes=_times(60.0),
)
ANGLES: dict[str, Convert] = {
    "°": math.radians,
    **_spellings(
        deg__degree__degrees=math.radians,
        rad__radian__radians=_same,
        rev__turn__turns__revolution__revolutions=_times(2.0 * math.pi),
    ),
}
SPEEDS: dict[str, Convert] = {"m/s": _same, "mps": _same, "cm/s": _divided(100.0), "km/h": _divided(3.6)}
RATES: dict[str, Convert] = {
    "rad/s": _same,
    "radps": _same,
    "deg/s": math.radians,
    "°/s": math.radians,
    "rpm": _times(math.pi / 30.0),
}


def number_text(value: float) -> str:
    """Return the shortest decimal that reads back as `value`; whole numbers without a point."""
    if value == int(value) and abs(value) < 1e15:
        return str(int(value))
    return repr(float(value))


def _degrees_text(angle_rad: float) -> str | None:
    """Return the shortest decimal of degrees that reads back as exactly `angle_rad`, if there is one."""
    degrees = math.degrees(angle_rad)
    if abs(degrees) > 1e15:
        return None
    for digits in (3, 6, 9, 12, 15, 16, 17):
        text = number_text(float(f"{degrees:.{digits}g}"))
        if math.radians(float(text)) == angle_rad:
            return text
    return None


def angle_text(angle_rad: float, *, suffix: str = "", prefer_degrees: bool = True) -> str:
    """Return degrees or radians (`suffix` "/s" for rates), whichever reads back exactly and is shorter to read."""
    in_radians, in_degrees = number_text(angle_rad), _degrees_text(angle_rad)
    if in_degrees is None:
        return f"{in_radians} rad{suffix}"
    shorter = len(in_degrees) - len(in_radians)
    use_degrees = prefer_degrees if shorter == 0 else shorter < 0
    return f"{in_degrees} deg{suffix}" if use_degrees else f"{in_radians} rad{suffix}"


def at_speed(speed_mps: float | None) -> str:
    """Return what a line ends with for a speed; nothing for None."""
    return "" if speed_mps is None else f" at {number_text(speed_mps)} m/s"


def at_rate(rate_radps: float | None) -> str:
    """Return what a line ends with for a rate of turn; nothing for None."""
    return "" if rate_radps is None else f" at {angle_text(rate_radps, suffix='/s', prefer_degrees=False)}"


_TOKEN = re.compile(
    r"""\s*(?:
      (?P<comment>\#.*)
    | "(?P<quoted>(?:[^"\\]|\\.)*)"
    | (?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)
    | (?P<word>[^\W\d_]+(?:/[^\W\d_]+)?|°(?:/s)?)
    | (?P<ignored>[,()])
    | (?P<other>\S)
    )""",
    re.VERBOSE | re.IGNORECASE,
)
_ESCAPE = re.compile(r"\\(.)")


def quote(text: str) -> str:
    """Return `text` as a quoted token. The text must be printable."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


class LineReader:
    """The tokens of one line. Methods that read take the next token or raise PlanTextError.

    Words and units are case-insensitive; commas and brackets between numbers count as spaces; `# …` is a comment.
    """

    def __init__(self, line: str, line_number: int = 0) -> None:
        self.line = line
        self.line_number = line_number
        self._tokens: list[tuple[str, str, int]] = []
        self._next = 0
        for match in _TOKEN.finditer(line):
            kind = str(match.lastgroup)
            if kind == "comment":
                break
            if kind != "ignored":
                self._tokens.append((kind, match.group(kind), match.start(kind)))

    def at_end(self) -> bool:
        """Return True where no token is left."""
        return self._next >= len(self._tokens)

    def fail(self, problem: str, allowed: str = "") -> NoReturn:
        """Raise PlanTextError with the line, the problem and what is allowed."""
        raise PlanTextError(problem, line_number=self.line_number, line=self.line, allowed=allowed)

    def fail_here(self, allowed: str) -> NoReturn:
        """Fail: the next token (or the end of the line) is not what may stand here."""
        if self.at_end():
            self.fail("something is missing at the end", allowed)
        self.fail(f"{self._tokens[self._next][1]!r} is not understood here", allowed)

    def finish(self, allowed: str) -> None:
        """Fail where a token is left. `allowed` names what else could have stood here."""
        if not self.at_end():
            self.fail_here(allowed)

    def peek_word(self) -> str:
        """Return the next token in lower case if it is a word, else ""."""
        if self.at_end():
            return ""
        kind, text, _ = self._tokens[self._next]
        return text.lower() if kind == "word" else ""

    def accept(self, *words: str) -> str:
        """Take the next token if it is one of these words (and say which), else leave it and say ""."""
        word = self.peek_word()
        if word and word in words:
            self._next += 1
            return word
        return ""

    def expect(self, *words: str) -> str:
        """Take the next token, which must be one of these words, and say which."""
        return self.accept(*words) or self.fail_here(" or ".join(repr(word) for word in words))

    @property
    def number_follows(self) -> bool:
        """Return True where the next token is a number."""
        return not self.at_end() and self._tokens[self._next][0] == "number"

    def number(self, allowed: str = "a number") -> float:
        """Take a finite number."""
        if not self.number_follows:
            self.fail_here(allowed)
        value = float(self._tokens[self._next][1])
        if not math.isfinite(value):
            self.fail_here("a number that is not too large")
        self._next += 1
        return value

    def whole_number(self, allowed: str) -> int:
        """Take a whole number."""
        value = self.number(allowed)
        if value != int(value):
            self._next -= 1
            self.fail_here(allowed)
        return int(value)

    def _quantity(self, units: Mapping[str, Convert], default: str, allowed: str) -> float:
        value = self.number(allowed)
        unit = self.peek_word()
        if unit in units:
            self._next += 1
        elif default:
            unit = default
        else:
            self.fail_here(allowed)
        converted = units[unit](value)
        if not math.isfinite(converted):
            self.fail("the number is too large")
        return converted

    def length_m(self) -> float:
        """Take a length; metres where no unit is given."""
        return self._quantity(LENGTHS, "m", "a length such as 0.5 m")

    def duration_s(self) -> float:
        """Take a time; seconds where no unit is given."""
        return self._quantity(TIMES, "s", "a time such as 3 s")

    def angle_rad(self) -> float:
        """Take an angle with its unit."""
        return self._quantity(ANGLES, "", "an angle such as 90 deg or 0.5 rad")

    def speed_mps(self) -> float:
        """Take a speed; m/s where no unit is given."""
        return self._quantity(SPEEDS, "m/s", "a speed such as 0.2 m/s")

    def rate_radps(self) -> float:
        """Take a rate of turn with its unit."""
        return self._quantity(RATES, "", "a rate such as 0.5 rad/s or 30 deg/s")

    def length_or_duration(self) -> tuple[float | None, float | None]:
        """Take (metres, None) or (None, seconds), by the unit."""
        return self._either(LENGTHS, TIMES, "a distance such as 1 m or a time such as 2 s")

    def angle_or_duration(self) -> tuple[float | None, float | None]:
        """Take (radians, None) or (None, seconds), by the unit."""
        return self._either(ANGLES, TIMES, "an angle such as 90 deg or a time such as 2 s")

    def _either(
        self, first: Mapping[str, Convert], second: Mapping[str, Convert], allowed: str
    ) -> tuple[float | None, float | None]:
        start = self._next
        self.number(allowed)
        unit = self.peek_word()
        self._next = start
        if unit in second:
            return None, self._quantity(second, "", allowed)
        return self._quantity(first, "", allowed), None

    def text(self, allowed: str) -> str:
        """Take a quoted text, or everything up to the end of the line (a comment apart)."""
        if self.at_end():
            self.fail_here(allowed)
        kind, text, start = self._tokens[self._next]
        if kind == "quoted":
            self._next += 1
            return _ESCAPE.sub(r"\1", text)
        if kind == "other" and text == '"':
            self.fail("a quotation mark is not closed", allowed)
        rest = self.line[start:].partition("#")[0].strip()
        self._next = len(self._tokens)
        return rest
