"""What may be left out of a text to find the order in it: what is told beside it, with marks or without.

A text is written or dictated without marks, too: `back up 8 inches ur on my screwdriver`. So each run of words between
what is surely of the order is looked at as if marks set it off; `beside.py` says how likely that is an aside. Every
amount and way stays, and so does each word that denies, bounds, asks or puts right.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from chatrobot.language.acts import ORDER, Read, read_acts
from chatrobot.language.beside import BEARS, MAYBE_ASIDE, NO_ASIDE, SURELY_NOT_MEANT, asides
from chatrobot.language.data_files import relation_words
from chatrobot.language.frames import GO, TURN
from chatrobot.language.gloss import MARK
from chatrobot.language.lexicon import UNIT, lexicon
from chatrobot.language.set_off import has_amount
from chatrobot.language.signs import BINDING, Clause, Names, Sign, clauses_of
from chatrobot.language.typos import correct

_LEADS = frozenset({"DIR", "ROT"})
NO_ORDER = 3.5
"""A clause without an amount may be left out of a proposal below these odds."""
MARKS = " ,.;:!?…。—~\n"
_IDLE = frozenset({"VERB", "PLACE", "COUNTER"})
"""Labels of words of motion that people say of other things, too; every other one is of the order."""
BEARING = frozenset({"correction", "hypothetical", "question", *'"“”「」『』()'})
"""Labels of words that bear on the order, so that no run with them is left out."""
_BOUND = frozenset({"not", "later", "condition", "contrast", "report", "sees", "supposed"})
"""Labels of words that may bear on the order: with one of them a run needs higher odds of an aside."""
_SUBJECTS = frozenset({"mine", "kin", "other", "person", "thing", "joint", "verdict"})
"""Labels of words of somebody else than the robot, who does what a run names."""
_TELLING = (BINDING - {"ask"}) | {"report", "later", "sees", "supposed", "earlier", "did"}
"""Labels of words that may tell of a motion: with one of them before it, what seems an order may be told of."""
_CLOSES = frozenset(
    {
        "UNIT",
        "SECOND",
        "DIR",
        "ROT",
        "SHAPE",
        "FULLTURN",
        "TIMES",
        "FLAG",
        "PACE",
        "MULTIPLE",
        "ROLE",
        "PLACE",
        "opening",
        "please",
    }
)
"""Labels of words that an order may end on, so that something may be told behind it."""
_SAYS_NOTHING = frozenset({"opening", "request", "please", "hence"})
_OPENS = frozenset({"opening", "hence", "joint", "conn"})
COUNTED = frozenset({"NUMBER", "FRACTION", "SCALE", "COUNTER"})
"""Labels of words after which a word that nobody knows may be a unit, or what is counted."""
EXTENTS = frozenset({"NUMBER", "UNIT", "DIR", "ROT", "SHAPE", "FULLTURN", "TIMES", "FRACTION", "SCALE"})
_SIZES = (EXTENTS | {"FLAG", "MULTIPLE", "COUNTER"}) - {"SHAPE"}
TOLD = frozenset({"verdict", "does", "did"})
_GOVERNS = _SUBJECTS | TOLD | {"to", "can"}
"""Labels of words that a verb right behind them belongs to."""
_TELLS = TOLD | {"past", "earlier", "report", "sees", "kin", "thing", "later"}
_POINTING = frozenset({"FLAG", "MULTIPLE"})
"""Labels of words that point at the motion before."""
_WAYS = frozenset({"dir", "rot", "pace"})
"""Kinds of words that are never left out as part of another."""
_LEAST_OF_WAY = 4
_SURE_BOUND, NO_PURPOSE = 1.0, -4.0


class Span(NamedTuple):
    """Part of a text that may be left out, and the text without it.

    `odds` are those of an aside; None of words that nobody knows. `points`: they only name the motion before.
    `log_odds` are those of an order. `tells`: marks set it off, or what stands behind it may be told of.
    """

    text: str
    said: str
    odds: float | None = None
    points: bool = False
    log_odds: float = 0.0
    tells: bool = False


def place_of(part: str, text: str) -> range:
    """Where `part` stands in the text, be it mistyped there; empty where it does not."""
    said = r"\s*".join(map(re.escape, part.rstrip("…").split()))
    found = re.search(said, text) if said else None
    if found is None:
        slips = (unit for unit in UNIT.finditer(text) if len(unit.group()) > 2)
        found = next((unit for unit in slips if correct(unit.group()) == part), None)
    return range(found.start(), found.end()) if found is not None else range(0)


def told_spans(text: str, names: Names, at: range) -> list[Span]:
    """Runs of words that may be said beside the order and touch what stands `at` a place, the likeliest first."""
    found: dict[str, Span] = {}
    for clause in clauses_of(text, names):
        for begin, end in _runs(clause.signs):
            start, stop = extent(text, clause, begin, end)
            if at and not (start < at.stop and at.start < stop):
                continue
            says = any(sign.label not in _SAYS_NOTHING for sign in clause.signs[begin:end])
            span = _told(text, names, clause, begin, end) if at or says else None
            if span is not None:
                found.setdefault(span.text, span)
    return sorted(found.values(), key=lambda span: -(span.odds or 0.0))


def _runs(signs: Sequence[Sign]) -> Iterator[tuple[int, int]]:
    """Where each run of words begins and ends that may be no part of the order, the longer ones first."""
    held = [_is_of_order(signs, i) for i in range(len(signs))]
    begin = 0
    while begin < len(signs):
        end = begin
        while end < len(signs) and not held[end]:
            end += 1
        begins = [begin, *(i + 1 for i in range(begin, end - 1) if _ends_order(signs[i]))]
        ends = [end, *(i for i in range(begin + 1, end) if _begins_order(signs[i]))]
        yield from ((i, j) for i in begins for j in ends if i < j)
        begin = end + 1
    opened = (i for i, sign in enumerate(signs) if i and sign.text in relation_words("opening"))
    for i in opened:  # `for the wide shot`: what it is like, or what for
        if not any(sign.moves and sign.label in _SIZES for sign in signs[i:]):
            yield i, len(signs)


def _is_of_order(signs: Sequence[Sign], i: int) -> bool:
    if signs[i].label == "NUMBER" and i + 1 < len(signs) and _is_unknown(signs[i + 1]):
        return correct(signs[i + 1].text) != signs[i + 1].text  # it counts something else: 四年级
    return signs[i].moves and signs[i].label.isupper() and signs[i].label not in _IDLE


def _ends_order(sign: Sign) -> bool:
    return sign.label in ("PLACE", "opening", "please")


def _begins_order(sign: Sign) -> bool:
    return sign.label in ("VERB", "request", "please") or _goes_on(sign)


def _told(text: str, names: Names, clause: Clause, begin: int, end: int) -> Span | None:
    """A run of a clause as what is told beside the order; None where it may be part of it, or bear on it."""
    signs, before, after = clause.signs[begin:end], clause.signs[:begin], clause.signs[end:]
    if _may_bear(signs, before, after) or not (_stands_behind(signs, before) and _stands_ahead(signs, after)):
        return None
    start, stop = extent(text, clause, begin, end)
    odds, log_odds = _odds(text, names, start, stop)
    is_parted = bool(after) and after[0].text in relation_words("parting")
    tells = (
        bool(after)
        and not is_parted
        and (signs[0].label in ("ask", "does") or any(sign.label in _TELLING for sign in signs))
    )
    tells |= not (before or after) and odds < SURELY_NOT_MEANT
    is_idle = _first_verb(signs) < 0 and bool(not before or signs[0].label in _SUBJECTS)
    is_bound = any(sign.label in _BOUND for sign in signs)
    least = NO_ASIDE if is_idle else MAYBE_ASIDE
    if before and not after and signs[0].text in relation_words("opening"):
        least = NO_PURPOSE
    if odds < (_SURE_BOUND if is_bound else least):
        return None
    said = text[start:stop].strip(MARKS)
    return Span(without(text, start, stop), said, odds, False, log_odds, tells)


def _may_bear(signs: Sequence[Sign], before: Sequence[Sign], after: Sequence[Sign]) -> bool:
    """Whether a run may deny, bound, ask for, or count what is ordered, or name what else is to be moved."""
    labels = {sign.label for sign in signs}
    in_scope = any(sign.label in BEARING | _BOUND for sign in before)
    moved = any(sign.text in relation_words("moved") for sign in (*before, *signs))
    if signs[0].label not in _SUBJECTS:
        named = any(names_way(unit) for sign in signs for unit in sign.text.split("_"))
        moved |= named or bool(before and any(sign.moves and sign.label in COUNTED for sign in signs))
    if after and after[0].text in relation_words("parting"):
        labels -= {"question"}
    return in_scope or moved or bool(labels & BEARING) or signs[0].label == "condition"


def _stands_behind(signs: Sequence[Sign], before: Sequence[Sign]) -> bool:
    """Whether the order may be told before a run, and the run is no part of it."""
    if not before:
        return True
    named = before[-1].label in _POINTING and signs[0].text in relation_words("articles") and len(signs) < 3
    is_part = named or _leads(signs[0]) or _goes_on(signs[0]) or _is_meant(signs) or signs[0].label == "did"
    return before[-1].label in _CLOSES and not is_part


def _stands_ahead(signs: Sequence[Sign], after: Sequence[Sign]) -> bool:
    """Whether what stands behind a run is an order by itself: not `that was a nice | square`, `my brother | drove`."""
    if not after or after[0].text in relation_words("parting"):
        return True
    last = signs[-1].label
    if last in _BOUND or _leads(signs[0]) or _is_meant(signs):
        return False
    if after[0].label in _POINTING:  # not `the turn | again`, `to the tea room | again`
        named = len(signs) > 1 and signs[-2].text in relation_words("articles")
        return last not in _SUBJECTS and not named and all(sign.label != "to" for sign in signs)
    if last in _GOVERNS and not (len(signs) > 2 and after[0].label in _SAYS_NOTHING):
        return False
    if _begins_order(after[0]):
        return True
    return after[0].label in ("DIR", "PACE", "ROT") and has_amount(Clause(tuple(after), "", 0, 0))


def _is_meant(signs: Sequence[Sign]) -> bool:
    """Whether the robot may be meant to do what the run names: nobody else is said to."""
    at = _first_verb(signs)
    return at >= 0 and not any(sign.label in _SUBJECTS for sign in signs[:at])


def _first_verb(signs: Sequence[Sign]) -> int:
    return next((i for i, sign in enumerate(signs) if sign.moves and sign.label in ("VERB", "PLACE")), -1)


def _leads(sign: Sign) -> bool:
    """Whether it says how the motion before lies to something: `past the fern`, `via the hall`."""
    return sign.text in _relations()


@lru_cache(maxsize=1)
def _relations() -> frozenset[str]:
    return relation_words("words") | relation_words("towards") | relation_words("restricting")


def _odds(text: str, names: Names, start: int, stop: int) -> tuple[float, float]:
    """The odds of an aside and of an order of part of a text, as if marks set it off."""
    head, said, rest = text[:start].rstrip(" ,"), text[start:stop].strip(" ,"), text[stop:].lstrip(" ,")
    before = "" if not head else " " if head[-1] in MARKS else ", "
    after = "" if not rest or rest[0] in MARKS or said[-1] in MARKS else ","
    at = len(head + before)
    reads = read_acts(f"{head}{before}{said}{after} {rest}".strip(), names)
    read = next((read for read in reads if read.clause.start <= at < read.clause.stop), None)
    aside = asides(reads).get(read.clause.start) if read is not None else None
    return (aside.odds, read.log_odds) if read is not None and aside is not None else (BEARS, 0.0)


def extent(text: str, clause: Clause, begin: int, end: int) -> tuple[int, int]:
    """Where those signs of a clause begin and end in the text; with its mark where nothing else is left of it."""
    start = clause.signs[begin].start
    is_end = end == len(clause.signs)
    stop = clause.stop if is_end else clause.signs[end].start
    if is_end and begin:
        stop = start + len(text[start:stop].rstrip(MARKS))
    return start, stop


def without(text: str, start: int, stop: int) -> str:
    return " ".join(f"{text[:start]} {text[stop:]}".split()).strip(" ,;:")


def with_tails_parted(plain: str, names: Names = ()) -> str:
    """A normalised text with a comma between the last word of motion of each clause and what nobody knows behind it."""
    parts, start = [], 0
    for clause in clauses_of(plain, names):
        at = _tail(clause)
        if at is not None:
            parts.append(plain[start:at].rstrip() + ", ")
            start = at
    return "".join((*parts, plain[start:]))


def _tail(clause: Clause) -> int | None:
    """Where what nobody knows begins behind the last word of motion of a clause that tells an amount, if it does."""
    signs = clause.signs
    last = max((i for i, s in enumerate(signs) if s.moves and s.label not in ("VERB", "PLACE")), default=-1)
    told, tail = signs[: last + 1], signs[last + 1 :]
    if len(tail) < 2 or not has_amount(clause) or not _stands_behind(tail, told) or _may_bear(tail, told, ()):
        return None
    if not any(map(_is_unknown, tail)) or any(map(_is_unknown, told)):
        return None
    predicated = any(sign.label in TOLD | {"past"} for sign in tail[:2])
    bound = any(sign.label in _BOUND for sign in tail) or any(sign.label in _TELLS for sign in told)
    return None if predicated or bound else tail[0].start


def _is_unknown(sign: Sign) -> bool:
    return sign.label == sign.text and not sign.moves


def _goes_on(sign: Sign) -> bool:
    """`go forward 1 m and frobnicate`: whether what follows may be another order."""
    return sign.label in _OPENS or kind_of(sign) == "conn"


def kind_of(sign: Sign) -> str:
    return lexicon().words.get(tuple(sign.text.split("_")), (("", ""),))[0][0]


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


def leads_amount(read: Read, reads: Sequence[Read]) -> bool:
    """`Backward out of there, two metres`: whether it says the way of the amount behind it, which names none itself."""
    ways = _LEADS & {sign.label for sign in read.clause.signs}
    after = reads[reads.index(read) + 1 :][:1]
    said = {sign.label for other in after for sign in other.clause.signs}
    return bool(ways) and "UNIT" in said and not said & (_LEADS | {"VERB", "SHAPE"})


def may_order(read: Read) -> bool:
    """`drive to the kitchen`, where nobody knows a kitchen: it is asked about, however much it sounds like an aside."""
    signs = [sign for sign in read.clause.signs if sign.label != "opening"]
    says = [_verb(sign) for sign in signs]
    least = ORDER if says[:1] and says[0] in GO else NO_ORDER
    return any(verb in GO or verb in TURN for verb in says) and read.log_odds >= least


def _verb(sign: Sign) -> str:
    meaning = lexicon().words.get(tuple(sign.text.split("_")), (("", ""),))
    return meaning[0][1] if sign.label == "VERB" else ""
