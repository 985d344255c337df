"""Which clauses of a text order something. Everything else is talk: it may answer, remark, ask, but moves nothing.

A log-linear reader: each clause has signs (evidence, requests, words of motion) in an order, with marks and neighbours;
runs of one to three of them, and the words themselves, each weigh something for or against an order. The weights are
fitted by scripts/fit_acts.py and kept in `data/acts.bin`, one byte a slot; a feature's slot is its checksum.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table, relation_words
from chatrobot.language.fitted import SCALE, slot_of, weights
from chatrobot.language.signs import Clause, Names, Sign, clauses_of, is_strong

SLOTS = 1 << 16
MAYBE_ORDER, ORDER = -0.5, 0.75
"""A text with lower odds than the first orders nothing; with lower odds than the second, what it orders is proposed.
Sources that were left out chose them: `fit_acts --check`."""
TALK, TALK_OF_MOTION = -2.0, -3.0
"""A clause with lower odds than that may be passed over beside an order; with a word of motion in it, the second."""
SURE_ORDER = 1.0
"""Of a clause with higher odds the request that opens it may be left out."""
_MEASURES = frozenset({"UNIT", "COUNTER"})
_AMOUNTS = _MEASURES | {"NUMBER", "SCALE", "FRACTION"}
_DOES = frozenset({"VERB", "DIR"})
_TELLING = frozenset({"verdict", "mine"})
_DOERS = frozenset({"kin", "later"})
_LOOKS_BACK = 3


@dataclass(frozen=True)
class Read:
    """A clause and the odds that it orders something, as a logarithm."""

    clause: Clause
    log_odds: float


def read_acts(text: str, names: Names = ()) -> list[Read]:
    """Each clause of a normalised text with its odds."""
    fitted = weights("acts")
    clauses = clauses_of(text, names)
    reads: list[Read] = []
    for i, clause in enumerate(clauses):
        odds = sum(fitted[slot_of(name, SLOTS)] for name in features(clauses, i)) / SCALE
        if i and clause.goes_on and clauses[i - 1].tells_of_before and not is_strong(clauses[i - 1].end):
            odds = min(odds, reads[-1].log_odds)  # `you went to the sofa, then to the kitchen`
        reads.append(Read(clause, odds))
    return reads


def order_log_odds(reads: Sequence[Read]) -> float:
    """The odds that any clause orders something; only those with a word of motion are asked, if there are any."""
    meant = reads[1:] if _begins_talk(reads) else reads
    moving = [read.log_odds for read in meant if read.clause.moves] or [read.log_odds for read in meant]
    return max(moving, default=-60.0)


def _begins_talk(reads: Sequence[Read]) -> bool:
    """`right, that was good`: a word of motion that only agrees, because nothing but talk comes after it."""
    if len(reads) < 2 or any(read.clause.moves for read in reads[1:]) or not reads[1].clause.talks:
        return False
    return tuple(sign.text for sign in reads[0].clause.signs) in agreeing()


@lru_cache(maxsize=1)
def agreeing() -> frozenset[tuple[str, ...]]:
    """The words of motion that may only agree: `right`."""
    return frozenset((word,) for code in LANGUAGES for word in load_table(code, "agreeing").get("words", ()))


def orders(text: str, names: Names = ()) -> bool:
    """Whether a normalised text orders anything at all."""
    return order_log_odds(read_acts(text, names)) >= ORDER


def talk_in(reads: Sequence[Read], *, doubtful: bool = False) -> list[Read]:
    """The clauses beside an order that are only talk; with `doubtful`, also those that are rather talk than orders."""
    talk = [read for read in reads if _is_talk(read, doubtful=doubtful)]
    talk += _statements(reads)
    if not any(
        map(_does, (read for read in reads if read not in talk))
    ):  # `once more, only to the right this time`
        talk = [read for read in talk if not _does(read)]
    talk = [read for read in talk if not may_be_goal(read, reads)]
    return talk if len(talk) < len(reads) and order_log_odds(reads) >= ORDER else []


def tells_of_pace(reads: Sequence[Read]) -> bool:
    """`That was rather slow. Even I am quicker.`: whether all words of motion only tell how fast somebody is or was."""
    moving = [read.clause.signs for read in reads if read.clause.moves]
    labels = {sign.label for signs in moving for sign in signs if sign.moves}
    told = all(any(sign.label in _TELLING for sign in signs) for signs in moving)
    return bool(labels & {"PACE", "complaint"}) and labels <= {"PACE", "complaint", "FLAG"} and told


def without(text: str, reads: Sequence[Read], left_out: Sequence[Read]) -> str:
    """A normalised text without some of its clauses; an empty string where there is nothing to leave out."""
    if not left_out:
        return ""
    kept = [read.clause for read in reads if read not in left_out]
    return " ".join(text[clause.start : clause.stop].strip() for clause in kept).strip(" ,;:")


def without_requests(text: str, names: Names = ()) -> str:
    """A normalised text whose orders begin with what is to be done; an empty string where no request opens one."""
    parts, found = [], False
    for read in read_acts(text, names):
        clause = read.clause
        start = clause.order_start if read.log_odds >= SURE_ORDER else clause.start
        found |= start > clause.start
        parts.append(text[start : clause.stop].strip())
    return " ".join(parts) if found else ""


def _is_talk(read: Read, *, doubtful: bool) -> bool:
    clause = read.clause
    limit_of_motion = MAYBE_ORDER if doubtful else TALK_OF_MOTION
    limit = limit_of_motion if clause.moves else TALK
    is_others = doubtful and _has_own_subject(clause)
    return (clause.talks or is_others) and not clause.binds and read.log_odds < limit


def _has_own_subject(clause: Clause) -> bool:
    """`…, I'll go back 2 m`: what somebody else than the robot does."""
    pairs = itertools.pairwise(sign.label for sign in clause.signs)
    return any(before in _DOERS and label == "VERB" for before, label in pairs)


def _does(read: Read) -> bool:
    return any(sign.label in _DOES for sign in read.clause.signs)


def _statements(reads: Sequence[Read]) -> list[Read]:
    """`Look, the robot can drive a square.`: what stands alone in a sentence that rather tells, with an amount."""
    found, is_first = [], True
    for read in reads:
        clause = read.clause
        ends = clause.end != "" and is_strong(clause.end)
        if is_first and ends and _does(read) and clause.tells and not clause.binds and read.log_odds < TALK:
            found.append(read)
        is_first = ends or (is_first and not clause.moves)
    return found


def features(clauses: Sequence[Clause], i: int) -> Iterator[str]:
    """The features of one clause among its neighbours."""
    clause = clauses[i]
    end = f"${_mark(clause)}"
    told = list(_told(clause.signs))
    labels = ["^", *(label for label, _ in told), end]
    texts = ["^", *(text for _, text in told), end]
    yield "bias"
    for at in range(1, len(labels)):
        yield f"1{labels[at]}"
        yield f"2{labels[at - 1]} {labels[at]}"
        if at > 1:
            yield f"3{labels[at - 2]} {labels[at - 1]} {labels[at]}"
        if texts[at] != labels[at]:
            yield f"w{texts[at]}"
        yield f"b{texts[at - 1]} {texts[at]}"
        if labels[at][0].isupper() and texts[at].isascii():
            yield f"s{labels[at]} {texts[at][-2:]}"
    kinds = [label for label in labels[1:-1] if label[0].isupper()]
    yield f"k{' '.join(kinds[:4])}"
    yield f"n{min(len(kinds), 4)} {min(len(labels) - 2 - len(kinds), 6)}"
    yield from _around(clauses, i)


def _mark(clause: Clause) -> str:
    """The mark after a clause. How a sentence ends that is no question tells nothing."""
    return "." if clause.end != "?" and is_strong(clause.end) else clause.end


def _told(signs: Sequence[Sign]) -> Iterator[tuple[str, str]]:
    """(label, text) of each sign, an amount being one: which it is and how it is put together tells nothing."""
    for is_amount, group in itertools.groupby(signs, lambda sign: sign.label in _AMOUNTS):
        run = list(group)
        if is_amount:
            label = "AMOUNT" if any(sign.label in _MEASURES for sign in run) else "NUMBER"
            yield label, label
        else:
            # What a name is written like tells nothing either.
            yield from ((sign.label, sign.label if sign.is_name else sign.text) for sign in run)


def _around(clauses: Sequence[Clause], i: int) -> Iterator[str]:
    """What stands before and after it, and how its sentence ends."""
    last = next(k for k in range(i, len(clauses)) if is_strong(clauses[k].end) or k + 1 == len(clauses))
    first = i
    while first > 0 and not is_strong(clauses[first - 1].end):
        first -= 1
    head = clauses[i].signs[0].label
    yield f"q{_mark(clauses[last])} {head}"
    yield f"e{_mark(clauses[last])}"
    for side, k in (("p", i - 1), ("f", i + 1)):
        if not 0 <= k < len(clauses):
            yield f"{side}none"
            continue
        same = "same" if first <= k <= last else "other"
        yield f"{side}{same}"
        yield f"{side}{same}{clauses[k].moves}"
        if same == "same":
            yield f"{side}h{clauses[k].signs[0].label}"
            for label in {sign.label for sign in clauses[k].signs}:
                yield f"{side}l{label}"
                yield f"{side}m{_mark(clauses[k])}{label}"
    for label in {sign.label for clause in clauses[max(i - _LOOKS_BACK, 0) : i] for sign in clause.signs}:
        yield f"a{label}"


_NAMING = frozenset({"other", "thing", "person", "opening", "request"})
"""Labels of words that may stand beside a noun which says where to."""


_BEFORE = Sign("", "", False, 0)


def may_be_goal(read: Read, reads: Sequence[Read]) -> bool:
    """`Go to the dock, then to the shelf`, where nobody knows a shelf: a place to go to, however it sounds."""
    signs = [sign for sign in read.clause.signs if sign.label not in ("opening", "request")]
    if not signs or not all(sign.is_name or sign.label in {*_NAMING, sign.text} for sign in signs):
        return False
    leads = _leads(signs[0])
    return len(signs) > leads and any(
        leads or sign.is_name or sign.label == "PLACE" or (sign.label == "thing" and _leads(ahead))
        for other in reads[: reads.index(read)]
        for ahead, sign in itertools.pairwise((_BEFORE, *other.clause.signs))
    )


def _leads(sign: Sign) -> bool:
    """Whether it says where to: `to`, `go to`."""
    return sign.text.split("_")[-1] in relation_words("leading")
