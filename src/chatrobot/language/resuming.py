"""“Continue”: said of a plan that was paused, or stopped."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache

from chatrobot.language.data_files import REPLY_LANGUAGES, load_table
from chatrobot.language.normalise import normalise

_PUNCTUATION = re.compile(r"[\s,.!?;:、。！？，；…]+")


def wants_to_resume(text: str, *, may_mean_more: bool = True) -> bool:
    """Whether `text` says to go on, and nothing else.

    Args:
        may_mean_more: count words that ask for more of the motion before where nothing was paused or stopped.
    """
    return any(_says_to_resume(language, may_mean_more)(text) for language in REPLY_LANGUAGES)


@cache
def _says_to_resume(language: str, may_mean_more: bool) -> Callable[[str], bool]:
    table = load_table(language, "resuming")
    words = [*table["words"], *(table["more"] if may_mean_more else ())]
    return saying(words, table["beside"], language)


def saying(words: Sequence[str], beside: Sequence[str], language: str) -> Callable[[str], bool]:
    """Make a test whether a text says one of `words`, or two, and nothing else but what may stand beside them."""
    said, light = (
        "|".join(re.escape(word) for word in sorted(group, key=len, reverse=True))
        for group in (words, beside)
    )
    gap = r"\s?" if language == "zh" else r"(?:\s|$)"
    pattern = re.compile(
        rf"(?:(?:{light}){gap})*(?:{said})(?:{gap}|$)(?:(?:{light}){gap})*(?:(?:{said}){gap})?"
    )

    def says(text: str) -> bool:
        plain = _PUNCTUATION.sub(" ", normalise(text[:200])).strip()
        return pattern.fullmatch(plain) is not None

    return says
