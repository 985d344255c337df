"""Sentences that break off: `drive forward a distance of`. What was to come is not guessed."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table


@cache
def _pattern(language: str, name: str) -> re.Pattern[str]:
    return re.compile(str(load_table(language, "unfinished").get(name, "$^")))


def breaks_off(text: str, language: str) -> str:
    """The words with which a normalised text breaks off, or an empty string."""
    found = _pattern(language, "end").search(text)
    if found is None or _pattern(language, "complete").search(text):
        return ""
    return found.group().strip(" .…,!-")
