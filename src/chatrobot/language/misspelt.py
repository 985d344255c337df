"""A place whose name was probably misspelt: `go to the kichen`. It is asked about, never driven to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from chatrobot.core.event import Proposal
from chatrobot.language.acts import orders
from chatrobot.language.command import read_command
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES
from chatrobot.language.gloss import MARK
from chatrobot.language.gloss_tables import folded
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.lexicon import cut
from chatrobot.language.names import names_in
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import by_language, say
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
    meant = _mended(rephrased(normalise(text), language), problem.part, language, reading.context)
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


def _mended(text: str, part: str, language: str, context: Context) -> _Mended | None:
    """What `text` (normalised) means if the words `part`, which nothing explains, misspell the name of a place.

    None where no place, or more than one, has a name that near. It is to be asked about, never acted on.
    """
    units, unknown = cut(text), set(part.split())
    found: dict[str, _Mended] = {}
    for spoken, name in _names(language, context):
        key, own = cut(normalise(spoken)), cut(normalise(name))
        for at in range(len(units) - len(key) + 1):
            written = units[at : at + len(key)]
            if unknown & set(written) and _is_near(" ".join(written).replace(MARK, ""), " ".join(key)):
                found[" ".join(own)] = _Mended(spoken, " ".join((*units[:at], *own, *units[at + len(key) :])))
    whole = max(found, key=len, default="")  # `dock` within `charging dock`
    return found[whole] if whole and all(name in whole for name in found) else None


def _names(language: str, context: Context) -> Iterator[tuple[str, str]]:
    """Every name of a place as it is spoken, and as the reader knows it: not that of a language which is glossed."""
    yield from ((name, name) for name in (*context.world_places, *context.dialogue.places))
    if language not in LANGUAGES:
        spoken = ((by_language(names, language)[0], names[0]) for names in context.place_names)
        yield from ((folded(name, language), known) for name, known in spoken)


def _is_near(written: str, name: str) -> bool:
    """One letter off, or two in a long name."""
    if not name.isascii() or len(name) < _SHORTEST_NAME:
        return False
    off = 2 if len(name) >= _LONG_NAME else 1
    return edit_distance(written, name, off) <= off
