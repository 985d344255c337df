"""The order beside talk in a text that the rules do not cover whole: it is done where it is sure, else proposed.

Clauses that tell of something, and hold nothing that could bear on the order, are talk: the order beside them is done.
Where the rules stumble on anything else, one typing error is mended, or `nearest.py` looks for the order.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Mapping, Sequence

from chatrobot.language.acts import ORDER, Read, may_be_goal, order_log_odds, read_acts, talk_in
from chatrobot.language.bare_orders import is_bare_order
from chatrobot.language.beside import (
    SURELY_NOT_MEANT,
    Aside,
    any_may_bear,
    asides,
    is_reported,
    is_sure_aside,
    odds_beside_asides,
    refers,
)
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.last_motion import unit_after
from chatrobot.language.left_out import leads_amount, may_order
from chatrobot.language.meant import asked_by_remark
from chatrobot.language.names import names_in
from chatrobot.language.nearest import PROPOSED, nearest
from chatrobot.language.numbers import FAR_M
from chatrobot.language.pointing import may_change
from chatrobot.language.proposals import proposed
from chatrobot.language.reading import Reading
from chatrobot.language.set_off import odds_without, set_off, without_goals
from chatrobot.language.signs import Names, clauses_of
from chatrobot.language.strange_words import is_bound
from chatrobot.language.talk import calls_somebody
from chatrobot.language.typos import neighbours_of
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Turn

TALK, APART = 1.5, 3.0
"""A clause may be sure talk below these odds, and where the order's are higher by so much."""
NO_MOTION = -4.0
"""A clause without any word of motion is sure talk below these odds, whatever its words are."""
MOST_CLAUSES = 12
"""A text with more of them is not looked at clause by clause."""
_ALONE = frozenset({"NUMBER", "FLAG"})
"""Beside nothing else that moves a number stands alone: `and 45 more`."""
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_DEG = "deg"
_DECIMAL = re.compile(r"\d*\.?\d+")

Reader = Callable[[str], Interpretation]


def likeliest(
    plain: str, problem: Unclear, reading: Reading, read: Reader, read_order: Reader
) -> Interpretation | None:
    """What a normalised text most likely means, where `read` raised `problem`; None where it orders nothing.

    Either a plan, or a question that proposes one. `read_order` reads no question, and leaves out talk that is sure.
    """
    language = reading.language
    found = _beside_talk(plain, problem, reading, read)
    near = nearest(plain, problem, reading, read_order) if found is None or found.plan is None else None
    is_near = near is not None and near.probability >= PROPOSED
    if found is None and not is_near:
        return _beside_goals(plain, problem, reading, read)
    calls = calls_somebody(read_acts(plain, names_in(reading.context)), language)
    if near is not None and is_near:
        is_done = near.is_sure and not problem.refused and not calls
        found = near.meant if is_done else proposed(near.meant, language, near.left_out)
    if found is not None and problem.is_final:
        found = proposed(found, language) or found
    return None if found is not None and found.plan is None and calls else found


def _beside_goals(plain: str, problem: Unclear, reading: Reading, read: Reader) -> Interpretation | None:
    """The order, proposed, whose amount leads to what nobody knows: `go 2 m to the copier`."""
    left = without_goals(plain, reading.language) if problem.code == "unknown_part" else ""
    if not left or order_log_odds(read_acts(plain, names_in(reading.context))) < ORDER:
        return None
    try:
        return proposed(read(left), reading.language, (problem.part,))
    except Unclear:
        return None


def remarked(text: str, reading: Reading, read: Reader) -> Interpretation | None:
    """What a remark on the turn before asks for, proposed: `oops`, `wrong way`."""
    turns, order = reading.context.dialogue.turns, asked_by_remark(text, reading.language)
    if not order or not any(turn.moved for turn in turns[-3:]):  # `faster`, after a `thanks`
        return None
    try:
        return proposed(read(order), reading.language)
    except Unclear:
        return None


def _beside_talk(plain: str, problem: Unclear, reading: Reading, read: Reader) -> Interpretation | None:
    """The order beside talk, done or proposed; None where there is none, or it is not read."""
    names, language = names_in(reading.context), reading.language
    reads = read_acts(plain, names)
    if len(reads) > MOST_CLAUSES:
        return None
    # A question that a fact answers is not passed over for a motion, nor is the motion for it.
    asks = problem.code == "question_beside"
    apart = [] if asks else set_off(plain, reads, language, names)
    pointing = [read for read in reads if refers(read.clause)]  # `undo that, I forgot to film it`
    best = max(odds_beside_asides(plain, reads, names), odds_without(plain, reads, apart, names))
    best = max(best, ORDER) if pointing and not is_reported(reads, pointing) else best
    if best < ORDER:
        return None
    if problem.code == "no_unit":
        return _with_unit(plain, problem.part, language, read, unit_after(reading.context))
    gone, is_sure = _talk(plain, problem, reads, apart, best)
    kept = [read for read in reads if read not in gone]
    parts = tuple(_said(plain, read).strip(" ,.;:!") for read in gone)
    try:
        meant = read(_kept(plain, kept))
    except Unclear:
        mended = _mistyped(plain, problem, names, read)
        return proposed(mended, language, (problem.part,)) if mended is not None else None
    is_sure &= bool(pointing) or not is_bare_order(meant.plan, kept, gone, reading.pace)
    if problem.code == "nothing_before" and reading.context.dialogue.last_motion is not None:
        is_sure = False  # `step 2 but the other way`, of a single step
    return meant if is_sure else proposed(meant, language, parts)


def _talk(
    plain: str, problem: Unclear, reads: Sequence[Read], apart: Sequence[Read], best: float
) -> tuple[list[Read], bool]:
    """The clauses that are passed over as talk, and whether the order beside them is surely meant without them."""
    asks = problem.code == "question_beside"
    odds = {} if asks else asides(reads)
    told = [
        read
        for read in reads
        if is_sure_aside(read.clause, odds) and not may_order(read) and _is_no_part(read, reads, odds)
    ]
    talk = [*apart, *told, *([] if asks else talk_in(reads))]
    gone = [
        clause
        for clause in reads
        if clause in apart
        or ((clause in talk or _is_sure_talk(clause, best)) and not may_be_goal(clause, reads))
    ]
    doubtful = [read for read in gone if read not in apart]
    is_sure = bool(apart) or not problem.refused or _is_clearly_told(plain, problem, told, odds)
    points = any(refers(read.clause) for read in reads)
    bears = any_may_bear(reads, doubtful) or (points and any(may_change(read, odds) for read in doubtful))
    return gone, is_sure and not bears


def _mistyped(plain: str, problem: Unclear, names: Names, read: Reader) -> Interpretation | None:
    """What a text means with one typing error mended that makes another word of it; None where that is not sure."""
    signs = [sign for clause in clauses_of(plain, names) for sign in clause.signs]
    known = problem.code == "unknown_part" and not problem.refused and not is_bound(plain, names)
    if not known or [sign.label for sign in signs if sign.text == problem.part] != [problem.part]:
        return None
    found: list[Interpretation] = []
    for word in neighbours_of(problem.part):
        try:
            meant = read(re.sub(rf"\b{re.escape(problem.part)}\b", word, plain, count=1))
        except Unclear:
            continue
        if meant.plan is not None and meant.plan not in [other.plan for other in found]:
            found.append(meant)
    return found[0] if len(found) == 1 else None


def _said(plain: str, read: Read) -> str:
    return plain[read.clause.start : read.clause.stop].strip()


def _kept(plain: str, reads: Sequence[Read]) -> str:
    """The clauses that are kept, each with its mark, be it parted without one: `wait 10 s so they can unload you`."""
    said = ((_said(plain, read), read.clause.end) for read in reads)
    return " ".join(text if text.endswith(end) else text + end for text, end in said).strip(" ,;:")


def _with_unit(
    plain: str, number: str, language: LanguageCode, read: Reader, unit: str
) -> Interpretation | None:
    """`Drive 50`: in metres, or in centimetres where that would be far; a number alone in the unit used before."""
    bare = re.compile(rf"(?<![a-z\d_.]){re.escape(number)}(?![a-z\d_.])")
    at = [found.start() for found in bare.finditer(plain)]
    alike = len({plain[:begin].rstrip().rpartition(" ")[2] for begin in at}) == 1
    if not alike or not _DECIMAL.fullmatch(number) or plain[: at[0]].endswith(" at "):
        return None  # `forward 90, left 90`; `back at 20`: how fast
    clauses = [clause for clause in clauses_of(plain) if clause.moves]
    said = {sign.label for clause in clauses for sign in clause.signs if sign.moves}
    after_turn = unit == _DEG and said <= _ALONE | {"DIR", "ROT"}  # `no, right 45`
    if unit in ("", "m") or (unit == _DEG and not said <= _ALONE):
        unit = "m" if float(number) <= FAR_M else "cm"
    end = at[0] + len(number)
    beside = next((one.signs for one in clauses if end <= one.stop), ())
    is_bare = len(clauses) > 1 and not any(sign.label == "VERB" for sign in beside)
    is_next = is_bare and unit == "cm" and float(number) % 15 == 0  # `go 1 m, 90 right, go 1 m`
    is_angle = after_turn or is_next
    for each in (_DEG, unit) if is_angle else (unit,):
        with contextlib.suppress(Unclear):
            meant = read(bare.sub(f"{number} {each}", plain))
            steps = meant.plan.steps if meant.plan is not None else ()
            if not is_angle or each == unit or any(isinstance(step, Turn) for step in steps):
                return proposed(meant, language)
    return None


def _is_sure_talk(read: Read, best: float) -> bool:
    clause = read.clause
    if not (clause.moves or clause.depends or clause.denies) and read.log_odds < min(NO_MOTION, best - APART):
        return True
    return clause.talks and not clause.binds and read.log_odds < min(TALK, best - APART)


def _is_clearly_told(plain: str, problem: Unclear, told: Sequence[Read], odds: Mapping[int, Aside]) -> bool:
    """Whether what is refused stands in a clause that is clearly an aside: not `grab the mug, forward 1 m`."""
    squeezed = "".join(problem.part.split())
    refused = [read for read in told if squeezed in "".join(_said(plain, read).split())]
    return bool(told) and all(odds[read.clause.start].odds >= SURELY_NOT_MEANT for read in refused)


def _is_no_part(read: Read, reads: Sequence[Read], odds: Mapping[int, Aside]) -> bool:
    """Whether it stands in a sentence of its own, or the rest says by itself what to do."""
    others = [other.clause for other in reads if other is not read]
    if leads_amount(read, reads):
        return False
    if odds[read.clause.start].apart or any(read.clause.is_covered_by(other) for other in others):
        return True
    return any(sign.moves and sign.label in _DOES for other in others for sign in other.signs)
