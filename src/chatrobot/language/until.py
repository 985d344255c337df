"""`Drive until something is 30 cm in front of you`: a drive that ends at an obstacle."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rules import Form, forms_of
from chatrobot.language.tokens import tokenise

UNSAID_M = 0.5
"""How near an obstacle may be where nobody says it: asked about before it is driven."""


class UntilObstacle(NamedTuple):
    """What stands before the condition, how near the obstacle may be, in metres, and what stands after."""

    before: str
    distance_m: float
    after: str
    is_said: bool = True
    """False where only the obstacle is told, and not how near."""


@cache
def _patterns(language: str, kind: str = "patterns") -> tuple[Form, ...]:
    def sources() -> list[str]:
        table = load_table(language, "until")
        return [p.replace("THING", table.get("thing", "")) for p in table.get(kind, ())]

    return forms_of(f"until_{language}_{kind}", sources)


def read_until(text: str, language: str) -> UntilObstacle | None:
    """The drive and its condition; None where there is none."""
    for found in _found(text, language):
        amounts = read_quantities(tokenise(found["distance"], lexicon(), {}))
        lengths = [a for a in amounts if a.kind == "q" and a.value == "length"]
        other = [a for a in amounts if a.kind not in ("q", "glue", "filler", "num")]
        if len(lengths) == 1 and not other and 0 < lengths[0].number <= 10:
            return UntilObstacle(text[: found.start()].strip(" ,"), lengths[0].number, text[found.end() :])
    for found in _found(text, language, "unsaid"):
        return UntilObstacle(text[: found.start()].strip(" ,"), UNSAID_M, text[found.end() :], is_said=False)
    return None


def until_spans(text: str) -> list[tuple[int, int]]:
    """Where such conditions begin and end, in any language: how far to drive, as a distance would tell it."""
    kinds = itertools.product(LANGUAGES, ("patterns", "unsaid"))
    return [found.span() for language, kind in kinds for found in _found(text, language, kind)]


def _found(text: str, language: str, kind: str = "patterns") -> Iterator[re.Match[str]]:
    return (found for pattern in _patterns(language, kind) if (found := pattern.search(text)))
