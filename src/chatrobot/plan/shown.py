"""Plan text as it is shown to people. What runs, travels or is edited is the exact text, never this one."""

from __future__ import annotations

import re

from chatrobot.core.reason import ANGLE_PLACES, LENGTH_PLACES, number

TYPED_PLACES = {"deg": 2}
"""Decimals that a person may well have typed are shown; one more, and it has been computed."""
_QUOTED_OR_NUMBER = re.compile(
    r'"(?:[^"\\]|\\.)*"|(?<![\w.])(?P<number>-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?![\w.])(?P<unit> *[a-z/]+)?'
)


def shown_plan(plan_text: str) -> str:
    """The plan with numbers to the millimetre and the tenth of a degree; names and what is said stay as they are."""
    return _QUOTED_OR_NUMBER.sub(_shown, plan_text)


def _shown(found: re.Match[str]) -> str:
    text, unit = found["number"], found["unit"] or ""
    if text is None:
        return found[0]
    kind = unit.strip().partition("/")[0]
    places = ANGLE_PLACES if kind == "deg" else LENGTH_PLACES
    typed = TYPED_PLACES.get(kind, places)
    is_typed = "e" not in text and len(text.partition(".")[2]) <= typed
    return found[0] if is_typed else f"{number(float(text), places)}{unit}"
