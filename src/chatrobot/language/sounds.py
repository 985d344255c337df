"""What a speech recogniser writes for what was said: tried only where a sentence as it stands has no meaning."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table


@cache
def _rules(language: str) -> tuple[tuple[re.Pattern[str], dict[str, str]], ...]:
    """For each place in a sentence: where it is, and what each character there was meant to be."""
    listed = load_table(language, "homophones").get("places", {})
    rules = []
    for place in listed.values():
        meant = {heard: said for said, others in place["sounds"].items() for heard in others}
        characters = "".join(re.escape(c) for c in meant)
        rules.append((re.compile(f"{place['before']}([{characters}]){place['after']}"), meant))
    return tuple(rules)


def mended(text: str, language: str) -> str:
    """The text with sound-alikes replaced where the grammar expects a number, a unit or a side."""
    for pattern, meant in _rules(language):
        text = pattern.sub(lambda found, table=meant: table[found.group(1)], text)  # type: ignore[misc]
    return text
