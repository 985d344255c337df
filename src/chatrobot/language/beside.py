"""How likely a clause beside an order is an aside: it tells, greets or explains, and the order is the same without it.

A log-linear reader of its own, next to `acts.py`: it looks at one clause and where it stands, at classes of words with
all others alike, and at the words and how they end. The weights are fitted by scripts/fit_beside.py, `data/beside.bin`.
"""

from __future__ import annotations

import itertools
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from chatrobot.language.acts import ORDER, Read, order_log_odds, read_acts, without
from chatrobot.language.data_files import DATA
from chatrobot.language.lexicon import lexicon
from chatrobot.language.quoting import quotes_ahead, quotes_behind, sentences_of
from chatrobot.language.signs import Clause, Names, Sign, is_strong

SLOTS = 1 << 15
SCALE = 24.0
"""A weight of one is this much in a byte."""

SURE_ASIDE, MAYBE_ASIDE = 1.5, 0.0
"""A clause with higher odds than the first is surely an aside; with higher odds than the second, the order without it
is proposed. Frames that were left out chose them: `fit_beside --check`."""
SURE_WITH_MOTION, CLEARLY_ASIDE = 3.0, 5.0
"""The first, for a clause with a word of motion that could be said of the order; for one that tells of later."""
NO_ASIDE = -2.0
"""A clause with lower odds is no aside, whatever else it sounds like: what is ordered beside it is proposed."""
BEARS = -9.0
"""Its odds, where its words say that it is none."""
PART_OF_ASIDE, TOGETHER = -3.0, 1.0
"""The clauses of a sentence beside the order have the sum of their odds, less the second, where each has the first."""
_REFERENCES = ((("flag", "again"),), (("flag", "other_way"),), (("verb", "undo"),))
_POLITE = frozenset({"please", "opening", "robot", "request"})
_BOUND = frozenset({"condition", "later"})
_NO_AMOUNTS = frozenset({"VERB", "DIR", "PLACE", "COUNTER", "FLAG"})
_WAYS = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_NUMBERS = frozenset({"NUMBER", "FRACTION", "SCALE"})
_UNITS = frozenset({"UNIT", "SECOND"})


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
        together = sum(odds.values()) - TOGETHER
        pooled = apart and len(part) > 1 and all(_may_be_pooled(clauses[i], odds[i]) for i in part)
        found |= {clauses[i].start: Aside(max(o, together) if pooled else o, apart) for i, o in odds.items()}
    return found


def _may_order(read: Read) -> bool:
    return read.log_odds >= ORDER and read.clause.moves and read.clause.measures


def _may_be_pooled(clause: Clause, odds: float) -> bool:
    return odds >= PART_OF_ASIDE and not _is_bound(clause)


def _tells_of_later(clause: Clause, odds: float) -> bool:
    """`I have a test tomorrow`: whether what is said to be later is what it tells of."""
    bound = [i for i, sign in enumerate(clause.signs) if sign.label in _BOUND]
    later = all(clause.signs[i].label == "later" and i > 1 for i in bound)
    return later and odds >= CLEARLY_ASIDE and not clause.denies and clause.end != ":"


def _is_bound(clause: Clause) -> bool:
    then = lexicon().words.get(tuple(clause.signs[0].text.split("_")), ())  # what begins so is another order
    bound = any(sign.label in _BOUND for sign in clause.signs) or ("conn", "then") in then
    return bound or clause.denies or clause.end == ":"


def _odds_of(clauses: Sequence[Clause], i: int, order: int, *, begins: bool) -> float:
    """The odds of one clause; those of no aside where its first or last words quote the order or take it back."""
    own = aside_log_odds(clauses, i, order)
    behind = any(other.measures for other in clauses[:i]) and not any(other.measures for other in clauses[i:])
    if behind:
        quotes = quotes_behind(clauses[i], begins=begins)
    else:
        quotes = i + 1 == order and quotes_ahead(clauses[i], clauses[order])
    return min(own, BEARS) if quotes else own


def is_sure_aside(clause: Clause, found: Mapping[int, Aside]) -> bool:
    """Whether it is surely an aside: it has no amount, condition or negation that could be meant for the order."""
    aside = found.get(clause.start)
    if aside is None or (_is_bound(clause) and not (aside.apart and _tells_of_later(clause, aside.odds))):
        return False
    least = SURE_WITH_MOTION if clause.tells else SURE_ASIDE
    return aside.odds >= least and not _may_bear_on_order(clause.signs, aside.apart)


def _may_bear_on_order(signs: Sequence[Sign], apart: bool) -> bool:
    """Whether it has an amount: in a sentence of its own, a number with a unit or with a way to go."""
    moving = {sign.label for sign in signs if sign.moves and sign.label.isupper()}
    if not apart:
        return not moving <= _NO_AMOUNTS
    measured = any(a.label in _NUMBERS and b.label in _UNITS for a, b in itertools.pairwise(signs))
    counted = bool(moving & _NUMBERS and moving & _WAYS)
    return measured or counted or not moving <= _NO_AMOUNTS | _NUMBERS | {"UNIT", "TIMES", "ROLE"}


def refers(clause: Clause) -> bool:
    """Whether a clause asks for the motion before, and so much: `undo that`, `45 degrees the other way please`."""
    known = lexicon().words
    amounts = _NUMBERS | _UNITS
    moving = [sign for sign in clause.signs if sign.moves and sign.label not in amounts]
    said = [known.get(tuple(sign.text.split("_"))) for sign in moving]
    beside = {sign.label for sign in clause.signs if not sign.moves}
    return bool(said) and all(meaning in _REFERENCES for meaning in said) and beside <= _POLITE


def are_asides(reads: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether each clause that is left out is surely an aside."""
    odds = asides(reads)
    return all(is_sure_aside(read.clause, odds) for read in left_out)


def odds_beside_asides(plain: str, reads: Sequence[Read], names: Names = ()) -> float:
    """The odds that a text orders something, where sentences that are clearly asides are no part of it."""
    found = asides(reads)
    told = [
        read
        for read in reads
        if (aside := found.get(read.clause.start)) is not None
        and aside.apart
        and aside.odds >= CLEARLY_ASIDE
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
    weights = _weights()
    return sum(weights[slot_of(name)] for name in features(clauses, i, order)) / SCALE


def slot_of(name: str) -> int:
    """Where the weight of a feature is kept."""
    return zlib.crc32(name.encode()) & (SLOTS - 1)


def features(clauses: Sequence[Clause], i: int, order: int) -> Iterator[str]:
    """The features of clause `i` beside clause `order`."""
    clause = clauses[i]
    signs = clause.signs
    labels = ["^", *(sign.label if sign.label != sign.text else "?" for sign in signs), "$"]
    texts = ["^", *(sign.text for sign in signs), "$"]
    side = "<" if i < order else ">"
    mark = "." if is_strong(clause.end) and clause.end != "?" else clause.end
    yield "bias"
    yield f"m{side}{mark}"
    yield f"n{min(len(signs), 7)}"
    yield f"o{side}{labels[1]}"
    yield f"h{side}{texts[1]}"
    yield f"z{mark}{labels[-2]}"
    for at in range(1, len(labels)):
        yield f"1{labels[at]}"
        yield f"2{labels[at - 1]} {labels[at]}"
        yield f"b{texts[at - 1]} {texts[at]}"
        if at > 1:
            yield f"3{labels[at - 2]} {labels[at - 1]} {labels[at]}"
        if at < len(labels) - 1:
            yield f"w{texts[at]}"
            if labels[at] == "?" and texts[at].isascii():
                yield f"s{texts[at][-2:]}"
    for label in {label for label in labels[1:-1] if label != "?"}:
        yield f"l{side}{label}"


@lru_cache(maxsize=1)
def _weights() -> tuple[int, ...]:
    data = (DATA / "beside.bin").read_bytes()
    return tuple(byte - 256 if byte > 127 else byte for byte in data)
