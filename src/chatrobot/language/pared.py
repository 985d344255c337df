"""An order without the words that nobody knows, for a proposal: each alone, or with the small words around it.

Left out is only what can hold no part of the order: every number, way and word of motion stays, and so does every word
that denies, bounds, compares or asks. What follows a number may be its unit, so that nothing is read without it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from chatrobot.language.data_files import relation_words
from chatrobot.language.gloss import MARK
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
_SIZES = (_EXTENTS | {"FLAG", "MULTIPLE", "COUNTER"}) - {"SHAPE"}
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE", "ROLE", "PER", "FLAG", "MULTIPLE", "FULLTURN", "place"})
_BARE = frozenset({"VERB", "PACE"})
_TOLD = frozenset({"verdict", "does", "did"})
_POINTING = frozenset({"FLAG", "MULTIPLE"})
"""Labels of words after which a word that nobody knows is the name of what was done: `half that dose`."""
_BEARING = frozenset({"not", "condition", "correction", "hypothetical", *'"“”「」『』'})
_WAYS = frozenset({"dir", "rot", "pace"})
"""Kinds of words that are never left out as part of another."""
_LEAST_OF_WAY = 4
_MAKE = (("verb", "make"),)
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
    if _bears(text, names):
        return None
    reads = 0

    def tried(text: str, part: str, before: tuple[_Shorter, ...]) -> Pared | None:
        nonlocal reads
        for shorter in _shorter(text, names, part):
            left_out = (*before, shorter)
            reads += 1
            if reads > _MOST_READ:
                return None
            try:
                meant = read(shorter.text)
            except Unclear as stumbled:
                again = stumbled.code == "unknown_part" and not stumbled.refused
                found = (
                    tried(shorter.text, stumbled.part, left_out)
                    if again and len(left_out) < _MOST_LEFT_OUT
                    else None
                )
                if found is not None:
                    return found
                continue
            points = all(part.points for part in left_out)
            if meant.plan is not None and (points or _is_complete(shorter.text, names)):
                return Pared(meant, shorter.text, tuple(part.left_out for part in left_out), points)
        return None

    return tried(text, problem.part, ())


def mistyped(text: str, names: Names, problem: Unclear, read: Reader) -> Interpretation | None:
    """What `text` means with one typing error mended that makes another word of it; None where that is not sure."""
    signs = [sign for clause in clauses_of(text, names) for sign in clause.signs]
    if _bears(text, names) or [sign.label for sign in signs if sign.text == problem.part] != [problem.part]:
        return None
    found: list[Interpretation] = []
    for known in neighbours_of(problem.part):
        try:
            meant = read(re.sub(rf"\b{re.escape(problem.part)}\b", known, text, count=1))
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
    if not held or not all(_is_light(signs[i]) for i in held):
        return
    if any(sign.label == "contrast" for sign in signs) or _is_order_of_its_own(signs, held[0]):
        return
    if _is_of_something_else(signs, held[0]):
        return
    opened = _opened(signs, held[0])
    if opened is not None:
        if not any(sign.moves and sign.label in _SIZES for sign in signs[opened : held[-1] + 2]):
            yield _without(text, clause, opened, held[-1], points=False)
        return
    said = text[at : at + len(part)]
    if _is_needed(signs, held[0], held[-1] + 1):
        return
    if any(word in said for word in relation_words("words") if not word.isascii()):
        return
    first, last = held[0], held[-1]
    before, after = first, last + 1
    while before and _is_light(signs[before - 1]):
        before -= 1
    while after < len(signs) and _is_light(signs[after]):
        after += 1
    if _is_counted(signs, first) or _is_number(signs, after) or not (before or _says_how_much(signs)):
        return
    points = bool(before) and signs[before - 1].label in _POINTING
    points &= all(sign.text in relation_words("naming") for sign in signs[before:first])
    if all(_is_strange(signs[i], names) for i in held):
        yield _without(text, clause, first, last, points=points)
    is_whole = before == 0 and after == len(signs)
    if (after - before > len(held) or is_whole) and not _is_counted(signs, before):
        yield _without(text, clause, before, after - 1, points=points or is_whole)


def _opened(signs: Sequence[Sign], at: int) -> int | None:
    """Where a phrase begins that only says what it is like, or what for, and ends at `at`: `like a proper ring main`.

    None where there is none, or all of it may be left out word by word.
    """
    opened = next((i for i, sign in enumerate(signs[:at]) if sign.text in relation_words("opening")), None)
    return opened if opened is not None and any(sign.moves for sign in signs[opened : at + 2]) else None


def _is_order_of_its_own(signs: Sequence[Sign], at: int) -> bool:
    """Whether what else is to be done begins there: `and blorp the frobnicator`."""
    joins = at > 0 and _kind(signs[at - 1]) == "conn"
    return joins and not any(sign.label in ("UNIT", "FLAG") for sign in signs[at:])


def _is_needed(signs: Sequence[Sign], at: int, after: int) -> bool:
    """Whether without the word from `at` on nothing says what is done, or how much: `wait for zorblax`.

    Or something is said of it (`the zorblax is 2 m long`), or it makes another word of its neighbour: 收回.
    """
    if after < len(signs) and (signs[after].label in _TOLD or _is_compound(signs, after)):
        return True
    moving = {sign.label for sign in signs if sign.moves}
    if "VERB" in moving:
        return moving <= _BARE
    if moving == {"SHAPE"} and at and signs[at - 1].label == "SHAPE":
        return True
    return bool(moving & _COUNTED) and not any(label in _DOES or label.islower() for label in moving)


def _is_compound(signs: Sequence[Sign], at: int) -> bool:
    return signs[at].label == "VERB" and len(signs[at].text) == 1 and len(signs) == at + 1


def _kind(sign: Sign) -> str:
    return lexicon().words.get(tuple(sign.text.split("_")), (("", ""),))[0][0]


def _is_of_something_else(signs: Sequence[Sign], at: int) -> bool:
    """Whether the word at `at` is what else is moved, or what it is said of: 把椅子往左挪, `that gate swings left`.

    Or it says where the motion is done: `around the fern`.
    """
    if any(sign.text in relation_words("moved") for sign in signs[:at]):
        return True
    begin = at
    while begin and _is_light(signs[begin - 1]):
        begin -= 1
    governed = begin and not signs[begin - 1].moves and signs[begin - 1].text in relation_words("words")
    if governed and signs[begin - 1].text not in relation_words("towards"):
        return True
    if not any(sign.text in relation_words("articles") for sign in signs[begin:at]):
        return False
    if begin and signs[begin - 1].label == "VERB":  # what is drawn is no thing
        return lexicon().words.get(tuple(signs[begin - 1].text.split("_"))) != _MAKE
    first = next((i for i, sign in enumerate(signs) if sign.label != "opening"), 0)
    return not begin and signs[first].text in relation_words("articles")


def _is_counted(signs: Sequence[Sign], at: int) -> bool:
    """Whether a number stands before it, be it with an article: `half a knot`."""
    while at and signs[at - 1].label == "NUMBER" and not signs[at - 1].moves:
        at -= 1
    return at > 0 and signs[at - 1].moves and signs[at - 1].label in _COUNTED


def _is_number(signs: Sequence[Sign], at: int) -> bool:
    """Whether a number without a unit stands there: `forklift 3`."""
    if at >= len(signs) or signs[at].label != "NUMBER" or not signs[at].moves:
        return False
    after = next((sign.label for sign in signs[at:] if sign.label not in _COUNTED), "")
    return after not in _EXTENTS


def _says_how_much(signs: Sequence[Sign]) -> bool:
    """Whether no number is without its unit, where a word that nobody knows stands for the verb: `change step 2`."""
    moving = {sign.label for sign in signs if sign.moves}
    return not moving & _COUNTED or bool(moving & {"UNIT", "VERB", "SHAPE"})


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
    if sign.moves or sign.is_name or sign.label in _KEPT:
        return False
    return all(
        (unit[:1].isalpha() or unit == "-") and unit not in relation_words("words") and not names_way(unit)
        for unit in (sign.text.replace("_", "") if not sign.text.isascii() else "", *sign.text.split("_"))
        if unit
    )


def names_way(unit: str) -> bool:
    """Whether a way is part of a word that nobody knows: `astarboard`, `rechtsseitig`."""
    word = unit.removesuffix(MARK)
    ways = _ways()
    return (word,) not in lexicon().words and (word.startswith(ways) or word.endswith(ways))


@lru_cache(maxsize=1)
def _ways() -> tuple[str, ...]:
    known = (key[0] for key, meaning in lexicon().words.items() if len(key) == 1 and meaning[0][0] in _WAYS)
    latin = {word for word in known if word.isascii() and len(word) >= _LEAST_OF_WAY}
    return tuple(latin | relation_words("ways"))


def _is_strange(sign: Sign, names: Names) -> bool:
    words = lexicon().words
    return not any((unit,) in words or (unit,) in names for unit in sign.text.split("_"))


def _bears(text: str, names: Names) -> bool:
    """Whether a text has words that quote, deny or depend, so that nothing can be left out beside them."""
    return any(sign.label in _BEARING for clause in clauses_of(text, names) for sign in clause.signs)


def _is_complete(text: str, names: Names) -> bool:
    """Whether what is left says how much, or how often."""
    return any(sign.label in _EXTENTS for clause in clauses_of(text, names) for sign in clause.signs)
