"""Text → atoms: the known words in it, by the cheapest way to cover it.

What no word covers stays `unknown`.
"""

from __future__ import annotations

from typing import NamedTuple

from chatrobot.language.compiled import Key
from chatrobot.language.lexicon import Lexicon, Meaning, cut
from chatrobot.language.typos import correct

_DIGITS = frozenset("零一二两三四五六七八九十半")

_MEASURED = frozenset("长宽高")

_WORD, _GUESS, _UNKNOWN = 1.0, 2.2, 6.0

_HEARD, _NAMED, _BEARING = 0.8, -0.1, 0.5
"""A word that nobody reads, though it bears on what is meant, is cheaper than words that sound like its parts."""


SILENT = frozenset({"sep", "conn", "filler", "glue", "reason"})
"""Kinds of atoms that say nothing by themselves about what is to be done."""


class Atom(NamedTuple):
    """A word and what it means. `value` is the key of the data files.

    Numbers and quantities carry `number`.
    """

    kind: str
    value: str = ""
    text: str = ""
    number: float = 0.0
    role: str = ""


def quantity(dimension: str, value: float, text: str, role: str = "") -> Atom:
    """An atom that is a quantity in SI units."""
    return Atom("q", dimension, text, value, role)


def tokenise(text: str, words: Lexicon, names: dict[Key, Meaning], *, by_ear: bool = False) -> list[Atom]:
    """The atoms of a normalised text. `names` are words of this dialogue: places, words a person defined.

    `by_ear`: what sounds like a longer word is that word rather than the shorter ones it is written with.
    """
    units = _corrected(cut(text), words, names)
    covered = _cover(units, words, names, _HEARD if by_ear else _GUESS)
    atoms: list[Atom] = []
    for start, end, meaning in covered:
        written = joined(units[start:end])
        if meaning is None:
            atoms.append(_bare(units[start]))
        else:
            atoms.extend(Atom(kind, value, written) for kind, value in meaning)
    return atoms


def _corrected(units: Key, words: Lexicon, names: dict[Key, Meaning]) -> Key:
    known_names = {unit for key in names for unit in key}

    def is_right(unit: str) -> bool:
        known = unit in words.known or unit in known_names or (unit,) in words.guesses
        return len(unit) < 3 or known

    mended = tuple(unit if is_right(unit) else correct(unit) for unit in units)
    # A place is never guessed: it is asked about.
    return tuple(unit if (said,) in names else said for unit, said in zip(units, mended))


def _bare(unit: str) -> Atom:
    if unit[0].isdecimal() or (unit[0] == "." and len(unit) > 1):
        return Atom("number", unit.replace(",", ""), unit)
    if unit == "\n":
        return Atom("sep", "strong", unit)
    return Atom("unknown", unit, unit)


_START: Meaning = (("flag", "to_start"),)


def _cover(
    units: Key, words: Lexicon, names: dict[Key, Meaning], guess: float
) -> list[tuple[int, int, Meaning | None]]:
    """Dynamic programming from the end: the fewest words, unknown units only where nothing else fits."""
    count = len(units)
    name_length = max((len(key) for key in names), default=0)
    named = _places_of(units, names)
    best = [0.0] * (count + 1)
    choice: list[tuple[int, Meaning | None]] = [(0, None)] * count
    for start in range(count - 1, -1, -1):
        unit = units[start]
        cost = _WORD if unit[0].isdigit() else _UNKNOWN
        best[start], choice[start] = best[start + 1] + cost, (start + 1, None)
        longest = max(words.longest.get(unit, 0), name_length)
        for end in range(start + 1, min(start + longest, count) + 1):
            key = units[start:end]
            if key not in names and any(start < begin < end < stop for begin, stop in named):
                continue  # `to the front` of `drive to the front door`, where the front door is a place
            meaning, price = _meaning_and_price(key, words, names, guess)
            if meaning is None or (end < count and _goes_on(key, units[end], meaning)):
                continue
            if meaning == _START and any(start < begin and end == stop for begin, stop in named):
                continue  # `to the base`, where the base is a place
            if best[end] + price <= best[start]:
                best[start], choice[start] = best[end] + price, (end, meaning)
    covered = []
    at = 0
    while at < count:
        end, meaning = choice[at]
        covered.append((at, end, meaning))
        at = end
    return covered


def _places_of(units: Key, names: dict[Key, Meaning]) -> list[tuple[int, int]]:
    """Where each name begins and ends."""
    return [
        (at, at + len(key)) for key in names for at in range(len(units)) if units[at : at + len(key)] == key
    ]


def _meaning_and_price(
    key: Key, words: Lexicon, names: dict[Key, Meaning], guess: float
) -> tuple[Meaning | None, float]:
    """What these units mean as one word, and what it costs to read them so."""
    meaning = names.get(key) or words.words.get(key)
    if meaning is None:
        return words.guesses.get(key), guess
    if meaning[0][0] == "unknown":
        return meaning, _BEARING
    return meaning, _NAMED if key in names else _WORD


def _goes_on(key: Key, after: str, meaning: Meaning) -> bool:
    """Whether a word ends in what begins the number behind it: 一点|二米, or the width of 长一米宽|半米."""
    if key[-1] == "点" and after in _DIGITS and len(key) > 1 and key[0] == "一":
        return True
    return key[-1] in _MEASURED and _is_digit(after) and meaning[0][0] == "unit_length"


def _is_digit(unit: str) -> bool:
    return unit in _DIGITS or unit[0].isdigit()


def joined(units: Key) -> str:
    """Units as they are written: Chinese ones without blanks."""
    return ("" if ord(units[0][0]) > 0x2E7F else " ").join(units)
