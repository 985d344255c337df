"""A place whose name was probably misspelt: `go to the kichen`. It is asked about, never driven to."""

from __future__ import annotations

from typing import NamedTuple

from chatrobot.core.event import Proposal
from chatrobot.language.acts import orders
from chatrobot.language.command import read_command
from chatrobot.language.context import Context
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.lexicon import cut
from chatrobot.language.names import names_in
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import say
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import rephrased
from chatrobot.language.typos import edit_distance
from chatrobot.language.unclear import Unclear
from chatrobot.plan.text import format_plan

_SHORTEST_NAME, _LONG_NAME = 4, 8


def misspelt_place(problem: Unclear, text: str, reading: Reading) -> Interpretation | None:
    """The question whether a place was misspelt, if it looks so and the rest is understood; it offers the plan."""
    language = reading.language
    if problem.code != "unknown_part" or not orders(normalise(text), names_in(reading.context)):
        return None
    meant = _mended(rephrased(normalise(text), language), problem.part, reading.context)
    try:
        plan = read_command(meant.text, reading).plan if meant is not None else None
    except Unclear:
        return None
    if meant is None or plan is None:
        return None
    ask = say(language, "did_you_mean_place", place=meant.place)
    return Interpretation(
        "unclear",
        f"{say(language, 'unknown_place', part=problem.part)} {ask}",
        language,
        unaccounted=problem.part,
        code="did_you_mean_place",
        proposal=Proposal(format_plan(plan), ask),
    )


class _Mended(NamedTuple):
    """The place that was probably meant, and the text with its name."""

    place: str
    text: str


def _mended(text: str, part: str, context: Context) -> _Mended | None:
    """What `text` (normalised) means if the words `part`, which nothing explains, misspell the name of a place.

    None where no name, or more than one, is that near. It is to be asked about, never acted on.
    """
    units, unknown = cut(text), set(part.split())
    found: dict[str, _Mended] = {}
    for name in (*context.world_places, *context.dialogue.places):
        key = cut(normalise(name))
        for at in range(len(units) - len(key) + 1):
            written = units[at : at + len(key)]
            if unknown & set(written) and _is_near(" ".join(written), " ".join(key)):
                mended = " ".join((*units[:at], *key, *units[at + len(key) :]))
                found[name] = _Mended(name, mended)
    return next(iter(found.values())) if len(found) == 1 else None


def _is_near(written: str, name: str) -> bool:
    """One letter off, or two in a long name."""
    if not name.isascii() or len(name) < _SHORTEST_NAME:
        return False
    off = 2 if len(name) >= _LONG_NAME else 1
    return edit_distance(written, name, off) <= off
