"""A reference or a taught place beside talk: `Alright, quitting time, head back to the bay`; 交班了，原路回去.

What points at an earlier turn, at a place that was taught or at the start is whole by itself, so nothing that a clause
beside it tells is wanted for it. Such clauses may hold words that nobody knows, and weaker evidence of talk than
beside other orders.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from chatrobot.language.acts import ORDER, Read, may_be_goal, order_log_odds, without
from chatrobot.language.beside import MAYBE_ASIDE, SURE_ASIDE, Aside, asides, is_reported, refers
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.quoting import names_measure
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Go

_HOLDING = frozenset({"condition", "correction", "contrast"})
"""Labels of words on which it may depend whether the order is meant."""
LEAST = -3.0
"""A clause with lower odds, as a logarithm, is no talk beside a reference."""
_LOOSE = frozenset({"VERB", "UNIT", "COUNTER"})
"""Labels of words of motion that name no amount, way or shape by themselves: `quitting time`."""

Reader = Callable[[str], Interpretation]


def beside_reference(
    plain: str, reads: Sequence[Read], read: Reader, read_anew: Reader
) -> Interpretation | None:
    """The plan of what points at something earlier, where all that stands beside it is talk; None for any other text.

    `read_anew` reads as if nothing had been said before.
    """
    found = asides(reads)
    talk = [
        one for one in reads if _is_talk(one, found.get(one.clause.start)) and not may_be_goal(one, reads)
    ]
    kept = [one for one in reads if one not in talk]
    if not talk or not kept or is_reported(reads, kept):
        return None
    if order_log_odds(kept) < ORDER and not any(refers(one.clause) for one in kept):
        return None
    said = without(plain, reads, talk)
    try:
        meant = read(said)
    except Unclear:
        return None
    return meant if meant.plan is not None and _points(meant, said, read_anew) else None


def _points(meant: Interpretation, said: str, read_anew: Reader) -> bool:
    steps = meant.plan.steps if meant.plan is not None else ()
    if all(isinstance(step, Go) for step in steps):
        return True
    try:
        return read_anew(said).plan != meant.plan
    except Unclear:
        return True


def _is_talk(read: Read, aside: Aside | None) -> bool:
    clause = read.clause
    if aside is None or clause.end == ":" or clause.asks or any(sign.is_name for sign in clause.signs):
        return False
    labels = {sign.label for sign in clause.signs}
    if ("later" in labels and "not" not in labels) or ("hypothetical" in labels and not aside.apart):
        return False
    moving = {sign.label for sign in clause.signs if sign.moves}
    if labels & _HOLDING or not moving <= _LOOSE or refers(clause) or names_measure(clause):
        return False
    return aside.odds >= (SURE_ASIDE if clause.denies or "VERB" in moving else LEAST)


def may_change(read: Read, odds: Mapping[int, Aside]) -> bool:
    """Whether what stands beside a reference may say how it is meant: `the same, leftish`, `the same but opposite`."""
    aside = odds.get(read.clause.start)
    points = any(sign.label in ("contrast", "FLAG") for sign in read.clause.signs)
    return points or aside is None or aside.odds < MAYBE_ASIDE
