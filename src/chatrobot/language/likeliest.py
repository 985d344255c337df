"""The likeliest reading of a text that the rules do not cover whole: it is done where it is sure, else proposed.

Clauses that tell of something, and hold nothing that could bear on the order, are talk: the order beside them is done.
Where the rules stumble on anything else, the clause it stands in is left out, or only words that nobody knows
(`pared.py`). What was left out is named, and the plan of the rest proposed.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from chatrobot.core.event import Proposal
from chatrobot.language.acts import ORDER, Read, order_log_odds, read_acts
from chatrobot.language.bare_order import bare_orders
from chatrobot.language.beside import (
    MAYBE_ASIDE,
    SURE_ASIDE,
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
from chatrobot.language.pared import mistyped, pared
from chatrobot.language.phrases import describe_plan, say
from chatrobot.language.set_off import odds_without, set_off
from chatrobot.language.signs import Names, clauses_of
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan

TALK, APART = 1.5, 3.0
"""A clause may be sure talk below these odds, and where the order's are higher by so much."""
NO_MOTION = -4.0
"""A clause without any word of motion is sure talk below these odds, whatever its words are."""
NO_ORDER = 3.5
"""A clause without an amount may be left out of a proposal below these odds."""
MOST_CLAUSES, MOST_PARTS = 12, 3
"""So many clauses are looked at one by one, and so many parts are left out of what is proposed."""
FAR_M = 10.0
"""A bare number above that is no number of metres."""
_ALONE = frozenset({"NUMBER", "FLAG"})
"""Beside nothing else that moves a number stands alone: `and 45 more`."""
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_TOLD = frozenset({"NUMBER", "FRACTION", "SCALE", "MULTIPLE", "TIMES", "ROT", "FULLTURN", "SHAPE"})
"""Labels of words of amounts and ways, which no proposal leaves out unless they are surely said beside the order."""
_DEG = "deg"
_DECIMAL = re.compile(r"\d*\.?\d+")

Reader = Callable[[str], Interpretation]


@dataclass
class _Rest:
    """What is read of a text: the clauses that are kept."""

    plain: str
    kept: list[Read]
    left_out: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        parts = (self.said(read) + _mark_behind(self.said(read), read) for read in self.kept)
        return " ".join(parts).strip(" ,;:")

    def said(self, read: Read) -> str:
        return self.plain[read.clause.start : read.clause.stop].strip()

    def leave_out(self, read: Read) -> None:
        self.kept.remove(read)
        self.left_out.append(self.said(read).strip(" ,.;:!"))

    def with_part(self, part: str) -> Read | None:
        """The clause that was not understood: the last that holds `part`."""
        squeezed = "".join(part.split()).rstrip("…")
        held = [read for read in self.kept if squeezed and squeezed in "".join(self.said(read).split())]
        return held[-1] if held else None


def _mark_behind(said: str, read: Read) -> str:
    """The mark behind a clause that was parted without one: `wait 10 s so they can unload you`."""
    return "" if said.endswith(read.clause.end) else read.clause.end


def likeliest(
    plain: str,
    names: Names,
    language: LanguageCode,
    problem: Unclear,
    read: Reader,
    read_anew: Reader,
    unit: str = "",
) -> Interpretation | None:
    """What a normalised text most likely means, where `read` raised `problem`; None where it orders nothing.

    Either a plan, or a question that proposes one. `read_anew` reads as if nothing had been said before.
    `unit` is the one that a bare number has after the motion before.
    """
    reads = read_acts(plain, names)
    best = odds_beside_asides(plain, reads, names)
    # A question that a fact answers is not passed over for a motion, nor is the motion for it.
    asks = problem.code == "question_beside"
    apart = [] if asks else set_off(plain, reads, language, names)
    best = max(best, odds_without(plain, reads, apart, names))
    pointing = [read for read in reads if refers(read.clause)]  # `undo that, I forgot to film it`
    if pointing and not is_reported(reads, pointing):
        best = max(best, ORDER)
    if best < ORDER or len(reads) > MOST_CLAUSES:
        return None
    if problem.code == "no_unit":
        return _with_unit(plain, problem.part, language, read, unit)
    rest = _Rest(plain, list(reads))
    odds = {} if asks else asides(reads)
    told = [read for read in reads if is_sure_aside(read.clause, odds) and _is_no_part(read, reads, odds)]
    for clause in [clause for clause in reads if clause in (*apart, *told) or _is_sure_talk(clause, best)]:
        rest.leave_out(clause)
    is_sure = bool(apart) or not problem.refused or _is_clearly_told(rest, problem, told, odds)
    is_sure &= not any_may_bear(reads, [read for read in reads if read not in (*rest.kept, *apart)])
    for _ in range(MOST_PARTS + 1):
        try:
            meant = read(rest.text)
        except Unclear as stumbled:
            if not _left_out_clause(rest, stumbled, best, odds):
                found = _in_part(rest, stumbled, language, names, read, read_anew)
                return found or (None if problem.refused else _bare(plain, names, language, read))
            is_sure = False
            continue
        return meant if is_sure else proposed(meant, language, rest.left_out)
    return None


def proposed(
    found: Interpretation, language: LanguageCode, left_out: Sequence[str] = (), *, code: str = "did_you_mean"
) -> Interpretation | None:
    """The question whether that is meant; None where there is nothing to do."""
    if found.plan is None:
        return None
    asked = offer(found.plan, language, code=code)
    named = max(left_out, key=len, default="")
    reply = f"{say(language, 'left_out', part=named)} {asked.say}" if named else asked.say
    return Interpretation("unclear", reply, language, unaccounted=named, code=code, proposal=asked)


def offer(plan: Plan, language: LanguageCode, *, code: str = "held") -> Proposal:
    """A plan, and the question whether it is to be driven."""
    return Proposal(format_plan(plan), say(language, code, text=describe_plan(plan, language)))


def _in_part(
    rest: _Rest, stumbled: Unclear, language: LanguageCode, names: Names, read: Reader, read_anew: Reader
) -> Interpretation | None:
    """What is ordered without the words that nobody knows, or with a typing error mended, proposed."""
    if stumbled.refused or stumbled.code != "unknown_part":
        return None
    found = pared(rest.text, names, stumbled, read)
    mended = mistyped(rest.text, names, stumbled, read)
    if mended is not None:
        other = found is not None and found.meant.plan != mended.plan
        return None if other else proposed(mended, language, (stumbled.part,))
    # What was left out may be what is to be changed.
    if found is not None and (found.points or _means_the_same(found.meant, found.text, read_anew)):
        return proposed(found.meant, language, (*found.left_out, *rest.left_out))
    return None


def _bare(plain: str, names: Names, language: LanguageCode, read: Reader) -> Interpretation | None:
    """What is ordered without what stands before, behind or beside it, proposed."""
    for bare in bare_orders(plain, names):
        if order_log_odds(read_acts(bare.text, names)) < ORDER:
            continue
        try:
            found = read(bare.text)
        except Unclear:
            continue
        if found.plan is not None:
            return proposed(found, language, bare.left_out)
    return None


def _with_unit(
    plain: str, number: str, language: LanguageCode, read: Reader, unit: str
) -> Interpretation | None:
    """`Drive 50`: in metres, or in centimetres where that would be far; a number alone in the unit used before."""
    at = [found.start() for found in re.finditer(rf"(?<![a-z\d_.]){re.escape(number)}(?![a-z\d_.])", plain)]
    if (
        len(at) != 1 or not _DECIMAL.fullmatch(number) or plain[: at[0]].endswith(" at ")
    ):  # `back at 20`: how fast
        return None
    moving = (sign for clause in clauses_of(plain) for sign in clause.signs if sign.moves)
    if unit in ("", "m") or (unit == _DEG and any(sign.label not in _ALONE for sign in moving)):
        unit = "m" if float(number) <= FAR_M else "cm"
    end = at[0] + len(number)
    try:
        return proposed(read(f"{plain[:end]} {unit}{plain[end:]}"), language)
    except Unclear:
        return None


def _is_sure_talk(read: Read, best: float) -> bool:
    clause = read.clause
    if not (clause.moves or clause.depends or clause.denies) and read.log_odds < min(NO_MOTION, best - APART):
        return True
    return clause.talks and not clause.binds and read.log_odds < min(TALK, best - APART)


def _left_out_clause(rest: _Rest, stumbled: Unclear, best: float, odds: Mapping[int, Aside]) -> bool:
    """Leave out the clause that the rules stumbled in; False where it may be part of what was meant."""
    clause = rest.with_part(stumbled.part)
    if clause is None or not _may_be_left_out(rest, clause, stumbled, best, odds):
        return False
    rest.leave_out(clause)
    return True


def _may_be_left_out(
    rest: _Rest, read: Read, stumbled: Unclear, best: float, odds: Mapping[int, Aside]
) -> bool:
    """Whether the clause is no part of what is ordered, or most likely an aside to it."""
    # `Nudge to the left by my hand's width, say ten centimetres`: what says which way is part of the order.
    if not any(read.clause.is_covered_by(other.clause) for other in rest.kept if other is not read):
        return False
    aside = odds.get(read.clause.start)
    told = any(sign.moves and sign.label in _TOLD for sign in read.clause.signs)
    if told and (aside is None or aside.odds < SURE_ASIDE or read.log_odds >= NO_ORDER):
        return False  # no amount of what is ordered is missing in a proposal
    least = SURE_ASIDE if stumbled.refused else MAYBE_ASIDE
    if aside is not None and aside.odds >= least and not read.clause.denies:
        return True
    return (read.clause.talks or not stumbled.refused) and _leaves_order(rest, read, best)


def _is_clearly_told(rest: _Rest, problem: Unclear, told: Sequence[Read], odds: Mapping[int, Aside]) -> bool:
    """Whether what is refused stands in a clause that is clearly an aside: not `grab the mug, forward 1 m`."""
    squeezed = "".join(problem.part.split())
    refused = [read for read in told if squeezed in "".join(rest.said(read).split())]
    return bool(told) and all(odds[read.clause.start].odds >= SURELY_NOT_MEANT for read in refused)


def _is_no_part(read: Read, reads: Sequence[Read], odds: Mapping[int, Aside]) -> bool:
    """Whether it stands in a sentence of its own, or the rest says by itself what to do."""
    others = [other.clause for other in reads if other is not read]
    if odds[read.clause.start].apart or any(read.clause.is_covered_by(other) for other in others):
        return True
    return any(sign.moves and sign.label in _DOES for other in others for sign in other.signs)


def _leaves_order(rest: _Rest, read: Read, best: float) -> bool:
    """Whether `read` may be no part of what is ordered, and what is left orders something."""
    clause = read.clause
    others = [other for other in rest.kept if other is not read and other.clause.moves]
    passable = not (clause.measures or clause.depends) and read.log_odds < min(NO_ORDER, best + 1.0)
    return passable and bool(others) and order_log_odds(others) >= ORDER


def _means_the_same(found: Interpretation, text: str, read_anew: Reader) -> bool:
    try:
        return read_anew(text).plan == found.plan
    except Unclear:
        return False
