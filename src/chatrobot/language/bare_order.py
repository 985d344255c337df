"""An order without what is said beside it and nobody knows: `back up like 8 inches ur on my screwdriver`.

What follows the last word of motion of a clause is parted from it by a comma, so that it can be told for an aside.
Where nothing else can be read, clauses that tell no amount or way are left out, for a proposal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from chatrobot.language.data_files import relation_words
from chatrobot.language.lexicon import lexicon
from chatrobot.language.pared import names_way
from chatrobot.language.set_off import has_amount
from chatrobot.language.signs import Clause, Names, Sign, clauses_of

_IDLE = frozenset({"VERB", "PLACE"})
"""Labels of words of motion that people say of other things, too; every other one is part of the order."""
_ENDS = frozenset({"UNIT", "SECOND", "DIR", "ROT", "SHAPE", "FULLTURN", "TIMES"})
"""Labels of words that an order may end on."""
_TELLS = frozenset({"verdict", "did", "does", "past", "earlier", "report", "sees", "kin", "thing", "later"})
"""Labels of words of what is told: nothing is parted from a clause with one of them."""
_PREDICATES = frozenset({"verdict", "did", "does", "past", "later", "condition"})
"""Labels of words that say something of what stands before them, or put it off."""
_BEARS = frozenset({"not", "correction", "hypothetical", "contrast", "question", *'"“”「」『』'})
"""Labels of words that bear on the order, so that what has them is not left out."""
_LEAST = 2
"""One word alone may be part of a name: `like a ring main`."""
_MARKS = " ,.;:!?…。—~\n"


class Bare(NamedTuple):
    """What is kept of a text, and what is left out of it."""

    text: str
    left_out: tuple[str, ...]


def with_tails_parted(plain: str, names: Names = ()) -> str:
    """A normalised text with a comma between the last word of motion of each clause and what nobody knows behind it."""
    parts, start = [], 0
    for clause in clauses_of(plain, names):
        tail = _tail(clause)
        if tail is not None:
            parts.append(plain[start : tail.start].rstrip() + ", ")
            start = tail.start
    return "".join((*parts, plain[start:]))


def bare_orders(plain: str, names: Names = ()) -> Iterator[Bare]:
    """What may be the order in a normalised text, what leaves out the least first."""
    clauses = clauses_of(plain, names)
    seen: list[list[Clause]] = [clauses]
    for leaves_out in (_is_strange, _is_no_motion):
        kept = [clause for clause in clauses if _is_told(clause) or not leaves_out(clause)]
        left_out = [clause for clause in clauses if clause not in kept]
        if kept and kept not in seen and not any(_bears(clause.signs) for clause in left_out):
            seen.append(kept)
            text = " ".join(_said(plain, clause) for clause in kept).strip(" ,;:")
            yield Bare(text, tuple(_said(plain, clause).strip(_MARKS) for clause in left_out))


def _is_told(clause: Clause) -> bool:
    return any(sign.moves and sign.label not in _IDLE for sign in clause.signs)


def _is_strange(clause: Clause) -> bool:
    return not clause.moves or any(map(_is_unknown, clause.signs))


def _is_no_motion(clause: Clause) -> bool:
    return not clause.moves


def _is_unknown(sign: Sign) -> bool:
    return sign.label == sign.text and not sign.moves


def _bears(signs: Sequence[Sign]) -> bool:
    return any(sign.label in _BEARS for sign in signs)


def _said(plain: str, clause: Clause) -> str:
    said = plain[clause.start : clause.stop].strip()
    return said if said[-1:] in _MARKS else said + clause.end


def _tail(clause: Clause) -> Sign | None:
    """The first word behind the last word of motion of a clause that tells an amount; None where there is none."""
    signs = clause.signs
    last = max((i for i, sign in enumerate(signs) if sign.moves and sign.label not in _IDLE), default=-1)
    told, tail = signs[: last + 1], signs[last + 1 :]
    if not has_amount(clause) or signs[last].label not in _ENDS or len(tail) < _LEAST:
        return None
    if not any(map(_is_unknown, tail)) or any(map(_is_unknown, told)) or tail[0].text in _relations():
        return None
    if any(sign.label in _TELLS for sign in told) or _goes_on(tail[0]):
        return None
    if any(sign.label in _PREDICATES for sign in tail[:2]):
        return None
    bears = _bears(tail) or any(sign.label in ("later", "condition") or names_way(sign.text) for sign in tail)
    return None if bears else tail[0]


def _relations() -> frozenset[str]:
    return relation_words("words") | relation_words("towards") | relation_words("restricting")


def _goes_on(sign: Sign) -> bool:
    """`go forward 1 m and frobnicate`: whether what follows may be another order."""
    meaning = lexicon().words.get(tuple(sign.text.split("_")), (("", ""),))
    return sign.label in ("opening", "hence", "joint") or meaning[0][0] == "conn"
