"""The likeliest reading of a text that the rules do not cover whole: it is done where it is sure, else proposed.

Clauses that tell of something, and hold nothing that could bear on the order, are talk: the order beside them is done.
Where the rules stumble on anything else, the clause it stands in is left out, or only words that nobody knows
(`pared.py`). What was left out is named, and the plan of the rest proposed.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from chatrobot.core.event import Proposal
from chatrobot.language.acts import ORDER, Read, order_log_odds, read_acts, talk_in
from chatrobot.language.bare_orders import is_bare_order
from chatrobot.language.beside import (
    BEARS,
    MAYBE_ASIDE,
    SURE_ASIDE,
    SURELY_NOT_MEANT,
    Aside,
    any_may_bear,
    asides,
    begins_condition,
    is_reported,
    is_sure_aside,
    odds_beside_asides,
    refers,
)
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.last_motion import unit_after
from chatrobot.language.left_out import NO_ORDER, Span, leads_amount, may_order, place_of, told_spans
from chatrobot.language.names import names_in
from chatrobot.language.numbers import FAR_M
from chatrobot.language.phrases import describe_plan, say
from chatrobot.language.pointing import may_change
from chatrobot.language.reading import Reading
from chatrobot.language.set_off import odds_without, set_off
from chatrobot.language.signs import Names, clauses_of
from chatrobot.language.strange_words import is_bound, is_complete, strange_spans
from chatrobot.language.typos import neighbours_of
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Plan, Turn
from chatrobot.plan.text import format_plan

TALK, APART = 1.5, 3.0
"""A clause may be sure talk below these odds, and where the order's are higher by so much."""
NO_MOTION = -4.0
"""A clause without any word of motion is sure talk below these odds, whatever its words are."""
MOST_CLAUSES, MOST_PARTS, MOST_READS = 12, 4, 16
"""So many clauses are looked at one by one, so many parts are left out of what is proposed, and so many texts read."""
SURE_TALK, SURE_CONDITION = -1.5, 1.0
"""In a text that orders nothing as a whole, what is left out has lower odds of an order."""
STUMBLED = frozenset({"unknown_part", "unclear_motion", "nothing_to_do"})
"""Why a text was not read, where it may have talk in it that no mark sets off."""
_ALONE = frozenset({"NUMBER", "FLAG"})
"""Beside nothing else that moves a number stands alone: `and 45 more`."""
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_TOLD = frozenset({"NUMBER", "FRACTION", "SCALE", "MULTIPLE", "TIMES", "ROT", "FULLTURN", "SHAPE"})
"""Labels of words of amounts and ways, which no proposal leaves out unless they are surely said beside the order."""
_DEG = "deg"
_DECIMAL = re.compile(r"\d*\.?\d+")

Reader = Callable[[str], Interpretation]


def likeliest(
    plain: str, problem: Unclear, reading: Reading, read: Reader, read_anew: Reader
) -> Interpretation | None:
    """What a normalised text most likely means, where `read` raised `problem`; None where it orders nothing.

    Either a plan, or a question that proposes one. `read_anew` reads as if nothing had been said before.
    """
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
    is_closed = problem.refused or problem.code not in STUMBLED
    search = _Search(names, language, read, read_anew, best, asks, is_closed)
    if best < ORDER:
        return search.proposal(plain, problem) if problem.code in STUMBLED else None
    if problem.code == "no_unit":
        return _with_unit(plain, problem.part, language, read, unit_after(reading.context))
    gone, is_sure = _talk(plain, problem, reads, apart, best)
    kept = [read for read in reads if read not in gone]
    parts = tuple(_said(plain, read).strip(" ,.;:!") for read in gone)
    try:
        meant = read(rest := _kept(plain, kept))
    except Unclear as stumbled:
        found = search.proposal(rest, stumbled, parts)
        return found or (search.proposal(plain, problem) if gone and not problem.refused else None)
    is_sure &= bool(pointing) or not is_bare_order(meant.plan, kept, gone, reading.pace)
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
    gone = [clause for clause in reads if clause in talk or _is_sure_talk(clause, best)]
    doubtful = [read for read in gone if read not in apart]
    is_sure = bool(apart) or not problem.refused or _is_clearly_told(plain, problem, told, odds)
    points = any(refers(read.clause) for read in reads)
    bears = any_may_bear(reads, doubtful) or (points and any(may_change(read, odds) for read in doubtful))
    return gone, is_sure and not bears


@dataclass
class _Search:
    """Looks for the order in a text, where the rules stumble: what is left out then is tried part by part."""

    names: Names
    language: LanguageCode
    read: Reader
    read_anew: Reader
    best: float
    asks: bool
    is_closed: bool
    reads_left: int = MOST_READS
    seen: set[str] = field(default_factory=set)

    def proposal(self, text: str, problem: Unclear, gone: tuple[str, ...] = ()) -> Interpretation | None:
        """The likeliest order in `text`, proposed, where `read` raised `problem`; None where none is found."""
        found = self._found(text, problem, ())
        mended = self._mistyped(text, problem)
        words = found is None or any(span.odds is None for span in found[1])
        if mended is not None and words:
            other = found is not None and found[0].plan != mended.plan
            return None if other else proposed(mended, self.language, (problem.part,))
        if found is None:
            return None
        return proposed(found[0], self.language, (*(span.said for span in found[1]), *gone))

    def _found(
        self, text: str, stumbled: Unclear, left_out: tuple[Span, ...]
    ) -> tuple[Interpretation, tuple[Span, ...]] | None:
        for span in self._spans(text, stumbled):
            if span.text in self.seen or self.reads_left <= 0 or len(left_out) >= MOST_PARTS:
                continue
            self.seen.add(span.text)
            self.reads_left -= 1
            parts = (*left_out, span)
            try:
                meant = self.read(span.text)
            except Unclear as again:
                found = self._found(span.text, again, parts)
                if found is not None:
                    return found
                continue
            if meant.plan is not None and self._is_whole(meant, span.text, parts):
                return meant, parts
        return None

    def _spans(self, text: str, stumbled: Unclear) -> Iterator[Span]:
        """What may be left out of a text that is not read, the likeliest first."""
        at = place_of(stumbled.part, text)
        if self.best < ORDER:
            told = told_spans(text, self.names, range(0))
            yield from (span for span in told if span.log_odds < SURE_TALK and not span.tells)
            return
        yield from self._clause(text, stumbled)
        if self.is_closed or stumbled.refused or stumbled.code not in STUMBLED:
            return
        if not self.asks:
            yield from (span for span in told_spans(text, self.names, at) if span.log_odds < NO_ORDER)
        if stumbled.code == "unknown_part":
            yield from strange_spans(text, self.names, at)

    def _clause(self, text: str, stumbled: Unclear) -> Iterator[Span]:
        """The clause that the rules stumbled in, where it may be no part of what was meant."""
        reads = read_acts(text, self.names)
        part = "".join(stumbled.part.split()).rstrip("…")
        held = [read for read in reads if part and part in "".join(_said(text, read).split())]
        odds = {} if self.asks else asides(reads)
        others = [read for read in reads if read not in held[-1:]]
        if held and _may_be_left_out(held[-1], others, stumbled, self.best, odds):
            aside = odds.get(held[-1].clause.start)
            said = _said(text, held[-1]).strip(" ,.;:!")
            yield Span(_kept(text, others), said, aside.odds if aside else 0.0)

    def _is_whole(self, meant: Interpretation, text: str, left_out: Sequence[Span]) -> bool:
        """Whether what is left orders something, and nothing that it needs is missing."""
        reads = read_acts(text, self.names)
        if order_log_odds(reads) < ORDER and not any(refers(read.clause) for read in reads):
            return False
        words = [span for span in left_out if span.odds is None]
        if not words or all(span.points for span in words):
            return True
        # What was left out may be what is to be changed.
        return is_complete(text, self.names) and _means_the_same(meant, text, self.read_anew)

    def _mistyped(self, text: str, problem: Unclear) -> Interpretation | None:
        """What `text` means with one typing error mended that makes another word of it; None where that is not sure."""
        signs = [sign for clause in clauses_of(text, self.names) for sign in clause.signs]
        unsure = (
            problem.code != "unknown_part"
            or problem.refused
            or self.best < ORDER
            or is_bound(text, self.names)
        )
        if unsure or [sign.label for sign in signs if sign.text == problem.part] != [problem.part]:
            return None
        found: list[Interpretation] = []
        for known in neighbours_of(problem.part):
            try:
                meant = self.read(re.sub(rf"\b{re.escape(problem.part)}\b", known, text, count=1))
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


def _with_unit(
    plain: str, number: str, language: LanguageCode, read: Reader, unit: str
) -> Interpretation | None:
    """`Drive 50`: in metres, or in centimetres where that would be far; a number alone in the unit used before."""
    at = [found.start() for found in re.finditer(rf"(?<![a-z\d_.]){re.escape(number)}(?![a-z\d_.])", plain)]
    if len(at) != 1 or not _DECIMAL.fullmatch(number) or plain[: at[0]].endswith(" at "):
        return None  # `back at 20`: how fast
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
            meant = read(f"{plain[:end]} {each}{plain[end:]}")
            steps = meant.plan.steps if meant.plan is not None else ()
            if not is_angle or each == unit or any(isinstance(step, Turn) for step in steps):
                return proposed(meant, language)
    return None


def _is_sure_talk(read: Read, best: float) -> bool:
    clause = read.clause
    if not (clause.moves or clause.depends or clause.denies) and read.log_odds < min(NO_MOTION, best - APART):
        return True
    return clause.talks and not clause.binds and read.log_odds < min(TALK, best - APART)


def _may_be_left_out(
    read: Read, others: Sequence[Read], stumbled: Unclear, best: float, odds: Mapping[int, Aside]
) -> bool:
    """Whether the clause is no part of what is ordered, or most likely an aside to it."""
    # `Nudge to the left by my hand's width, say ten centimetres`: what says which way is part of the order.
    if not any(read.clause.is_covered_by(other.clause) for other in others):
        return False
    aside = odds.get(read.clause.start)
    odds_of = aside.odds if aside is not None else BEARS
    quotes = odds_of <= BEARS and any(sign.label == "report" for sign in read.clause.signs)
    if quotes or (begins_condition(read.clause) and odds_of < SURE_CONDITION):
        return False
    told = any(sign.moves and sign.label in _TOLD for sign in read.clause.signs)
    if told and not any(other.clause.measures for other in others):
        return False
    if told and (aside is None or aside.odds < SURE_ASIDE or read.log_odds >= NO_ORDER):
        return False  # no amount of what is ordered is missing in a proposal
    least = SURE_ASIDE if stumbled.refused else MAYBE_ASIDE
    if aside is not None and aside.odds >= least and not read.clause.denies:
        return True
    return (read.clause.talks or not stumbled.refused) and _leaves_order(read, others, best)


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


def _leaves_order(read: Read, others: Sequence[Read], best: float) -> bool:
    """Whether `read` may be no part of what is ordered, and what is left orders something."""
    clause = read.clause
    moving = [other for other in others if other.clause.moves]
    passable = not (clause.measures or clause.depends) and read.log_odds < min(NO_ORDER, best + 1.0)
    return passable and bool(moving) and order_log_odds(moving) >= ORDER


def _means_the_same(found: Interpretation, text: str, read_anew: Reader) -> bool:
    try:
        return read_anew(text).plan == found.plan
    except Unclear:
        return False
