"""`Back up half of what you've done in total`, 退这两段加起来的一半: an order that is told by what was done before.

It is read as slots in any order (a factor, what was done, a way, an amount more or less), the words of which are
`data/<code>/of_before.toml`; what the slots come to is `done_before.py`. A word that no slot covers makes it none.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from chatrobot.language.acts import read_acts
from chatrobot.language.beside import LEAST_TOLD
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.data_files import in_full as with_parts
from chatrobot.language.done_before import ordered_by
from chatrobot.language.gloss import gloss
from chatrobot.language.gloss_tables import folded
from chatrobot.language.interpretation import Interpretation, LanguageCode, asked_back, planned
from chatrobot.language.last_motion import atoms_said
from chatrobot.language.normalise import normalise
from chatrobot.language.rephrase import in_full
from chatrobot.language.rules import Form, forms_of
from chatrobot.language.signs import BINDING
from chatrobot.language.slots_said import HEADINGS, PLACES, Said
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_MARK = re.compile(r"[;!。；…\n]|[,.:](?!\d)")
_MARKS = " ,.;:!。；…\n"
_NOT_BESIDE = BINDING | {
    *("report", "earlier", "later", "VERB", "DIR", "ROT", "SHAPE", "FULLTURN", "PLACE"),
    *("NUMBER", "FRACTION", "SCALE", "TIMES", "MULTIPLE", "PACE", "FASTER"),
}
"""Labels of words that no clause beside such an order has: it denies, asks and bounds nothing, and tells no motion."""
_COSTS = {"idle": 1.2, "amount": 1.1, "told": 0.9}
"""A word of any other slot costs one: 一半 is half, and no one and a half; 退了一半 tells of what was done."""


@dataclass(frozen=True)
class _Word:
    """What one slot covers of a text."""

    slot: str
    amount: str
    end: int


def told_by_before(text: str, language: LanguageCode, context: Context) -> Interpretation | None:
    """What a text orders by what was done before; None for any other text."""
    dialogue = context.dialogue
    if (
        dialogue.last_motion is None
        or dialogue.pending
        or dialogue.offered
        or dialogue.held
        or "?" in text
        or "？" in text
    ):
        return None
    plain = in_full(normalise(text), language) if language in LANGUAGES else folded(normalise(text), language)
    found = _covered(plain, language)
    if found is None:
        return None
    start, end, words = found
    said = _said(words, language)
    if (
        said is None
        or said.has("told")
        or not all(_is_beside(part, language) for part in (plain[:start], plain[end:]))
    ):
        return None
    try:
        steps = ordered_by(said, context)
    except Unclear as problem:
        return asked_back(problem, language, dialogue.last_text)
    corrects = said.has("oops", *HEADINGS, *PLACES)  # it is reckoned from where the turn before ended
    return replace(planned(steps, language), corrects=corrects) if steps else None


def _is_beside(part: str, language: LanguageCode) -> bool:
    """Whether what stands beside the order is surely none, and does not bear on it."""
    part = part.strip(_MARKS)
    reads = read_acts(part if language in LANGUAGES else gloss(part, language).text) if part else []
    return not any(
        sign.label in _NOT_BESIDE or (sign.label == "FLAG" and len(read.clause.signs) < LEAST_TOLD)
        for read in reads
        for sign in read.clause.signs
    )


def _said(words: Sequence[_Word], language: LanguageCode) -> Said | None:
    """The slots that are said; None where an amount in one is none that anybody reads."""
    said = Said()
    factors = load_table(language, "of_before")["factors"]
    for word in words:
        if word.slot in factors:
            said.factors.append(float(factors[word.slot]))
            continue
        said.slots.add(word.slot)
        if word.amount:
            amount = _amount(word.amount, language)
            if amount is None:
                return None
            said.amounts.setdefault(word.slot, []).append(amount)
    return said


def _amount(text: str, language: LanguageCode) -> Atom | None:
    known = text if language in LANGUAGES else gloss(text, language).text
    found = [atom for atom in atoms_said(known) if atom.kind == "q"]
    return found[0] if len(found) == 1 else None


def _covered(plain: str, language: LanguageCode) -> tuple[int, int, list[_Word]] | None:
    """The longest part between marks that slots cover wholly, and what they are; None where there is none."""
    cuts = [found.start() for found in _MARK.finditer(plain)]
    starts, ends = [0, *(cut + 1 for cut in cuts)], {*cuts, len(plain)}
    at = {i: [*_words_at(plain, i, language)] for i in range(len(plain)) if _begins(plain, i, language)}
    best: tuple[int, int, list[_Word]] | None = None
    for start in starts:
        for end, words in _reached(plain, start, at):
            if end in ends and words and (best is None or end - start > best[1] - best[0]):
                best = start, end, words
    return best


def _reached(plain: str, start: int, at: dict[int, list[_Word]]) -> Iterator[tuple[int, list[_Word]]]:
    """Each place that slots reach from `start` without a gap, with the cheapest cover up to it."""
    costs: dict[int, tuple[float, list[_Word]]] = {start: (0.0, [])}
    for i in range(start, len(plain) + 1):
        if i not in costs:
            continue
        cost, words = costs[i]
        yield i, words
        if i < len(plain) and plain[i] in _MARKS:
            _keep(costs, i + 1, cost, words)
        for word in at.get(i, ()):
            _keep(costs, word.end, cost + _COSTS.get(word.slot, 1.0), [*words, word])


def _keep(costs: dict[int, tuple[float, list[_Word]]], at: int, cost: float, words: list[_Word]) -> None:
    if at not in costs or cost < costs[at][0]:
        costs[at] = cost, words


def _begins(plain: str, i: int, language: str) -> bool:
    """Whether a word may begin there: anywhere in a language that does not part them."""
    return plain[i] not in _MARKS and (not _parts_words(language) or i == 0 or not plain[i - 1].isalnum())


def _words_at(plain: str, i: int, language: str) -> Iterator[_Word]:
    for slot, form in _slots(language):
        found = form.match(plain, i)
        if found is None or found.end() == i:
            continue
        yield _Word(slot, _group(found), found.end())


def _group(found: re.Match[str]) -> str:
    said = found.groupdict()
    return said.get("amount") or said.get("times") or ""


def _parts_words(language: str) -> bool:
    return bool(load_table(language, "of_before")["parts_words"])


@cache
def _slots(language: str) -> tuple[tuple[str, Form], ...]:
    """Each pattern with its slot; that of a factor is the pattern as it stands in the file."""
    table = load_table(language, "of_before")
    listed = [(slot, one) for slot, patterns in table["slots"].items() for one in patterns]
    listed += [(pattern, pattern) for pattern in table["factors"]]
    ends = r"(?!\w)" if _parts_words(language) else ""
    forms = forms_of(
        f"of_before_{language}", lambda: [f"(?:{with_parts(one, table['parts'])}){ends}" for _, one in listed]
    )
    return tuple((slot, form) for (slot, _), form in zip(listed, forms))
