"""Words that nobody knows within an order: whether it may need them.

What follows a number may be its unit, and what follows a verb may be what is moved, so that nothing is read without it.
"""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.language.data_files import relation_words
from chatrobot.language.left_out import (
    BEARING,
    COUNTED,
    EXTENTS,
    TOLD,
    kind_of,
    names_way,
)
from chatrobot.language.lexicon import lexicon
from chatrobot.language.signs import BINDING, DEPENDING, Clause, Names, Sign, clauses_of

_KEPT = (BINDING | DEPENDING | {"report", "sees", "did", "does", "doing", "past", "earlier"}) - {"please"}
"""Labels of words that are never left out as words that nobody knows."""
_BARE = frozenset({"VERB", "PACE"})
_DOES = frozenset({"DIR", "ROT", "SHAPE", "ROLE", "PER", "FLAG", "MULTIPLE", "FULLTURN"})
_MAKE = (("verb", "make"),)


def may_be_needed(clause: Clause, names: Names) -> bool:
    """Whether a word in it that nobody knows may be what is done, how far, with what or to what."""
    signs = clause.signs
    at = 0
    while at < len(signs):
        end = at
        while end < len(signs) and not signs[end].moves and _is_strange(signs[end], names):
            end += 1
        words = [unit for sign in signs[at:end] for unit in sign.text.split("_")]
        if end > at and (any(map(names_way, words)) or _is_needed(signs, at, end) or _is_number(signs, end)):
            return True
        at = end + 1
    return False


def _is_needed(signs: Sequence[Sign], at: int, after: int) -> bool:
    """Whether the words from `at` on may be what is done, how much of it, or with what: `wait for zorblax`.

    Or something is said of them: `the zorblax is 2 m long`.
    """
    said = signs[at].text if not signs[at].text.isascii() else ""
    if any(word in said for word in relation_words("words") if not word.isascii()):
        return True
    if at and kind_of(signs[at - 1]) == "conn" and not any(s.label in ("UNIT", "FLAG") for s in signs[at:]):
        return True  # what else is to be done: `and blorp the frobnicator`
    if after < len(signs) and signs[after].label in TOLD:
        return True
    moving = {sign.label for sign in signs if sign.moves}
    if "VERB" in moving:
        return moving <= _BARE or _is_of_something_else(signs, at)
    sized = moving & COUNTED and not any(label in _DOES or label.islower() for label in moving)
    return bool(sized) or _is_of_something_else(signs, at)


def _is_of_something_else(signs: Sequence[Sign], at: int) -> bool:
    """Whether the word at `at` is what else is moved, or what it is said of: 把椅子往左挪, `that gate swings left`.

    Or it says where the motion is done: `around the fern`.
    """
    if any(sign.text in relation_words("moved") for sign in signs[:at]):
        return True
    begin = at
    while begin and _is_light(signs[begin - 1]):
        begin -= 1
    before = signs[begin - 1] if begin else None
    if before and not before.moves and before.text in relation_words("words") - relation_words("towards"):
        return True
    if not any(sign.text in relation_words("articles") for sign in signs[begin:at]):
        return False
    if before and before.label == "VERB":  # what is drawn is no thing
        return lexicon().words.get(tuple(before.text.split("_"))) != _MAKE
    first = next((i for i, sign in enumerate(signs) if sign.label != "opening"), 0)
    return not begin and signs[first].text in relation_words("articles")


def _is_number(signs: Sequence[Sign], at: int) -> bool:
    """Whether a number without a unit stands there: `forklift 3`."""
    if at >= len(signs) or signs[at].label != "NUMBER" or not signs[at].moves:
        return False
    return next((sign.label for sign in signs[at:] if sign.label not in COUNTED), "") not in EXTENTS


def _is_light(sign: Sign) -> bool:
    """Whether it may be left out, if it says nothing that anybody knows: neither of motion nor what bears on it."""
    if sign.moves or sign.is_name or sign.label in _KEPT:
        return False
    return all(
        (unit[:1].isalpha() or unit == "-") and unit not in relation_words("words") and not names_way(unit)
        for unit in (sign.text.replace("_", "") if not sign.text.isascii() else "", *sign.text.split("_"))
        if unit
    )


def _is_strange(sign: Sign, names: Names) -> bool:
    words = lexicon().words
    return not any((unit,) in words or (unit,) in names for unit in sign.text.split("_"))


def is_bound(text: str, names: Names) -> bool:
    """Whether a text has words that quote, deny or depend, so that no single word can be left out beside them."""
    labels = {sign.label for clause in clauses_of(text, names) for sign in clause.signs}
    return bool(labels & ((BEARING | {"not", "condition"}) - {"question"}))


def is_complete(text: str, names: Names) -> bool:
    """Whether what is left says how much, or how often."""
    return any(sign.label in EXTENTS for clause in clauses_of(text, names) for sign in clause.signs)
