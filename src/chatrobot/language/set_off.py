"""Clauses set off from a whole order: which of them may be left out, and which make it doubtful that it is one.

What an order is for, why it is given, what it is like, and what it is called (`so the cart can get by`, 跟转台似的,
`leaving the dock: …`) has words that nobody lists. What opens such a clause is a closed class, and so is what would
bear on the order: a condition, a time, a report, a denial, a side, a count. Both are `set_off.toml`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import cache

from chatrobot.language.acts import ORDER, Read
from chatrobot.language.data_files import load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.language.rules import Rule, rules
from chatrobot.language.signs import Clause, Sign

_COUNTS = frozenset({"NUMBER", "FRACTION", "SCALE"})
_UNITS = frozenset({"UNIT", "SECOND", "TIMES", "FULLTURN"})
_SIZES = frozenset({"SHAPE", "FULLTURN"})
_WAYS = frozenset({"DIR", "ROT"})
_AGAIN = ("flag", "again")
_MARKS = " ,.;:!。、—~…-"


def set_off(plain: str, reads: Sequence[Read], language: str) -> list[Read]:
    """The clauses of a normalised text that stand beside a whole order and change nothing about it."""
    whole = [i for i, read in enumerate(reads) if _is_whole_order(read)]
    if not whole:
        return []
    found = []
    for i, read in enumerate(reads):
        where = "ahead" if i < whole[0] else "behind"
        if i not in whole and not _has_amount(read.clause) and _is(read.clause, plain, where, language):
            found.append(read)
    return found


def is_doubted(plain: str, clauses: Sequence[Clause], language: str) -> bool:
    """Whether a clause beside an amount says that it is only told of, meant for others, or no order at all."""
    sized = [i for i, clause in enumerate(clauses) if clause.measures]
    if not sized:
        return False
    ahead = any(_is(clause, plain, "doubted_ahead", language) for clause in clauses[: sized[0]])
    return ahead or any(_is(clause, plain, "doubted_behind", language) for clause in clauses[sized[0] + 1 :])


def _is_whole_order(read: Read) -> bool:
    """Whether a clause says what to do and how much, or asks for the motion before once more."""
    return read.log_odds >= ORDER and (_is_sized(read.clause) or any(map(_repeats, read.clause.signs)))


def _repeats(sign: Sign) -> bool:
    return sign.label == "FLAG" and _AGAIN in lexicon().words.get(tuple(sign.text.split("_")), ())


def _is_sized(clause: Clause) -> bool:
    labels = [sign.label for sign in clause.signs]
    return bool(_SIZES & {*labels}) or any(
        a in _COUNTS and b in _UNITS for a, b in itertools.pairwise(labels)
    )


def _has_amount(clause: Clause) -> bool:
    """Whether it has a number with a unit, or a shape; `you are square with the wall` names none."""
    named = [
        sign for before, sign in zip((None, *clause.signs), clause.signs) if not _is_adjective(before, sign)
    ]
    labels = [sign.label for sign in named]
    if _SIZES & {*labels} or _WAYS & {*labels}:
        return True
    return any(a in _COUNTS and b in _UNITS for a, b in itertools.pairwise(labels))


def _is_adjective(before: Sign | None, sign: Sign) -> bool:
    return before is not None and before.label == "verdict" and sign.label == "SHAPE"


def _is(clause: Clause, plain: str, name: str, language: str) -> bool:
    said = plain[clause.start : clause.stop].strip()
    # A mark tells a heading from a call; a question is never passed over.
    text = said.rstrip(_MARKS) + (clause.end if clause.end in (":", "!") else "")
    return clause.end != "?" and any(rule.is_in(text) for rule in _rules(language, name))


@cache
def _rules(language: str, name: str) -> tuple[Rule, ...]:
    table = load_table(language, "set_off")
    return rules(f"set_off_{language}_{name}", [(rule, "") for rule in table[name]], table["parts"])
