"""An order without the words that nobody knows, for a proposal: each alone, with the small words around it, or its clause.

Left out is only what can hold no part of the order: every number, way and word of motion stays, and so does every word
that denies, bounds, compares or asks. What follows a number may be its unit, so that nothing is read without it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import NamedTuple

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.signs import BINDING, DEPENDING, Clause, Names, Sign, clauses_of
from chatrobot.language.typos import correct, neighbours_of
from chatrobot.language.unclear import Unclear

Reader = Callable[[str], Interpretation]

_MARKS = " ,.;:!?…。—~\n"
_KEPT = (BINDING | DEPENDING | {"report", "sees", "did", "does", "doing", "past", "earlier"}) - {"please"}
"""Labels of words that are never left out."""
_COUNTED = frozenset({"NUMBER", "FRACTION", "SCALE", "COUNTER"})
"""Labels of words after which a word that nobody knows may be a unit, or what is counted."""
_EXTENTS = frozenset({"NUMBER", "UNIT", "DIR", "ROT", "SHAPE", "FULLTURN", "TIMES", "FRACTION", "SCALE"})
_POINTING = frozenset({"other", "same", "again"})
"""Labels of words after which a word that nobody knows is the name of what was done: `that dose`."""
_MOST_READ, _MOST_LEFT_OUT = 16, 3


class Pared(NamedTuple):
    """What the rest means, and what was left out; `points`: each word left out only named the motion before."""

    meant: Interpretation
    text: str
    left_out: tuple[str, ...]
    points: bool


class _Shorter(NamedTuple):
    text: str
    left_out: str
    points: bool


def pared(text: str, names: Names, problem: Unclear, read: Reader) -> Pared | None:
    """The likeliest order in `text`, where `read` raised `problem`; None where no word can be left out."""
    reads = 0

    def tried(text: str, problem: Unclear, before: tuple[_Shorter, ...]) -> Pared | None:
        nonlocal reads
        if problem.refused or problem.code != "unknown_part" or len(before) >= _MOST_LEFT_OUT:
            return None
        for shorter in _shorter(text, names, problem.part):
            left_out = (*before, shorter)
            reads += 1
            if reads > _MOST_READ:
                return None
            try:
                meant = read(shorter.text)
            except Unclear as stumbled:
                found = tried(shorter.text, stumbled, left_out)
                if found is not None:
                    return found
                continue
            if meant.plan is not None:
                words = tuple(part.left_out for part in left_out)
                return Pared(meant, shorter.text, words, all(part.points for part in left_out))
        return None

    return tried(text, problem, ())


def mistyped(text: str, problem: Unclear, read: Reader) -> Interpretation | None:
    """What `text` means with one typing error mended that makes another word of it; None where that is not sure."""
    if problem.refused or problem.code != "unknown_part" or text.split().count(problem.part) != 1:
        return None
    found: list[Interpretation] = []
    for known in neighbours_of(problem.part):
        try:
            meant = read(" ".join(known if word == problem.part else word for word in text.split()))
        except Unclear:
            continue
        if meant.plan is not None and meant.plan not in [other.plan for other in found]:
            found.append(meant)
    return found[0] if len(found) == 1 else None


def _shorter(text: str, names: Names, part: str) -> Iterator[_Shorter]:
    """`text` without `part`, the narrowest first."""
    at = _place_of(part, text)
    clauses = clauses_of(text, names)
    clause = next((clause for clause in clauses if clause.start <= at < clause.stop), None)
    if at < 0 or clause is None:
        return
    signs = clause.signs
    held = [i for i, sign in enumerate(signs) if at <= sign.start < at + len(part)]
    if not held or not all(_is_light(sign) for sign in signs):
        held = held if held and all(_is_light(signs[i]) for i in held) else []
    if not held or any(sign.label == "not" for sign in signs):
        return
    first, last = held[0], held[-1]
    if first and signs[first - 1].label in _COUNTED:
        return
    points = bool(first) and signs[first - 1].label in _POINTING
    if all(_is_strange(signs[i], names) for i in held):
        yield _without(text, clause, first, last, points=points)
    while first and _is_light(signs[first - 1]):
        first -= 1
    while last + 1 < len(signs) and _is_light(signs[last + 1]):
        last += 1
    is_whole = first == 0 and last + 1 == len(signs)
    if last + 1 - first > len(held) and not (first and signs[first - 1].label in _COUNTED):
        yield _without(text, clause, first, last, points=points or is_whole)
    elif is_whole and len(clauses) > 1:
        yield _without(text, clause, first, last, points=True)


def _without(text: str, clause: Clause, first: int, last: int, *, points: bool) -> _Shorter:
    """`text` without those signs of a clause; without its mark, too, where nothing else is left of it."""
    start = clause.signs[first].start
    is_end = last + 1 == len(clause.signs)
    stop = clause.stop if is_end else clause.signs[last + 1].start
    said = text[start:stop].strip(_MARKS)
    if is_end and first:
        stop = start + len(text[start:stop].rstrip(_MARKS))
    return _Shorter(" ".join(f"{text[:start]} {text[stop:]}".split()).strip(" ,;:"), said, points)


def _place_of(part: str, text: str) -> int:
    """Where `part` stands in the text, be it mistyped there; below 0 where it does not."""
    at = text.find(part)
    if at >= 0:
        return at
    return next((text.find(unit) for unit in cut(text) if len(unit) > 2 and correct(unit) == part), -1)


def _is_light(sign: Sign) -> bool:
    """Whether it may be left out, if it says nothing that anybody knows: neither of motion nor what bears on it."""
    words = sign.text.split("_")
    return not (
        sign.moves
        or sign.is_name
        or sign.label in _KEPT
        or any(not unit.isalpha() or unit in _bearing() for unit in words)
    )


def _is_strange(sign: Sign, names: Names) -> bool:
    words = lexicon().words
    return not any((unit,) in words or (unit,) in names for unit in sign.text.split("_"))


def bears(text: str, names: Names) -> bool:
    """Whether a text has words that quote, ask or depend, so that nothing can be left out beside them."""
    labels = {sign.label for clause in clauses_of(text, names) for sign in clause.signs}
    return bool(labels & {"condition", "contrast", "correction", "hypothetical", '"', "“", "”", "「", "」"})


def is_complete(text: str, names: Names) -> bool:
    """Whether what is left says how much, or how often."""
    return any(sign.label in _EXTENTS for clause in clauses_of(text, names) for sign in clause.signs)


@lru_cache(maxsize=1)
def _bearing() -> frozenset[str]:
    """Words that say how a motion lies to something else, or bound it."""
    return frozenset(word for code in LANGUAGES for word in load_table(code, "relations").get("words", ()))
