"""Sentences that tell or ask about motion in the words of a command: 他走了两米, 如何前进一米."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table
from chatrobot.language.unclear import Unclear

_SHOWN = 60


@cache
def _patterns(language: str, name: str) -> tuple[re.Pattern[str], ...]:
    return tuple(re.compile(pattern) for pattern in load_table(language, "told").get(name, ()))


def tells(text: str, language: str) -> bool:
    """Whether a normalised text tells what was done, or asks about it, and asks for nothing to be done."""
    return any(pattern.search(text) for pattern in _patterns(language, "told"))


def check_not_told(text: str, language: str) -> None:
    """Ask back where a normalised text tells what was done, asks about it, or says two things at once.

    Raises:
        Unclear: for such a text.
    """
    if tells(text, language):
        raise Unclear("nothing_to_do")
    if any(pattern.search(text) for pattern in _patterns(language, "contradicts")):
        raise Unclear("contradiction", text[:_SHOWN])
