"""Parts of a text without which it may be an order that is understood, the likeliest first.

Each run of words of a clause and each run of whole clauses is tried. How likely one is the right one is the sum of
weights of what it says, of what stands beside it, and of where the rules stumbled. `nearest.py` reads the rest.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from chatrobot.language.acts import read_acts
from chatrobot.language.aside_features import frame_word
from chatrobot.language.beside import BEARS, MAYBE_ASIDE, SURELY_NOT_MEANT, asides
from chatrobot.language.data_files import relation_words
from chatrobot.language.fitted import SCALE, bucket, slot_of, weights
from chatrobot.language.left_out import MARKS, relates, without
from chatrobot.language.signs import Clause, Names, Sign
from chatrobot.language.unclear import Unclear

MOST_WORDS, MOST_SIGNS = 8, 70
"""A run within a clause has at most so many words, and a text that is looked at so many."""
_DOES = frozenset({"VERB", "DIR", "ROT", "SHAPE"})
_NUMBERS = frozenset({"NUMBER", "SCALE"})
_IDLE = frozenset({"VERB", "PLACE", "COUNTER"})
"""Labels of words of motion that people say of other things, too; every other one is of the order."""
SURE_CLAUSE = 2.0
"""Words are left out of a clause only where it has higher odds of an order."""
_LIGHT = frozenset({"FLAG", "PACE"})
_BINDS = frozenset({"not", "condition", "correction", "later", "contrast", "hypothetical"})
"""Labels of words that may change what is meant, but in a clause that is surely an aside."""
_DECIMAL = re.compile(r"\d[.,]\d")
"""`2,35 m`: no part ends within a number."""
_STAYS = ("not", "condition", "question", "correction", "later", "report", "did", "past", "earlier", "hypothetical",
          "contrast")  # fmt: skip


@dataclass(frozen=True)
class Omission:
    """What is left out, where it begins and ends in which text, and the text without it.

    `slots`: those of its features; `log_odds`: how likely it is the right one; `is_known`: everybody knows its words;
    `is_within`: it is part of a clause; `may_matter`: an amount, a way, a condition or another deed may be among them.
    """

    text: str
    start: int
    stop: int
    rest: str
    slots: tuple[int, ...]
    log_odds: float
    is_known: bool
    may_matter: bool
    is_within: bool

    @property
    def said(self) -> str:
        return self.text[self.start : self.stop].strip(MARKS)


class Unit(NamedTuple):
    """A word of a text, the clause it stands in, and its place there."""

    sign: Sign
    clause: Clause
    at: int


class _Text:
    """A text in words, and what its clauses are by themselves."""

    def __init__(self, text: str, problem: Unclear, names: Names) -> None:
        self.text, self.code = text, problem.code
        reads = read_acts(text, names)
        self.units = [
            Unit(sign, read.clause, at) for read in reads for at, sign in enumerate(read.clause.signs)
        ]
        self.labels = ["^", *(unit.sign.known_label for unit in self.units), "$"]
        self.words = ["^", *(frame_word(unit.sign) for unit in self.units), "$"]
        self.odds = {start: aside.odds for start, aside in asides(reads).items()}
        self.orders = {read.clause.start: read.log_odds for read in reads}
        self.part = "".join(problem.part.split()).rstrip("…")

    def runs(self) -> Iterator[tuple[int, int]]:
        """Where each run of words begins and ends that may be left out."""
        count = len(self.units)
        begins = [at for at, unit in enumerate(self.units) if unit.at == 0]
        for begin in range(count):
            ends = {end for end in (*begins, count) if end > begin} if begin in begins else set()
            last = begin
            while (
                last < min(count, begin + MOST_WORDS) and self.units[last].clause is self.units[begin].clause
            ):
                last += 1
                ends.add(last)
            yield from ((begin, end) for end in sorted(ends) if end - begin < count)

    def is_end(self, at: int) -> bool:
        return at == len(self.units) or self.units[at].at == 0

    def extent(self, begin: int, end: int) -> tuple[int, int]:
        """Where a run stands in the text; with the mark behind it where it is whole clauses."""
        start, last = self.units[begin].sign.start, self.units[end - 1]
        if not self.is_end(end):
            return start, self.units[end].sign.start
        if self.units[begin].at == 0:
            return start, last.clause.stop
        return start, start + len(self.text[start : last.clause.stop].rstrip(MARKS))

    def may_matter(self, begin: int, end: int) -> bool:
        """Whether a run may say how far, how often, which way, on what terms, or what else."""
        units = self.units[begin:end]
        moving = {unit.sign.label for unit in units if unit.sign.moves and unit.sign.label.isupper()}
        bound = bool(moving & _LIGHT) or any(unit.sign.label in _BINDS for unit in units)
        if self.is_within(begin, end):
            near = self.units[max(begin - min(units[0].at, 2), 0) : end]  # `to the giraffe`
            if moving or bound or any(map(_leads, near)) or self._goes_on(begin, end):
                return True
            return not (self._tells(begin, end) or self._orders_without(begin, end))
        odds = min(self.odds.get(unit.clause.start, 0.0) for unit in units)
        is_related = any(unit.at == 0 and relates(unit.sign) for unit in units)
        least = SURELY_NOT_MEANT if bound else MAYBE_ASIDE
        return is_related or bool(moving - _IDLE - _LIGHT) or odds < least

    def is_within(self, begin: int, end: int) -> bool:
        """Whether a run is no whole clauses."""
        return self.units[begin].at != 0 or not self.is_end(end)

    def _goes_on(self, begin: int, end: int) -> bool:
        """Whether a run goes on a number, or joins something to a motion: `3 号桌`, `then greet me`."""
        row = self.units[begin - min(self.units[begin].at, 1) : begin + 1]
        joins = any(unit.at != 0 and unit.sign.label == "opening" for unit in row)
        return row[0].sign.label in _NUMBERS or (joins and self.is_end(end))

    def _tells(self, begin: int, end: int) -> bool:
        """Whether the clauses of a run are surely asides."""
        starts = {unit.clause.start for unit in self.units[begin:end]}
        return min(self.odds.get(start, BEARS) for start in starts) >= MAYBE_ASIDE

    def _orders_without(self, begin: int, end: int) -> bool:
        """Whether each clause of a run surely orders something, and what is kept says what to do."""
        starts = {unit.clause.start for unit in self.units[begin:end]}
        kept = [*self.units[:begin], *self.units[end:]]
        does = any(unit.sign.label in _DOES for unit in kept)
        moving = {unit.clause.start for unit in kept if unit.sign.moves}
        return does and starts <= moving and min(self.orders[start] for start in starts) >= SURE_CLAUSE

    def features(self, begin: int, end: int) -> Iterator[str]:
        """What the run from `begin` to `end` is like, in words."""
        units, labels, words = (
            self.units[begin:end],
            self.labels[begin + 1 : end + 1],
            self.words[begin + 1 : end + 1],
        )
        kind = f"{int(units[0].at == 0)}{int(self.is_end(end))}"
        said = "".join(unit.sign.text for unit in units).replace("_", "")
        is_hit = bool(self.part) and (self.part in said or said in self.part)
        moving = sum(unit.sign.moves and unit.sign.label.isupper() for unit in units)
        yield from (
            "bias",
            f"a{kind}",
            f"n{kind}{min(end - begin, 9)}",
            f"t{begin == 0}{end == len(self.units)}",
        )
        yield from (
            f"p{is_hit}",
            f"p{is_hit}{kind}",
            f"c{self.code}{is_hit}",
            f"h{is_hit}{min(end - begin, 5)}",
        )
        yield from (f"m{min(moving, 4)}", f"v{kind}{min(moving, 2)}")
        yield from (name for label in labels for name in (f"D{label}", f"E{kind}{label}"))
        yield from (f"W{word}" for word in words)
        yield from (f"d{label}" for label in sorted(set(labels)))
        yield from (f"B{first} {second}" for first, second in itertools.pairwise(words))
        yield from (f"b{first} {second}" for first, second in itertools.pairwise(labels))
        for name, row, own in (("", self.labels, labels), ("w", self.words, words)):
            before, after = row[begin], row[end + 1]
            yield from (f"L{name}{before}|{own[0]}", f"R{name}{own[-1]}|{after}", f"X{name}{before}|{after}")
        yield from (f"F{words[0]}", f"G{words[-1]}")
        if kind == "11":
            yield from self._of_clauses({unit.clause.start for unit in units}, min(moving, 2))
        kept = [*self.labels[: begin + 1], *self.labels[end + 1 :]]
        yield f"k{min(kept.count('?'), 8)}"
        yield from (f"K{label}" for label in _STAYS if label in kept)

    def _of_clauses(self, starts: set[int], moving: int) -> Iterator[str]:
        odds = min((self.odds[start] for start in starts if start in self.odds), default=None)
        if odds is not None:
            yield from (f"O{bucket(odds)}", f"o{bucket(odds)}{moving}")
        yield f"I{bucket(max(self.orders[start] for start in starts), 1.5)}"


def _leads(unit: Unit) -> bool:
    return relates(unit.sign) or unit.sign.text in relation_words("leading")


def omissions(text: str, problem: Unclear, names: Names) -> list[Omission]:
    """What may be left out of a normalised text that raised `problem`, the likeliest first; nothing of a long text."""
    marked = _Text(text, problem, names)
    if not 1 < len(marked.units) <= MOST_SIGNS:
        return []
    fitted, decimals = weights("omissions"), list(_DECIMAL.finditer(text))
    best: dict[str, Omission] = {}
    for begin, end in marked.runs():
        start, stop = marked.extent(begin, end)
        if any(found.start() < at < found.end() for found in decimals for at in (start, stop)):
            continue
        rest = without(text, start, stop)
        slots = tuple(slot_of(name) for name in marked.features(begin, end))
        odds = sum(map(fitted.__getitem__, slots)) / SCALE
        if len(rest) > 1 and (rest not in best or best[rest].log_odds < odds):
            known = all(unit.sign.known_label != "?" for unit in marked.units[begin:end])
            best[rest] = Omission(
                text,
                start,
                stop,
                rest,
                slots,
                odds,
                known,
                marked.may_matter(begin, end),
                marked.is_within(begin, end),
            )
    return sorted(best.values(), key=lambda one: -one.log_odds)
