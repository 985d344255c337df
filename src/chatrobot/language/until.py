"""`Drive until something is 30 cm in front of you`: a drive that ends at an obstacle, at a distance that is said."""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

from chatrobot.language.data_files import load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.language.quantities import read_quantities
from chatrobot.language.tokens import tokenise


class UntilObstacle(NamedTuple):
    """What stands before the condition, how near the obstacle may be, in metres, and what stands after."""

    before: str
    distance_m: float
    after: str


@cache
def _patterns(language: str) -> tuple[re.Pattern[str], ...]:
    table = load_table(language, "until")
    thing = table.get("thing", "")
    return tuple(re.compile(p.replace("THING", thing)) for p in table.get("patterns", ()))


def read_until(text: str, language: str) -> UntilObstacle | None:
    """The drive and its condition; None where there is none, or where no distance is said."""
    for pattern in _patterns(language):
        found = pattern.search(text)
        if found is None:
            continue
        amounts = read_quantities(tokenise(found["distance"], lexicon(), {}))
        lengths = [a for a in amounts if a.kind == "q" and a.value == "length"]
        other = [a for a in amounts if a.kind not in ("q", "glue", "filler", "num")]
        if len(lengths) == 1 and not other and 0 < lengths[0].number <= 10:
            return UntilObstacle(text[: found.start()].strip(" ,"), lengths[0].number, text[found.end() :])
    return None
