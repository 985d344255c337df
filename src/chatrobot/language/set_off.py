"""Clauses set off from a whole order: which of them may be left out, and which make it doubtful that it is one.

What an order is for, why it is given, what it is like, and what it is called (`so the cart can get by`, 跟转台似的,
`leaving the dock: …`) has words that nobody lists. What opens such a clause is a closed class, and so is what would
bear on the order: a condition, a time, a report, a denial, a side, a count. Both are `set_off.toml`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import cache

from chatrobot.language.acts import ORDER, Read, order_log_odds, read_acts, without
from chatrobot.language.data_files import load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.language.rules import Rules, rules
from chatrobot.language.signs import Clause, Names, Sign

_COUNTS = frozenset({"NUMBER", "FRACTION", "SCALE"})
_UNITS = frozenset({"UNIT", "SECOND", "TIMES", "FULLTURN"})
_SIZES = frozenset({"SHAPE", "FULLTURN"})
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_AGAIN = ("flag", "again")
_MARKS = " ,.;:!。、—~…-"


def set_off(plain: str, reads: Sequence[Read], language: str, names: Names = ()) -> list[Read]:
    """The clauses of a normalised text that stand beside a whole order and change nothing about it."""
    first = next((i for i, read in enumerate(reads) if _is_whole(read.clause)), len(reads))
    found = [
        read
        for i, read in enumerate(reads)
        if not has_amount(read.clause)
        and _is(read.clause, plain, "ahead" if i < first else "behind", language)
    ]
    ordered = [read for read in reads if read not in found]
    if not found or not any(_is_whole(read.clause) for read in ordered):
        return []
    return found if odds_without(plain, reads, found, names) >= ORDER else []


def odds_without(plain: str, reads: Sequence[Read], left_out: Sequence[Read], names: Names = ()) -> float:
    """The odds that a text orders something where some of its clauses are not said, or where they are."""
    rest = without(plain, reads, left_out)
    odds = order_log_odds(reads)
    return max(odds, order_log_odds(read_acts(rest, names))) if rest else odds


def is_doubted(plain: str, clauses: Sequence[Clause], language: str) -> bool:
    """Whether a clause beside an amount says that it is only told of, meant for others, or no order at all."""
    first = next((i for i, clause in enumerate(clauses) if clause.measures), None)
    if first is None:
        return False
    headings = (clause for clause in clauses[:first] if clause.end == ":")
    others = (clause for clause in clauses[first + 1 :] if not _is_order_of_its_own(clause))
    return any(_is(clause, plain, "doubted_ahead", language) for clause in headings) or any(
        _is(clause, plain, "doubted_behind", language) for clause in others
    )


def _is_order_of_its_own(clause: Clause) -> bool:
    return has_amount(clause) and any(sign.label in _DOES for sign in clause.signs)


def _is_whole(clause: Clause) -> bool:
    """Whether a clause says what to do and how much, or asks for the motion before once more."""
    return (clause.moves and has_amount(clause)) or any(map(_repeats, clause.signs))


def _repeats(sign: Sign) -> bool:
    return sign.label == "FLAG" and _AGAIN in lexicon().words.get(tuple(sign.text.split("_")), ())


def has_amount(clause: Clause) -> bool:
    """Whether it has a number with a unit, or a shape; `you are square with the wall` names none."""
    before: Sequence[Sign | None] = (None, *clause.signs)
    labels = [sign.label for last, sign in zip(before, clause.signs) if not _is_adjective(last, sign)]
    return bool(_SIZES & {*labels}) or any(
        a in _COUNTS and b in _UNITS for a, b in itertools.pairwise(labels)
    )


def _is_adjective(before: Sign | None, sign: Sign) -> bool:
    return before is not None and before.label == "verdict" and sign.label == "SHAPE"


def _is(clause: Clause, plain: str, name: str, language: str) -> bool:
    said = plain[clause.start : clause.stop].strip()
    # A mark tells a heading from a call; a question is never passed over.
    text = said.rstrip(_MARKS) + (clause.end if clause.end in (":", "!") else "")
    return clause.end != "?" and _rules(language, name).any_in(text)


def without_goals(plain: str, language: str) -> str:
    """A normalised text without what an amount is driven to, from or along: `go 2 m to the copier`; else ``""``."""
    left = _goals(language).applied(plain)
    return left if left != plain else ""


@cache
def _goals(language: str) -> Rules:
    table = load_table(language, "set_off")
    return rules(f"goals_{language}", table.get("goals", ()), table["parts"])


@cache
def _rules(language: str, name: str) -> Rules:
    table = load_table(language, "set_off")
    return rules(f"set_off_{language}_{name}", [(rule, "") for rule in table[name]], table["parts"])
