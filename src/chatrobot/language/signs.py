"""A text cut into sentences and clauses, and each word of it labelled: evidence of an act, or a word of motion.

Labels come from data (`acts.toml` of each language, and the lexicon): what they are worth is fitted, see `acts.py`.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

from chatrobot.language.compiled import Kept, Key, PhraseTable, by_first, compiled
from chatrobot.language.data_files import LANGUAGES, expand, load_table, relation_words
from chatrobot.language.lexicon import UNIT, Meaning, lexicon
from chatrobot.language.until import until_spans

_STRONG, _WEAK = frozenset(".!?;。…\n"), frozenset(",:、—~")
_NO_CONTENT = frozenset(
    {"filler", "glue", "sep", "conn", "doubt", "reason", "negation", "condition", "correction", "num",
     "operator", "unknown", "refuse"}
)  # fmt: skip
_MEASURES = frozenset({"UNIT", "SHAPE", "FULLTURN"})
_IDLE = frozenset({"VERB", "DIR", "PLACE", "COUNTER"})
_OPENING = frozenset({"request", "please", "opening", "robot", "hence"})
_JOINTS = frozenset({"joint", "contrast"})
_HENCE = "hence"
_WAYS = frozenset({"DIR", "ROT"})
_PAST = frozenset({"did", "past"})
_BEFORE_GOAL = frozenset({"to", "VERB"})
"""The labels of words that begin a clause of their own; the last where a word of motion follows."""
_FIRST_IDEOGRAPH, _FEWEST = 0x2E7F, 3
_QUOTES = frozenset('"“”「」『』')
_UNITS = "unit_"
_EVIDENCE_KINDS = {"num": "NUMBER", "negation": "not", "condition": "condition", "correction": "correction"}
"""Kinds of the lexicon that move nothing, and their labels here."""
BINDING = frozenset(
    {"not", "condition", "correction", "contrast", "hypothetical", "question", "ask", "request", "please"}
)
"""Labels of words that bear on what stands beside them, or ask for something: a clause with one of them is never
passed over."""
DEPENDING = frozenset({"condition", "contrast", "correction", "question", "ask", "later", "FLAG"})
"""Labels of words on which it may depend whether anything is to be done, or what."""
_NO_COMMAND = frozenset({"not", "earlier", "question", "hypothetical", "report"})
TALKING = frozenset(
    {"social", "praise", "complaint", "verdict", "mine", "did", "does", "sees", "earlier", "kin", "thing"}
)
"""Labels of words that an order to do something else would hardly begin with."""


Names = Collection[Key]
Unit = tuple[str, int]
"""What is written, and where it stands in the text."""
_NO_NAMES: Names = ()


class Sign(NamedTuple):
    """One word or phrase. `label` is its class, or the kind of motion word it is, or the word itself.

    `start` is where it stands in the text; `is_name`: it is a name of this dialogue.
    """

    label: str
    text: str
    moves: bool
    start: int
    is_name: bool = False

    @property
    def known_label(self) -> str:
        """Its class; `?` of a word that stands for itself."""
        return self.label if self.label != self.text else "?"


@dataclass(frozen=True)
class Clause:
    """What stands between two marks. `end` is the mark after it; `start` and `stop` are where it stands in the text."""

    signs: tuple[Sign, ...]
    end: str
    start: int
    stop: int

    @property
    def binds(self) -> bool:
        """Whether it bears on what stands beside it: a condition, a negation, a correction, the next motion."""
        said = any(sign.label in BINDING or sign.label in _QUOTES for sign in self.signs)
        return said or self.end == "?" or self._orders_next or self._names_deed

    @property
    def order_start(self) -> int:
        """Where what is to be done begins, after the words that ask for it; `start` where none do."""
        opened = list(itertools.takewhile(lambda sign: sign.label in _OPENING and not sign.moves, self.signs))
        rest = self.signs[len(opened) :]
        is_request = any(sign.label == "request" for sign in opened)
        return rest[0].start if is_request and rest and rest[0].moves else self.start

    @property
    def denies(self) -> bool:
        """`don't do it yet`: whether it begins with a negation, which may bear on what stands beside it."""
        return next((sign.label for sign in self.signs if sign.label not in _OPENING), "") == "not"

    @property
    def calls(self) -> bool:
        """`Henry!`: whether it only calls somebody, so that what comes after it is said to them."""
        return self.end == "!" and all(sign.label == "person" for sign in self.signs)

    @property
    def asks(self) -> bool:
        """`don't you …`, `did you …`: whether it begins as a question does."""
        return self.signs[0].label == "ask"

    @property
    def talks(self) -> bool:
        """Whether it has evidence of talk and no amount or shape that could be meant for what stands beside it."""
        return not self.tells and any(sign.label in TALKING and not sign.moves for sign in self.signs)

    @property
    def tells(self) -> bool:
        """Whether it has an amount or a shape."""
        return any(sign.moves and sign.label.isupper() and sign.label not in _IDLE for sign in self.signs)

    @property
    def measures(self) -> bool:
        """Whether it has a shape, or a number with its unit."""
        return any(sign.label in _MEASURES for sign in self.signs)

    def is_covered_by(self, other: Clause) -> bool:
        """Whether `other` says which way, or at least what to do, if this clause does."""
        mine, told = ({sign.label for sign in clause.signs if sign.moves} for clause in (self, other))
        needed = _WAYS if mine & _WAYS else _WAYS | {"VERB", "SHAPE"} if "VERB" in mine else None
        return needed is None or bool(told & needed)

    @property
    def depends(self) -> bool:
        """Whether it may decide on what stands beside it: a condition, a question, a correction, a lone no."""
        bears = any(sign.label in DEPENDING for sign in self.signs) or self.signs[-1].label == "not"
        return bears or self.end == "?"

    @property
    def tells_of_before(self) -> bool:
        """`you went to the sofa`: whether it tells what was done."""
        return any(sign.label in _PAST for sign in self.signs)

    @property
    def tells_of_command(self) -> bool:
        """`yesterday I published linear.x 0.3`: whether a raw velocity in it is denied, asked about or told of."""
        return self.end == "?" or any(sign.label in _NO_COMMAND for sign in self.signs)

    @property
    def goes_on(self) -> bool:
        """`then to the kitchen`: whether it has no verb of its own, so that the one before holds for it."""
        is_joined = self._opens_as[0][0] == "conn"
        return is_joined and not any(sign.label == "VERB" and not sign.is_name for sign in self.signs[1:])

    @property
    def begins_next(self) -> bool:
        """`then …`: whether it begins as another motion does."""
        return ("conn", "then") in self._opens_as

    @property
    def _orders_next(self) -> bool:
        """`then spin round …`: whether it begins with another motion, whatever is told behind it."""
        return self.begins_next and any(sign.label == "VERB" and sign.moves for sign in self.signs[1:2])

    @property
    def _names_deed(self) -> bool:
        """`then open the door`, `then say hello`: whether it begins with what is to be done next, and is no motion."""
        rest = [sign for sign in self.signs if sign.label not in _OPENING]
        return self.begins_next and bool(rest) and rest[0].label in (rest[0].text, "report")

    @property
    def _opens_as(self) -> Meaning:
        return lexicon().words.get(tuple(self.signs[0].text.split("_")), (("", ""),))

    @property
    def moves(self) -> bool:
        """Whether any word of it is one of motion."""
        return any(sign.moves for sign in self.signs)


def clauses_of(text: str, names: Names = _NO_NAMES) -> list[Clause]:
    """The clauses of a normalised text, in order; none is empty. `names` are words of this dialogue that move."""
    found: list[Clause] = []
    units: list[Unit] = []
    start = 0
    for match in UNIT.finditer(text):
        unit = match.group()
        if units and _is_apart(text, units[-1], match.start()):
            found += _parted(list(_signs(units, names)), ",", start, match.start())
            units = []
        if unit in _STRONG or unit in _WEAK:
            if units:
                found += _parted(list(_signs(units, names)), unit, start, match.end())
                units = []
            elif found and unit in _STRONG:
                last = found[-1]
                found[-1] = Clause(last.signs, unit if unit != "\n" else last.end, last.start, match.end())
            start = match.end()
        else:
            if not units:
                start = match.start()
            units.append((unit, match.start()))
    if units:
        found += _parted(list(_signs(units, names)), "", start, len(text))
    found = [*(replace(clause, end=",") if clause.calls else clause for clause in found[:-1]), *found[-1:]]
    spans = until_spans(text)
    return (
        [replace(clause, signs=tuple(_measured(clause.signs, spans))) for clause in found] if spans else found
    )


def _measured(signs: Sequence[Sign], spans: Sequence[tuple[int, int]]) -> Iterator[Sign]:
    """The signs; `until you are 50 cm from the wall` is an amount: what it names tells of nothing that is there."""
    for sign in signs:
        at = next((begin for begin, stop in spans if begin <= sign.start < stop), None)
        if at is None:
            yield sign
        elif at == sign.start:
            yield Sign("UNIT", sign.text, True, at)


def _is_apart(text: str, before: Unit, start: int) -> bool:
    """Whether a blank parts what is written without blanks: a few characters at least on either side."""
    written, at = before
    if at + len(written) == start or min(ord(written[-1]), ord(text[start])) < _FIRST_IDEOGRAPH:
        return False
    sides = text[max(at - _FEWEST + 1, 0) : at + 1], text[start : start + _FEWEST]
    return all(len(side) == _FEWEST and not any(map(str.isspace, side)) for side in sides)


def _parted(signs: list[Sign], end: str, start: int, stop: int) -> Iterator[Clause]:
    """What stands between two marks, parted before words such as `because`."""
    moves = [i for i, sign in enumerate(signs) if sign.moves]
    begins = [0]
    for i, sign in enumerate(signs):
        if i and (sign.label in _JOINTS or (sign.label == _HENCE and moves and moves[-1] > i)):
            begins.append(i)
    for begin, after in zip(begins, [*begins[1:], len(signs)]):
        is_last = after == len(signs)
        until = stop if is_last else signs[after].start
        yield Clause(tuple(signs[begin:after]), end if is_last else ",", start, until)
        start = until


def is_strong(mark: str) -> bool:
    """Whether a mark ends a sentence."""
    return mark == "" or mark in _STRONG


def _signs(units: list[Unit], names: Names) -> Iterator[Sign]:
    table, longest = _table()
    words = [written for written, _ in units]
    named = dict(_named(words, names))
    at, label = 0, ""
    while at < len(units):
        (unit, start), before = units[at], label
        label, moves, end = unit, False, at + 1
        for length in range(max(longest.get(unit, 0), named.get(at, at) - at), 0, -1):
            found = table.get(tuple(words[at : at + length])) if at + length <= len(units) else None
            inside = [stop for begin, stop in named.items() if at < begin < at + length]
            if at + length == named.get(at):
                label, moves, end = "VERB", True, at + length
                break
            if found is not None and all(stop <= at + length for stop in inside):
                # `go to the kitchen, then to the sofa`; but not 往前 of 往前台开, where 前台 is a place
                moves, end = found[1] or (bool(inside) and before in _BEFORE_GOAL), at + length
                label = found[0]
                break
        else:
            if unit[0].isdecimal() or (unit[0] == "." and len(unit) > 1):
                label, moves = "NUMBER", True
        asked = _request_end(words, at, table, longest.get(unit, 0))
        if asked > end:
            label, moves, end = "request", False, asked
        yield Sign(label, "_".join(words[at:end]), moves, start, is_name=end == named.get(at))
        at = end


def _request_end(words: Sequence[str], at: int, table: PhraseTable[tuple[str, bool]], longest: int) -> int:
    """Where a request ends that begins `at` a word and has adverbs within: `I would very much like you to`; else 0."""
    adverbs = relation_words("adverbs")
    if adverbs.isdisjoint(words[at + 1 : at + longest]):
        return 0
    core = [at, *(i for i in range(at + 1, min(at + 2 * longest, len(words))) if words[i] not in adverbs)]
    for count in range(min(longest, len(core)), 1, -1):
        found = table.get(tuple(words[i] for i in core[:count]))
        if found is not None and found[0] == "request":
            return core[count - 1] + 1
    return 0


def _named(words: Sequence[str], names: Names) -> Iterator[tuple[int, int]]:
    """Where each name begins and ends; of those that begin at the same word the longest. Hyphens are spaces."""
    longest = max(map(len, names), default=0)
    beginnings = {name[0] for name in names if name}
    for at, word in enumerate(words):
        if word not in beginnings:
            continue
        for end in range(min(at + 2 * longest - 1, len(words)), at, -1):
            key = tuple(word for word in words[at:end] if word != "-")
            if key in names and words[end - 1] != "-":
                yield at, end
                break


@lru_cache(maxsize=1)
def _table() -> tuple[PhraseTable[tuple[str, bool]], dict[str, int]]:
    table, longest = compiled("signs", _labels)
    return PhraseTable(table), longest


def _labels() -> tuple[Kept, dict[str, int]]:
    """(label and whether it is a word of motion, by written form; the longest form, by its first unit)."""
    words = lexicon()
    table: dict[Key, tuple[str, bool]] = {}
    for key, meaning in words.words.items():
        kind = meaning[0][0]
        if kind not in _NO_CONTENT:
            table[key] = (kind.upper() if not kind.startswith(_UNITS) else "UNIT", True)
        elif kind in _EVIDENCE_KINDS:
            table[key] = (_EVIDENCE_KINDS[kind], False)
    listed: dict[Key, tuple[str, bool]] = {}
    for language in LANGUAGES:
        for label, phrases in load_table(language, "acts").items():
            for phrase in phrases:
                for written in expand(phrase):
                    key = tuple(UNIT.findall(written))
                    was = table.get(key, ("", False))
                    if was[0] not in _EVIDENCE_KINDS.values():
                        listed.setdefault(key, (label, was[1]))
    table |= listed
    longest: dict[str, int] = {}
    for key in table:
        longest[key[0]] = max(longest.get(key[0], 0), len(key))
    return by_first(table), longest
