"""What is told beside an order without a mark before it: `back up 8 inches ur on my screwdriver`.

What nobody knows behind the last word of an order is parted from it, and a run of words is looked at as if marks set
it off: `beside.py` says how likely that is an aside.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.acts import ORDER, Read, read_acts
from chatrobot.language.beside import BEARS, asides
from chatrobot.language.data_files import relation_words
from chatrobot.language.frames import GO, TURN
from chatrobot.language.gloss import MARK
from chatrobot.language.lexicon import lexicon
from chatrobot.language.set_off import has_amount
from chatrobot.language.signs import Clause, Names, Sign, clauses_of

_LEADS = frozenset({"DIR", "ROT"})
NO_ORDER = 3.5
"""A clause without an amount may be left out of a proposal below these odds."""
MARKS = " ,.;:!?…。—~\n"
BEARING = frozenset({"correction", "hypothetical", "question", *'"“”「」『』()'})
"""Labels of words that bear on the order, so that no run with them is left out."""
_BOUND = frozenset({"not", "later", "condition", "contrast", "report", "sees", "supposed"})
"""Labels of words that may bear on the order: with one of them a run needs higher odds of an aside."""
_SUBJECTS = frozenset({"mine", "kin", "other", "person", "thing", "joint", "verdict"})
"""Labels of words of somebody else than the robot, who does what a run names."""
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
_OPENS = frozenset({"opening", "hence", "joint", "conn"})
COUNTED = frozenset({"NUMBER", "FRACTION", "SCALE", "COUNTER"})
"""Labels of words after which a word that nobody knows may be a unit, or what is counted."""
EXTENTS = frozenset({"NUMBER", "UNIT", "DIR", "ROT", "SHAPE", "FULLTURN", "TIMES", "FRACTION", "SCALE"})
TOLD = frozenset({"verdict", "does", "did"})
_TELLS = TOLD | {"past", "earlier", "report", "sees", "kin", "thing", "later"}
_POINTING = frozenset({"FLAG", "MULTIPLE"})
"""Labels of words that point at the motion before."""
_WAYS = frozenset({"dir", "rot", "pace"})
"""Kinds of words that are never left out as part of another."""
_LEAST_OF_WAY = 4


def _may_bear(signs: Sequence[Sign], before: Sequence[Sign]) -> bool:
    """Whether a run may deny, bound, ask for, or count what is ordered, or name what else is to be moved."""
    labels = {sign.label for sign in signs}
    in_scope = any(sign.label in BEARING | _BOUND for sign in before)
    moved = any(sign.text in relation_words("moved") for sign in (*before, *signs))
    if signs[0].label not in _SUBJECTS:
        named = any(names_way(unit) for sign in signs for unit in sign.text.split("_"))
        moved |= named or bool(before and any(sign.moves and sign.label in COUNTED for sign in signs))
    return in_scope or moved or bool(labels & BEARING) or signs[0].label == "condition"


def _stands_behind(signs: Sequence[Sign], before: Sequence[Sign]) -> bool:
    """Whether the order may be told before a run, and the run is no part of it."""
    if not before:
        return True
    named = before[-1].label in _POINTING and signs[0].text in relation_words("articles") and len(signs) < 3
    is_part = named or relates(signs[0]) or _goes_on(signs[0]) or _is_meant(signs) or signs[0].label == "did"
    return before[-1].label in _CLOSES and not is_part


def _is_meant(signs: Sequence[Sign]) -> bool:
    """Whether the robot may be meant to do what the run names: nobody else is said to."""
    at = _first_verb(signs)
    return at >= 0 and not any(sign.label in _SUBJECTS for sign in signs[:at])


def _first_verb(signs: Sequence[Sign]) -> int:
    return next((i for i, sign in enumerate(signs) if sign.moves and sign.label in ("VERB", "PLACE")), -1)


def relates(sign: Sign) -> bool:
    """Whether it says how the motion before lies to something: `past the fern`, `via the hall`."""
    return sign.text in _relations()


@lru_cache(maxsize=1)
def _relations() -> frozenset[str]:
    return relation_words("words") | relation_words("towards") | relation_words("restricting")


def odds_set_off(text: str, names: Names, start: int, stop: int) -> float:
    """The odds of an aside of part of a text, as if marks set it off."""
    head, said, rest = text[:start].rstrip(" ,"), text[start:stop].strip(" ,"), text[stop:].lstrip(" ,")
    before = "" if not head else " " if head[-1] in MARKS else ", "
    after = "" if not rest or rest[0] in MARKS or said[-1] in MARKS else ","
    at = len(head + before)
    reads = read_acts(f"{head}{before}{said}{after} {rest}".strip(), names)
    read = next((read for read in reads if read.clause.start <= at < read.clause.stop), None)
    aside = asides(reads).get(read.clause.start) if read is not None else None
    return aside.odds if aside is not None else BEARS


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
    if len(tail) < 2 or not has_amount(clause) or not _stands_behind(tail, told) or _may_bear(tail, told):
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
