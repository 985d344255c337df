"""Texts cut into units, and phrases of them: a unit is a Latin word or one Chinese character."""

from __future__ import annotations

import re
from functools import lru_cache

from chatrobot.reflex import words

_WORD = re.compile(r"[a-zß-öø-ÿ0-9]+(?:['’][a-zß-öø-ÿ]+)*|[\u3400-\u9fff]")
_STRETCHED = re.compile(r"(.)\1{2,}")
_WIDE = {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)}
_FOLD = str.maketrans(words.ALL.fold)

Phrase = tuple[str, ...]
Table = dict[str, set[Phrase]]
"""Phrases by their first unit."""


@lru_cache(maxsize=32)
def units_of(text: str) -> Phrase:
    """Several questions are asked about one text: it is cut once."""
    lowered = text.translate(_WIDE).lower().replace("’", "'").replace("-", " ").translate(_FOLD)
    return tuple(_unstretched(word) for word in _WORD.findall(lowered))


def _unstretched(word: str) -> str:
    """`stoooop` → `stop`, `haaalt` → `halt`; other words stay, and so does `stoop`, which is one."""
    short = _STRETCHED.sub(r"\1", word)
    single = re.sub(r"(.)\1+", r"\1", short)
    return single if single in words.ALL.stretched and word not in words.ALL.not_stretched else short


def phrases(*groups: tuple[str, ...]) -> Table:
    """By their first unit."""
    found: Table = {}
    for group in groups:
        for phrase in group:
            units = units_of(phrase)
            found.setdefault(units[0], set()).add(units)
    return found


def matches(units: Phrase, i: int, table: Table) -> list[Phrase]:
    """The phrases that begin there."""
    return [p for p in table.get(units[i], ()) if units[i : i + len(p)] == p]


def consists(units: Phrase, table: Table, fillers: Table) -> bool:
    """Whether phrases of `table` (at least one) and fillers cover all of `units`."""
    reached = {0: False}
    for i in range(len(units)):
        if i not in reached:
            continue
        for phrase in matches(units, i, table):
            reached[i + len(phrase)] = True
        for phrase in matches(units, i, fillers):
            reached[i + len(phrase)] = reached.get(i + len(phrase), False) or reached[i]
    return reached.get(len(units), False)
