"""Reading fields out of a TOML table, with errors that name the file, the line, the field and what is right.

By hand, because a profile is read on the way to the first motion: a validation library costs more time.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NoReturn

from chatrobot.core.errors import ProfileError
from chatrobot.core.reason import printable
from chatrobot.robots.profile import NONE

# A ROS name, relative or absolute, without substitutions (design.ros2.org, topic and service names).
_TOPIC = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)
_HEADER = re.compile(r"\s*\[\s*([A-Za-z_\"'][\w.\"' -]*?)\s*\]\s*(#.*)?$")
_KEY = re.compile(r"\s*([A-Za-z0-9_.\"' -]+?)\s*=")


@dataclass(frozen=True)
class Range:
    """The numbers a field may have: from `low` (itself only if `with_low`) to `high`, in `unit`."""

    low: float
    high: float
    unit: str
    with_low: bool = False

    def holds(self, value: float) -> bool:
        """Tell whether `value` is in range; NaN never is."""
        return (self.low <= value if self.with_low else self.low < value) and value <= self.high

    def __str__(self) -> str:
        start = f"from {self.low:g} to" if self.with_low else f"above {self.low:g} and at most"
        return f"a number {start} {self.high:g} {self.unit}"


@dataclass(frozen=True)
class Source:
    """The text a profile is read from, and what to call it in an error."""

    file: str
    text: str

    def fail(self, field: str, problem: str, allowed: str) -> NoReturn:
        """Raise the `ProfileError` about `field` (dotted; empty for the file as a whole)."""
        line = self.line_of(field) if field else None
        where = self.file if line is None else f"{self.file}:{line}"
        raise ProfileError(problem, where=f"{where}: {field}" if field else where, allowed=allowed)

    def line_of(self, field: str) -> int | None:
        """The line of `field`, or of the innermost table around it; None if the text has neither."""
        wanted = field.split(".")
        table: list[str] = []
        best, best_depth = None, 0
        for number, line in enumerate(self.text.splitlines(), start=1):
            if header := _HEADER.match(line):
                found = table = _dotted(header[1])
            elif key := _KEY.match(line):
                found = table + _dotted(key[1])
            else:
                continue
            if len(found) > best_depth and wanted[: len(found)] == found:
                best, best_depth = number, len(found)
        return best


def _dotted(key: str) -> list[str]:
    return [part.strip().strip("\"'") for part in key.split(".")]


def _shown(value: object) -> str:
    """`value` for a message: short, however long it is."""
    try:
        text = repr(value)
    except ValueError:  # Python refuses to write out whole numbers of thousands of digits.
        return "a number of thousands of digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


class Table:
    """One table of a profile. Every getter checks what it hands out; all raise `ProfileError`."""

    def __init__(self, data: Mapping[str, object], source: Source, path: str = "") -> None:
        self._data = data
        self._path = path
        self.source = source

    def field(self, key: str) -> str:
        """The dotted name of `key`."""
        return f"{self._path}.{key}" if self._path else key

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def only(self, known: Sequence[str]) -> None:
        """Refuse any key that is not `known`, with the one that was probably meant."""
        for key in self._data:
            if key in known:
                continue
            # Late: only a mistake pays for it.
            from difflib import get_close_matches

            near = get_close_matches(key, known, n=1)
            hint = f"did you mean {near[0]}? " if near else ""
            self.source.fail(self.field(key), "no such field", f"{hint}known here: {', '.join(known)}")

    def table(self, key: str) -> Table:
        """The table under `key`."""
        value = self._get(key, f"a table, [{self.field(key)}]")
        if not isinstance(value, dict):
            self.source.fail(
                self.field(key), f"{_shown(value)} is not a table", f"a table, [{self.field(key)}]"
            )
        return Table(value, self.source, self.field(key))

    def number(self, key: str, allowed: Range) -> float:
        """The finite number under `key`, within `allowed`."""
        return self._number(self.field(key), self._get(key, str(allowed)), allowed)

    def integer(self, key: str, low: int, high: int) -> int:
        """The whole number under `key`, from `low` to `high`."""
        allowed = f"a whole number from {low} to {high}"
        value = self._get(key, allowed)
        if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
            self.source.fail(self.field(key), f"{_shown(value)} is not possible", allowed)
        return value

    def text(self, key: str, meaning: str) -> str:
        """The text under `key`, which may not be blank; `meaning` says in an error what it is for."""
        value = self._get(key, meaning)
        if not isinstance(value, str) or not value.strip():
            self.source.fail(self.field(key), f"{_shown(value)} is not text", meaning)
        if value != printable(value):
            self.source.fail(
                self.field(key), f"{_shown(value)} has control characters", f"{meaning}, in plain text"
            )
        return value

    def choice(self, key: str, choices: Sequence[str]) -> str:
        """One of `choices`."""
        allowed = f"one of: {', '.join(choices)}"
        value = self._get(key, allowed)
        if not isinstance(value, str) or value not in choices:
            self.source.fail(self.field(key), f"{_shown(value)} is not possible", allowed)
        return value

    def is_none(self, key: str) -> bool:
        """Tell whether `key` says that there is no such thing."""
        return self.is_text(key, NONE)

    def topic(self, key: str) -> str:
        """The name of a ROS topic."""
        allowed = "a ROS topic such as cmd_vel or turtle1/pose; leave the line out where there is none"
        value = self._get(key, allowed)
        if not isinstance(value, str) or not _TOPIC.fullmatch(value):
            self.source.fail(self.field(key), f"{_shown(value)} is not a topic name", allowed)
        return value

    def is_table(self, key: str) -> bool:
        """Tell whether a table is under `key`."""
        return isinstance(self._data.get(key), dict)

    def choices(self, key: str, choices: Sequence[str]) -> tuple[str, ...]:
        """A list of some of `choices`."""
        allowed = f"a list of: {', '.join(choices)}"
        value = self._get(key, allowed)
        if not isinstance(value, list) or not all(item in choices for item in value):
            self.source.fail(self.field(key), f"{_shown(value)} is not possible", allowed)
        return tuple(value)

    def is_text(self, key: str, text: str) -> bool:
        """Tell whether `key` holds exactly this word."""
        return self._data.get(key) == text

    def points(self, key: str, coordinate: Range) -> tuple[tuple[float, float], ...]:
        """A list of [x, y] pairs."""
        allowed = f"a list of [x, y] pairs, each {coordinate}"
        value = self._get(key, allowed)
        if not isinstance(value, list):
            self.source.fail(self.field(key), f"{_shown(value)} is not a list", allowed)
        points = []
        for index, pair in enumerate(value, start=1):
            if not isinstance(pair, list) or len(pair) != 2:
                self.source.fail(self.field(key), f"point {index}, {_shown(pair)}, is not a pair", allowed)
            x, y = (self._number(self.field(key), number, coordinate) for number in pair)
            points.append((x, y))
        return tuple(points)

    def _get(self, key: str, allowed: str) -> object:
        if key not in self._data:
            self.source.fail(self.field(key), "is missing", allowed)
        return self._data[key]

    def _number(self, field: str, value: object, allowed: Range) -> float:
        if not isinstance(value, int | float) or isinstance(value, bool):
            self.source.fail(field, f"{_shown(value)} is not a number", str(allowed))
        # Compared before it is converted: TOML has whole numbers that no float can hold.
        if not allowed.holds(value):
            self.source.fail(field, f"{_shown(value)} is out of range", str(allowed))
        return float(value)
