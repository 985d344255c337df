"""“Continue”: said of a plan that was paused, or stopped."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.normalise import normalise

_PUNCTUATION = re.compile(r"[\s,.!?;:、。！？，；…]+")


def wants_to_resume(text: str, *, may_mean_more: bool = True) -> bool:
    """Whether `text` says to go on, and nothing else.

    Args:
        may_mean_more: count words that ask for more of the motion before where nothing was paused or stopped.
    """
    plain = _PUNCTUATION.sub(" ", normalise(text[:200])).strip()
    return any(_pattern(language, may_mean_more).fullmatch(plain) for language in LANGUAGES)


@cache
def _pattern(language: str, may_mean_more: bool) -> re.Pattern[str]:
    table = load_table(language, "resuming")
    resuming = [*table["words"], *(table["more"] if may_mean_more else ())]
    words, beside = (
        "|".join(re.escape(word) for word in sorted(group, key=len, reverse=True))
        for group in (resuming, table["beside"])
    )
    gap = r"\s?" if language == "zh" else r"(?:\s|$)"
    return re.compile(
        rf"(?:(?:{beside}){gap})*(?:{words})(?:{gap}|$)(?:(?:{beside}){gap})*(?:(?:{words}){gap})?"
    )
