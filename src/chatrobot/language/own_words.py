"""A question quotes what the person said: rules put other words in its place, or leave nothing to quote."""

from __future__ import annotations

import re
from dataclasses import replace

from chatrobot.language.data_files import LANGUAGES
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.lexicon import UNIT
from chatrobot.language.normalise import normalise

_QUOTING = frozenset(
    {
        "unknown_part",
        "where_to",
        "unclear_motion",
        "did_you_mean",
        "how_long_a_step",
        "contradiction",
        "condition",
        "no_unit",
        "how_far",
    }
)
"""Codes whose replies quote what was not understood."""
_OPENING, _CLOSING = '“„"', '”“"'
_MARKS = " ,.;:!?，。；：！？…\n"
_BREAK = re.compile(r"[;!?，。；：！？…\n]|(?<!\d)[,.:]|[,.:](?!\d)")
"""A mark between parts of a text, and none in a number: 0,25 m/s."""
_BLANK = r"(?<=[\u2e80-\uffef]) (?=[\u2e80-\uffef])"
"""A blank between two Chinese characters."""
_SHOWN = 60
_SCATTERED = 2
"""Words that stand farther apart than so many times their number are no one part of a text."""


def in_own_words(meant: Interpretation, text: str) -> Interpretation:
    """A question with what it quotes as it stands in `text`."""
    part = meant.unaccounted
    if meant.outcome != "unclear" or meant.code not in _QUOTING or (not part and meant.proposal is not None):
        return meant
    source = normalise(text) if meant.language in LANGUAGES else " ".join(text.split())
    own = _as_written(_part_of(source, part, is_reordered=meant.language not in LANGUAGES), text)
    if own == part:
        return meant
    quoted = rf"(?<=[{_OPENING}]){re.escape(part)}(?=[{_CLOSING}])"
    return replace(meant, reply=re.sub(quoted, lambda _: own, meant.reply, count=1), unaccounted=own)


def _part_of(text: str, part: str, *, is_reordered: bool) -> str:
    """The part of `text` that `part` stands for: the same, its words in their own order, or the whole."""
    said, whole = part.strip(_MARKS), _squeezed(text.rstrip(_MARKS))
    if part.endswith("…") and not whole.endswith(_squeezed(said)):
        return _beginning(text)  # it breaks off in other words only
    if said and _squeezed(said) in whole:
        return part if is_reordered else re.sub(_BLANK, "", part)
    units = list(UNIT.finditer(text.casefold()))
    wanted = {unit for unit in UNIT.findall(said.casefold()) if unit[0].isalpha()}
    held = {unit.group() for unit in units} & wanted
    if held == wanted and wanted and not is_reordered:
        return part
    window = _window([unit.group() for unit in units], held)
    if (
        2 * len(held) < len(wanted)
        or not held
        or window is None
        or len(window) > _SCATTERED * len(wanted) + 1
    ):
        return _beginning(text)
    start, stop = units[window[0]].start(), units[window[-1]].end()
    if held != wanted:  # up to the marks on either side
        start = max((mark.end() for mark in _BREAK.finditer(text, 0, start)), default=0)
        after = _BREAK.search(text, stop)
        stop = after.start() if after else len(text)
    return text[start:stop].strip(_MARKS)


def _as_written(part: str, text: str) -> str:
    """The part with the capital letters that it has in `text`."""
    found = (
        re.search(r"\s+".join(map(re.escape, part.split())), text, re.IGNORECASE) if part.strip() else None
    )
    return found[0] if found is not None else part


def _beginning(text: str) -> str:
    """As much of a text as is quoted, without half a word."""
    shown = text if len(text) <= _SHOWN else text[: _SHOWN + 1].rpartition(" ")[0] or text[:_SHOWN]
    return shown.strip(_MARKS)


def _window(units: list[str], wanted: set[str]) -> range | None:
    """The shortest run of units that has all that are wanted."""
    best: range | None = None
    for start, unit in enumerate(units):
        if unit not in wanted:
            continue
        left = set(wanted)
        for stop in range(start, len(units)):
            left.discard(units[stop])
            if not left:
                if best is None or stop + 1 - start < len(best):
                    best = range(start, stop + 1)
                break
    return best


def _squeezed(text: str) -> str:
    return "".join(text.casefold().split())
