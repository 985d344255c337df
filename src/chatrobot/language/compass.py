"""North, south, east and west: they mean something once it is said which of them the robot faces."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import cache

from chatrobot.language.data_files import load_table
from chatrobot.language.tokens import Atom, quantity

HEADINGS = {
    "north": math.pi / 2, "east": 0.0, "south": -math.pi / 2, "west": math.pi,
    "north_east": math.pi / 4, "north_west": 3 * math.pi / 4,
    "south_east": -math.pi / 4, "south_west": -3 * math.pi / 4,
}  # fmt: skip
"""Directions on a map, radians from east, counter-clockwise (REP-103)."""


@cache
def _convention(language: str) -> re.Pattern[str] | None:
    pattern = load_table(language, "compass").get("convention", {}).get("pattern")
    return re.compile(pattern) if pattern else None


@cache
def _words(language: str) -> dict[str, str]:
    table = load_table(language, "compass").get("compass", {})
    return {word: name for name, listed in table.items() for word in listed}


def split_convention(text: str, language: str) -> tuple[str, float | None]:
    """The text without `you face north`, and the heading that was said, radians on the map."""
    pattern = _convention(language)
    found = pattern.search(text) if pattern else None
    if found is None:
        return text, None
    name = _words(language).get(found["side"])
    if name is None:
        return text, None
    return f"{text[: found.start()]} {text[found.end() :]}".strip(), HEADINGS[name]


def with_headings(atoms: Sequence[Atom], facing_rad: float | None) -> list[Atom]:
    """Points of the compass as headings against the start; unchanged where no convention was said."""
    if facing_rad is None:
        return list(atoms)
    return [
        quantity("heading", math.remainder(HEADINGS[a.value] - facing_rad, 2 * math.pi), a.text)
        if a.kind == "compass"
        else a
        for a in atoms
    ]
