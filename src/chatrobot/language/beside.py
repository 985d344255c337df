"""How likely a clause beside an order is an aside: it tells, greets or explains, and the order is the same without it.

A log-linear reader of its own, next to `acts.py`: it looks at one clause and where it stands, at classes of words with
all others alike, and at the words and how they end. The weights are fitted by scripts/fit_beside.py, `data/beside.bin`.
"""

from __future__ import annotations

import itertools
import zlib
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from chatrobot.language.acts import Read
from chatrobot.language.data_files import DATA
from chatrobot.language.lexicon import lexicon
from chatrobot.language.signs import Clause, is_strong

SLOTS = 1 << 15
SCALE = 24.0
"""A weight of one is this much in a byte."""

SURE_ASIDE, MAYBE_ASIDE = 2.0, 0.0
"""A clause with higher odds than the first is surely an aside; with higher odds than the second, the order without it
is proposed. Frames that were left out chose them: `fit_beside --check`."""
SURE_WITH_MOTION = 3.0
"""The first, for a clause with a word of motion that could be said of the order."""
NO_ASIDE = -3.0
"""A clause with lower odds is no aside, whatever else it sounds like: what is ordered beside it is proposed."""
_REFERENCES = ((("flag", "again"),), (("flag", "other_way"),), (("verb", "undo"),))
_POLITE = frozenset({"please", "opening", "robot", "request"})
_BOUND = frozenset({"condition", "later"})
_BARE = frozenset({"NUMBER", "UNIT", "DIR", "SCALE", "FRACTION", "COUNTER"})
_ASKING = frozenset({"request", "please", "polite", "correction", "complaint"})
_OPENING = frozenset({"opening", "robot", "social", "praise", "not", "same"})
_CALLING = frozenset({"person", "please"})
_NO_AMOUNTS = frozenset({"VERB", "DIR", "PLACE", "COUNTER", "FLAG"})


def asides(reads: Sequence[Read]) -> dict[int, float]:
    """The odds that each clause but the likeliest order is an aside to it, by where the clause starts."""
    clauses = [read.clause for read in reads]
    order = max(range(len(reads)), key=lambda i: (clauses[i].moves, reads[i].log_odds))
    return {clause.start: aside_log_odds(clauses, i, order) for i, clause in enumerate(clauses) if i != order}


def is_sure_aside(clause: Clause, odds: Mapping[int, float]) -> bool:
    """Whether it is surely an aside: it has no amount, condition or negation that could be meant for the order."""
    if clause.denies or clause.end == ":" or any(sign.label in _BOUND for sign in clause.signs):
        return False
    moving = {sign.label for sign in clause.signs if sign.moves and sign.label.isupper()}
    least = SURE_WITH_MOTION if clause.tells else SURE_ASIDE
    return moving <= _NO_AMOUNTS and odds.get(clause.start, least - 1.0) >= least


def is_bare_beside_talk(reads: Sequence[Read]) -> bool:
    """Whether a way alone or an amount alone stands beside talk (`left, of course`), or a whole motion before praise.

    No verb and no other word asks for it, so it may as well be part of the talk.
    """
    odds = asides(reads)
    bare = [read for read in reads if not _is_told(read, odds)]
    named = {sign.label for read in bare for sign in read.clause.signs if sign.moves and sign.label.isupper()}
    if not named or not named <= _BARE:
        return False
    if any(sign.label in _ASKING for read in reads for sign in read.clause.signs):
        return False
    talk = [read for read in reads if read not in bare]
    if talk and talk[-1] is reads[-1] and any(sign.label == "praise" for sign in reads[-1].clause.signs):
        return True
    is_whole = "DIR" in named and len(named) > 1
    return not is_whole and any(sign.label not in _OPENING for read in talk for sign in read.clause.signs)


def calls_somebody(reads: Sequence[Read]) -> bool:
    """`Please Ben, not so fast, go back a step`: whether somebody else is called first, and the robot is not."""
    before = [read.clause for read in itertools.takewhile(lambda read: not read.clause.moves, reads)]
    if any(is_strong(clause.end) for clause in before):
        return False  # `thanks, Mum. Now go forward`
    called = any("person" in labels and labels <= _CALLING for labels in map(_labels, before))
    return called and not any("robot" in _labels(read.clause) for read in reads)


def _labels(clause: Clause) -> set[str]:
    return {sign.label for sign in clause.signs}


def _is_told(read: Read, odds: Mapping[int, float]) -> bool:
    """Whether a clause names no motion at all, or is surely an aside without an amount."""
    if not any(sign.moves and sign.label.isupper() for sign in read.clause.signs):
        return True
    return odds.get(read.clause.start, NO_ASIDE) >= SURE_ASIDE and not read.clause.tells


def refers(clause: Clause) -> bool:
    """Whether a clause asks for the motion before and nothing else: `undo that`, `once more please`."""
    known = lexicon().words
    said = [known.get(tuple(sign.text.split("_"))) for sign in clause.signs if sign.moves]
    beside = {sign.label for sign in clause.signs if not sign.moves}
    return bool(said) and all(meaning in _REFERENCES for meaning in said) and beside <= _POLITE


def are_asides(reads: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether each clause that is left out is surely an aside."""
    odds = asides(reads)
    return all(is_sure_aside(read.clause, odds) for read in left_out)


def any_may_bear(reads: Sequence[Read], left_out: Sequence[Read]) -> bool:
    """Whether a clause that is left out, though it sounds like talk, may yet deny, bound or quote the order."""
    odds = asides(reads)
    return any(odds.get(read.clause.start, 0.0) < NO_ASIDE for read in left_out)


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
