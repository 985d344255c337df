"""“Continue”: said of a plan that was paused, or stopped."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.normalise import normalise

_PUNCTUATION = re.compile(r"[\s,.!;:、。！，；…]+")


def wants_to_resume(text: str) -> bool:
    """Whether `text` says to go on, and nothing else."""
    plain = _PUNCTUATION.sub(" ", normalise(text[:200])).strip()
    return any(_pattern(language).fullmatch(plain) for language in LANGUAGES)


@cache
def _pattern(language: str) -> re.Pattern[str]:
    table = load_table(language, "resuming")
    words, beside = (
        "|".join(re.escape(word) for word in sorted(table[key], key=len, reverse=True))
        for key in ("words", "beside")
    )
    gap = r"\s?" if language == "zh" else r"(?:\s|$)"
    return re.compile(
        rf"(?:(?:{beside}){gap})*(?:{words})(?:{gap}|$)(?:(?:{beside}){gap})*(?:(?:{words}){gap})?"
    )
