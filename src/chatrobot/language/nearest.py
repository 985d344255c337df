"""The nearest order that is understood to a text that is not: the text without what the rules stumble on.

What may be left out is tried, the likeliest first (`omissions.py`). Each plan that is read then has a probability
against all others and against none of them: a log-linear choice over what was left out, how many ways lead to the same
plan, and what the whole text is like. The weights of both are fitted by scripts/fit_nearest.py.
"""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from chatrobot.language.acts import Read, order_log_odds, read_acts
from chatrobot.language.fitted import SCALE, bucket, slot_of, weights
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.islands import read_islands
from chatrobot.language.left_out import odds_set_off
from chatrobot.language.names import names_in
from chatrobot.language.omissions import Omission, omissions
from chatrobot.language.reading import Reading
from chatrobot.language.signs import Names
from chatrobot.language.unclear import STUMBLED, Unclear
from chatrobot.plan.text import format_plan

MOST_READS, MOST_BASES, READS_OF_BASE = 12, 3, 5
"""So many texts with one part left out are read. Where none is understood, a second part is left out of each of the
likeliest, and so many of these are read."""
LEAST_ODDS = -3.0
"""Nothing is read into a text with lower odds of an order."""
_CLOSED = frozenset({"question_beside"})
"""What is asked about, and not answered by leaving it out."""
PROPOSED, SURE, SURE_WITHIN, SURELY_ORDERED = 0.55, 0.75, 0.8, 4.75
"""A plan with a higher probability than the first is proposed; with a higher one than the second it is done (than the
third, where words within clauses are left out), if the text has higher odds of an order than the fourth, and nothing
that may matter is left out (decision 85)."""
_DIGITS = re.compile(r"\d+")

Reader = Callable[[str], Interpretation]


@dataclass(frozen=True)
class Candidate:
    """What a text means without some parts, and its plan as text.

    `passed_over`: only the words of motion were read, and these were not.
    """

    left_out: tuple[Omission, ...]
    meant: Interpretation
    plan_text: str
    passed_over: tuple[str, ...] = ()

    @property
    def left_out_count(self) -> int:
        """How many characters are left out, or passed over."""
        return sum(len(one.said) for one in self.left_out) or sum(map(len, self.passed_over))


@dataclass(frozen=True)
class Nearest:
    """The likeliest plan, what was left out for it, and its probability. `is_sure`: it may be done without asking."""

    meant: Interpretation
    left_out: tuple[str, ...]
    probability: float
    is_sure: bool


def nearest(text: str, problem: Unclear, reading: Reading, read: Reader) -> Nearest | None:
    """The likeliest plan of a normalised text that raised `problem`; None where no part of it is an order."""
    names = names_in(reading.context)
    reads = read_acts(text, names)
    ordered = order_log_odds(reads)
    if problem.code in _CLOSED or ordered < LEAST_ODDS:
        return None
    found = candidates(text, problem, reading, read)
    if not found:
        return None
    fitted = weights("nearest")

    def odds(slots: Sequence[int]) -> float:
        return sum(map(fitted.__getitem__, slots)) / SCALE

    scores = [odds(slots) for slots in choice_slots(found, names)]
    none = odds(text_slots(reads, problem))
    top = max(*scores, none)
    shares: defaultdict[str, float] = defaultdict(float)
    for one, score in zip(found, scores):
        shares[one.plan_text] += math.exp(score - top)
    total = sum(shares.values()) + math.exp(none - top)
    best = max(shares, key=lambda plan_text: shares[plan_text])
    same = [one for one in found if one.plan_text == best]
    safe = [one for one in same if one.left_out and not any(part.may_matter for part in one.left_out)]
    chosen = min(safe or same, key=lambda one: one.left_out_count)
    said = tuple(one.said for one in chosen.left_out) or chosen.passed_over
    probability = shares[best] / total
    whole = any(not part.is_within for one in safe for part in one.left_out)
    is_likely = bool(safe) and probability >= (SURE if whole else SURE_WITHIN)
    is_sure = is_likely and ordered >= SURELY_ORDERED and problem.code in STUMBLED
    return Nearest(chosen.meant, said, probability, is_sure)


def candidates(text: str, problem: Unclear, reading: Reading, read: Reader) -> list[Candidate]:
    """What is understood with one part of the text left out; where nothing is, with two; and the words of motion."""
    names = names_in(reading.context)
    tried = omissions(text, problem, names)
    if problem.code == "no_unit":
        tried = []  # a number is not passed over
    elif problem.code not in STUMBLED and not problem.refused:
        tried = [one for one in tried if not one.is_known]  # what is known is asked about
    found, stumbled = _read_each((), tried[:MOST_READS], read)
    for one, again in [] if found else stumbled[:MOST_BASES]:
        found += _read_each((one,), omissions(one.rest, again, names)[:READS_OF_BASE], read)[0]
    islands = read_islands(text, problem, reading)
    if islands is not None and islands[0].plan is not None:
        found.append(Candidate((), islands[0], format_plan(islands[0].plan), tuple(islands[1])))
    return found


def _read_each(
    left_out: tuple[Omission, ...], tried: Sequence[Omission], read: Reader
) -> tuple[list[Candidate], list[tuple[Omission, Unclear]]]:
    found: list[Candidate] = []
    stumbled: list[tuple[Omission, Unclear]] = []
    for one in tried:
        try:
            meant = read(one.rest)
        except Unclear as again:
            stumbled.append((one, again))
            continue
        if meant.plan is not None:
            found.append(Candidate((*left_out, one), meant, format_plan(meant.plan)))
    return found, stumbled


def choice_slots(found: Sequence[Candidate], names: Names) -> list[tuple[int, ...]]:
    """The slots of the features of each candidate, beside the others."""
    pared = [one for one in found if one.left_out]
    votes = Counter(one.plan_text for one in pared)
    fewest = min((len(part.said) for one in pared for part in one.left_out), default=0)
    island = next((one.plan_text for one in found if not one.left_out), "")
    slots: list[tuple[int, ...]] = []
    for one in found:
        features = [
            f"S{min(one.plan_text.count(chr(10)), 6)}",
            f"V{one.plan_text.split(' ')[0]}",
            f"P{min(len(votes), 6)}",
            f"I{bool(island)}{island == one.plan_text}{len(one.left_out)}",
        ]
        if one.left_out:
            own = votes[one.plan_text]
            ordered = order_log_odds(read_acts(one.left_out[-1].rest, names))
            features += [
                f"Q{bucket(ordered)}",
                f"U{bucket(math.log2(own))}|{bucket(math.log2(len(pared) / own))}",
                f"N{bucket(_number_count(one.left_out[-1].rest) - _number_count(one.plan_text))}",
                f"M{bucket(sum(len(part.said) for part in one.left_out) - fewest, 5.0)}",
                *(
                    f"A{bucket(odds_set_off(part.text, names, part.start, part.stop))}"
                    for part in one.left_out
                ),
            ]
        else:
            features += [
                f"i{min(len(one.passed_over), 5)}",
                f"j{bucket(sum(map(len, one.passed_over)), 8.0)}",
            ]
        own_slots = [slot for part in one.left_out for slot in part.slots]
        slots.append((*own_slots, *map(slot_of, features)))
    return slots


def _number_count(text: str) -> int:
    return len(_DIGITS.findall(text))


def text_slots(reads: Sequence[Read], problem: Unclear) -> tuple[int, ...]:
    """The slots of the features that tell that no candidate is meant."""
    signs = [sign for read in reads for sign in read.clause.signs]
    labels = {sign.known_label for sign in signs}
    told = [
        "none",
        f"0c{problem.code}",
        f"0r{problem.refused}{problem.is_final}",
        f"0o{bucket(order_log_odds(reads))}",
        f"0n{min(len(signs) // 4, 8)}",
        f"0k{min(len(reads), 8)}",
        *(f"0l{label}" for label in sorted(labels)),
        *(f"0e{end}" for end in sorted({read.clause.end for read in reads})),
    ]
    return tuple(map(slot_of, told))
