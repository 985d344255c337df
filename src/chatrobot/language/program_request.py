"""The tutorial's two requests for a program: the motion they ask for, exactly as told, or an honest word."""

from __future__ import annotations

import re
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import RawTwist, Repeat, Step


@lru_cache(maxsize=1)
def _patterns() -> tuple[dict[str, re.Pattern[str]], ...]:
    tables = [load_table(language, "programs") for language in LANGUAGES]
    return tuple({name: re.compile(pattern, re.S) for name, pattern in t["patterns"].items()} for t in tables)


def read_program_request(text: str) -> list[Step] | None:
    """The steps that a request for a program describes; None where `text` asks for no program.

    Raises:
        Unclear: for a program whose motion is not told in full: writing programs takes a model.
    """
    text = " ".join(text.split())
    for patterns in _patterns():
        if patterns["request"].search(text):
            return _motion(text, patterns)
    return None


def _motion(text: str, patterns: dict[str, re.Pattern[str]]) -> list[Step]:
    square = patterns["square"].search(text)
    if square:
        found = [patterns[name].search(text) for name in ("linear", "drive_time", "angular", "turn_time")]
        if all(found):
            speed, drive_s, rate, turn_s = (float(m[1]) for m in found if m)
            return [Repeat(4, (RawTwist(speed, 0.0, 0.0, drive_s), RawTwist(0.0, 0.0, rate, turn_s)))]
    rotation = patterns["rotation"].search(text)
    if rotation and not square:
        return [RawTwist(0.0, 0.0, float(rotation[1]), float(rotation[2]))]
    raise Unclear("program")
