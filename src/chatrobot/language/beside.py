"""How likely a clause beside an order is an aside: it tells, greets or explains, and the order is the same without it.

A log-linear reader of its own, next to `acts.py`: it looks at one clause and where it stands, at classes of words with
all others alike, and at the words and how they end. The weights are fitted by scripts/fit_beside.py, `data/beside.bin`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from chatrobot.language.acts import MAYBE_ORDER, ORDER, Read, order_log_odds, read_acts, without
from chatrobot.language.aside_features import features
from chatrobot.language.fitted import SCALE, slot_of, weights
from chatrobot.language.lexicon import Meaning, lexicon
from chatrobot.language.quoting import names_measure, quotes_ahead, quotes_behind, sentences_of
from chatrobot.language.set_off import has_amount
from chatrobot.language.signs import Clause, Names, Sign

SURE_ASIDE, MAYBE_ASIDE = 0.0, -0.5
"""A clause with higher odds than the first is surely an aside; with higher odds than the second, the order without it
is proposed. Writers that were left out chose them: `fit_beside --check`."""
SURE_BOUND, SURE_BEARING, CLEARLY_ASIDE = 2.0, 2.5, 3.5
"""The first, for a clause with an amount in a sentence of its own, or a condition; one with a count, a denial or a
correction beside the order; that no part of a sentence orders anything."""
SURELY_NOT_MEANT = 1.0
"""A clause with lower odds that asks for what the robot cannot do may be meant: `grab the mug, go forward 1 m`."""
NO_ASIDE = -2.0
"""A clause with lower odds is no aside, whatever else it sounds like: what is ordered beside it is proposed."""
BEARS = -9.0
"""Its odds, where its words say that it is none."""
LEAST_TOLD = 4
"""What has so many words tells something: `nice, that you …` and `two of them` may be part of the order."""
WITHOUT_AMOUNT = 0.7
"""So much less are the odds beside an order that tells no amount: it may be as little of one as they are."""
SOUNDS_ORDERED = 1.5
"""So much less are the odds of a clause that sounds like an order itself: `and then turn away from him`."""
PART_OF_ASIDE, TOGETHER = -3.0, 1.0
"""The clauses of a sentence beside the order have the sum of their odds, less the second, where each has the first."""
_REFERENCES = frozenset(
    ("flag", flag)
    for flag in (
        "again",
        "other_way",
        "same_amount",
        "mirrored",
        "to_start",
        "original_heading",
        "same_way",
        "redo",
    )
) | {("verb", "undo")}
_RETURN, _LEADING = ("verb", "return"), frozenset({("verb", "return"), ("verb", "go")})
_OF_THE_START = frozenset({"did", "other", "robot"})
_OF_FIGURES = frozenset({"other"})
_TO_A_PLACE = frozenset({"to", "other"})
_POLITE = frozenset({"please", "opening", "robot", "request"})
_BOUND = frozenset({"condition", "later"})
_NO_AMOUNTS = frozenset({"VERB", "DIR", "PLACE", "COUNTER", "FLAG"})
_WAYS = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_NUMBERS = frozenset({"NUMBER", "FRACTION", "SCALE"})
_UNITS = frozenset({"UNIT", "SECOND"})
_COUNTING = frozenset({"UNIT", "SECOND", "TIMES", "ROLE"})
"""Labels of words that are part of an amount only beside a number."""
_COUNTED = frozenset({"person", "robot", "thing", "kin"})
"""Labels of words of which a number tells how many there are."""


@dataclass(frozen=True)
class Aside:
    """The odds that a clause is an aside, as a logarithm, and whether its sentence has no part of the order."""

    odds: float
    apart: bool


def asides(reads: Sequence[Read]) -> dict[int, Aside]:
    """How likely each clause but the likeliest order is an aside to it, by where the clause starts."""
    if not reads:
        return {}
    clauses = [read.clause for read in reads]
    order = max(range(len(reads)), key=lambda i: (clauses[i].moves, reads[i].log_odds))
    found: dict[int, Aside] = {}
    for part in sentences_of(clauses):
        apart = order not in part and not any(_may_order(reads[i]) for i in part)
        odds = {i: _odds_of(clauses, i, order, begins=i == part[0]) for i in part if i != order}
        bare = WITHOUT_AMOUNT if _is_bare(clauses[order]) else 0.0
        odds = {
            i: odd - bare - (SOUNDS_ORDERED if _sounds_ordered(reads[i]) else 0.0) for i, odd in odds.items()
        }
        together = sum(odds.values()) - TOGETHER
        pooled = apart and len(part) > 1 and all(_may_be_pooled(clauses[i], odds[i]) for i in part)
        found |= {clauses[i].start: Aside(max(o, together) if pooled else o, apart) for i, o in odds.items()}
    return found


def _may_order(read: Read) -> bool:
    return read.log_odds >= ORDER and read.clause.moves and read.clause.measures


def _is_bare(order: Clause) -> bool:
    """Whether an order tells no amount, and does not ask for the motion before either: `undo that` is whole."""
    return not has_amount(order) and (order.measures or not refers(order))


def _sounds_ordered(read: Read) -> bool:
    return read.log_odds >= ORDER and read.clause.moves


def _may_be_pooled(clause: Clause, odds: float) -> bool:
    return odds >= PART_OF_ASIDE and not _is_bound(clause)


def _is_bound(clause: Clause) -> bool:
    bound = any(sign.label in _BOUND for sign in clause.signs) or clause.begins_next
    return bound or clause.denies or clause.end == ":" or _denies_motion(clause)


def _denies_motion(clause: Clause) -> bool:
    """`unit 4, do not move`: whether a negation and a word of motion stand in it."""
    return clause.moves and any(sign.label == "not" for sign in clause.signs)


def _odds_of(clauses: Sequence[Clause], i: int, order: int, *, begins: bool) -> float:
    """The odds of one clause; those of no aside where its first or last words quote the order or take it back."""
    own = aside_log_odds(clauses, i, order)
    behind = any(map(_says_way, clauses[:i])) and not any(map(_says_way, clauses[i:]))
    if behind:
        quotes = quotes_behind(clauses[i], begins=begins)
    else:
        quotes = i + 1 == order and quotes_ahead(clauses[i], clauses[order])
    return min(own, BEARS) if quotes or names_measure(clauses[i]) else own


def _says_way(clause: Clause) -> bool:
    return clause.measures or any(sign.moves and sign.label in _WAYS for sign in clause.signs)


def is_sure_aside(clause: Clause, found: Mapping[int, Aside]) -> bool:
    """Whether it is surely an aside, and has no amount that could be meant for the order."""
    aside = found.get(clause.start)
    if aside is None or says_motion_alone(clause) or begins_condition(clause):
        return False  # `if it is dry`
    if clause.denies and _denies_motion(clause):
        return False  # `not left, the other one`
    return aside.odds >= _least_odds(clause, aside.apart)


def _least_odds(clause: Clause, apart: bool) -> float:
    """The odds from which a clause is surely an aside, by what in it could bear on the order."""
    labels = {sign.label for sign in clause.signs}
    if labels <= {"opening", "correction"}:
        return math.inf  # `sorry, 5 s`; or what is not said to its end: 左转，那个，就是
    if _may_bear_on_order(clause.signs, apart=True):
        return math.inf if _is_measured(clause.signs) else CLEARLY_ASIDE
    counts = not apart and _may_bear_on_order(clause.signs, apart)
    if counts and len(clause.signs) < LEAST_TOLD:
        return math.inf  # `two of them`
    if counts or clause.denies or "correction" in labels:
        return SURE_BEARING  # `customer in aisle 4 wants a demo`, `not your fault`, `sorry, I dropped my sandwich`
    return SURE_BOUND if clause.tells or _is_bound(clause) or len(clause.signs) == 1 else SURE_ASIDE


def begins_condition(clause: Clause) -> bool:
    """`if it is dry`: whether the order beside it may depend on it."""
    return next((sign.label for sign in clause.signs if sign.label not in _POLITE), "") == "condition"


def says_motion_alone(clause: Clause) -> bool:
    """`left, left, right`: whether every word of it is one of motion."""
    said = [sign for sign in clause.signs if sign.label not in _POLITE and sign.text[:1].isalnum()]
    return bool(said) and all(sign.moves for sign in said)


def _may_bear_on_order(signs: Sequence[Sign], apart: bool) -> bool:
    """Whether it has an amount: in a sentence of its own, a number with a unit or with a way to go."""
    moving = {
        sign.label
        for i, sign in enumerate(signs)
        if sign.moves and sign.label.isupper() and _may_measure(signs, i)
    }
    if not apart:
        return not moving <= _NO_AMOUNTS
    counted = bool(moving & _NUMBERS and moving & _WAYS)
    return _is_measured(signs) or counted or not moving <= _NO_AMOUNTS | _NUMBERS | {"UNIT", "TIMES", "ROLE"}


def _is_measured(signs: Sequence[Sign]) -> bool:
    return any(a.label in _NUMBERS and b.label in _UNITS for a, b in itertools.pairwise(signs))


def _may_measure(signs: Sequence[Sign], i: int) -> bool:
    """Whether a word may be of an amount: no number of what nobody knows (三项专利), no unit alone (馆长)."""
    if signs[i].label in _NUMBERS:
        counted = next((sign for sign in signs[i:] if sign.label not in _NUMBERS), None)
        return counted is None or counted.moves or counted.label not in (counted.text, *_COUNTED)
    return signs[i].label not in _COUNTING or any(
        sign.label in _NUMBERS for sign in (*signs[max(i - 1, 0) : i], *signs[i + 1 : i + 2])
    )


def refers(clause: Clause) -> bool:
    """Whether a clause asks for the motion before, the start or a taught place, and so much: `undo that, please`."""
    known = lexicon().words
    amounts = _NUMBERS | _UNITS
    moving = [sign for sign in clause.signs if sign.moves and sign.label not in amounts]
    said = [known.get(tuple(sign.text.split("_")), ()) for sign in moving if not sign.is_name]
    beside = {sign.label for sign in clause.signs if not sign.moves} - _POLITE
    if len(said) < len(moving):  # a place by its name
        return bool(said) and all(_LEADING & {*meaning} for meaning in said) and beside <= _TO_A_PLACE
    if moving and moving[0] is clause.signs[0] and _RETURN in said[0] and len(moving) == 1:
        return "did" in beside <= _OF_THE_START  # `back to where you started`
    figures = [any(kind == "shape" for kind, _ in meaning) for meaning in said]  # `the triangle again`
    references = [_is_reference(meaning) for meaning in said]
    named = _OF_FIGURES if any(figures) else frozenset[str]()
    return any(references) and all(map(max, references, figures)) and beside <= named


def _is_reference(meaning: Meaning) -> bool:
    return bool(_REFERENCES & {*meaning}) and {*meaning} <= _REFERENCES | {_RETURN, ("flag", "extra")}


def refers_alone(reads: Sequence[Read]) -> bool:
    """Whether all that is ordered asks for the motion before: `undo that, I forgot to film it`."""
    found = asides(reads)
    kept = [read for read in reads if not is_sure_aside(read.clause, found)]
    return len(kept) == 1 and refers(kept[0].clause) and not is_reported(reads, kept)


def is_reported(reads: Sequence[Read], kept: Sequence[Read]) -> bool:
    """他说，再来一次: whether what is kept hardly orders anything, and a clause beside it tells what somebody says."""
    beside = [{sign.label for sign in read.clause.signs} for read in reads if read not in kept]
    told = any("report" in labels and "not" not in labels for labels in beside)
    return told and order_log_odds(kept) < MAYBE_ORDER


def are_asides(reads: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether each clause that is left out is surely an aside."""
    odds = asides(reads)
    return all(is_sure_aside(read.clause, odds) for read in left_out)


def odds_beside_asides(plain: str, reads: Sequence[Read], names: Names = ()) -> float:
    """The odds that a text orders something, where what is clearly an aside is no part of it."""
    found = asides(reads)
    told = [
        read
        for read in reads
        if (aside := found.get(read.clause.start)) is not None
        and (aside.apart or (not read.clause.moves and len(read.clause.signs) >= LEAST_TOLD))
        and aside.odds >= (CLEARLY_ASIDE if aside.apart else SURE_BEARING)
        and is_sure_aside(read.clause, found)
    ]
    odds = order_log_odds(reads)
    return max(odds, order_log_odds(read_acts(without(plain, reads, told), names))) if told else odds


def any_may_bear(reads: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether a clause that is left out, though it sounds like talk, may yet deny, bound or quote the order."""
    found = asides(reads)
    said = [r.clause for r in left_out if any(sign.label not in _POLITE for sign in r.clause.signs)]
    return any(found[clause.start].odds < NO_ASIDE for clause in said if clause.start in found)


def aside_log_odds(clauses: Sequence[Clause], i: int, order: int) -> float:
    """The odds, as a logarithm, that clause `i` is an aside to the order in clause `order`."""
    fitted = weights("beside")
    return sum(fitted[slot] for slot in {slot_of(name) for name in features(clauses, i, order)}) / SCALE
