"""Idioms of a language put plainly before its words are looked up: dialect, and patterns with a gap in them."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table


@cache
def _words(language: str) -> tuple[re.Pattern[str], dict[str, str]] | None:
    table: dict[str, str] = load_table(language, "idioms").get("words", {})
    if not table:
        return None
    longest_first = sorted(table, key=len, reverse=True)
    return re.compile("|".join(map(re.escape, longest_first))), table


@cache
def _patterns(language: str) -> tuple[tuple[re.Pattern[str], str], ...]:
    listed = load_table(language, "idioms").get("patterns", {}).get("list", [])
    return tuple((re.compile(pattern), replacement) for pattern, replacement in listed)


def put_plainly(text: str, language: str) -> str:
    """A normalised text with its idioms replaced by what they mean."""
    words = _words(language)
    if words is not None:
        known, table = words
        text = known.sub(lambda found: table[found.group()], text)
    for pattern, replacement in _patterns(language):
        text = pattern.sub(replacement, text)
    return text
