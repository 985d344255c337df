"""“Continue”: said of a plan that was paused, or stopped; and what goes on with a stopped one beside other words."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

from chatrobot.language.context import Context
from chatrobot.language.data_files import REPLY_LANGUAGES, in_full, load_table
from chatrobot.language.interpretation import Interpretation, LanguageCode, asked_back
from chatrobot.language.normalise import normalise
from chatrobot.language.proposals import proposed
from chatrobot.language.unclear import Unclear

_PUNCTUATION = re.compile(r"[\s,.!?;:、。！？，；…]+")

_REST = "restqx"
"""The word for what is left of a stopped plan, in the text that asks for it alone."""
_SHOWN = 60

Reader = Callable[[str, LanguageCode, Context], Interpretation]


def wants_to_resume(text: str, *, may_mean_more: bool = True) -> bool:
    """Whether `text` says to go on, and nothing else.

    Args:
        may_mean_more: count words that ask for more of the motion before where nothing was paused or stopped.
    """
    return any(_says_to_resume(language, may_mean_more)(text) for language in REPLY_LANGUAGES)


def only_starts(text: str) -> bool:
    """Whether `text` says to begin a motion, and not which: `go!`."""
    return any(_says_to_start(language)(text) for language in REPLY_LANGUAGES)


@cache
def _says_to_start(language: str) -> Callable[[str], bool]:
    table = load_table(language, "resuming")
    return saying(table["start"], table["beside"], language)


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


def of_rest(text: str, language: LanguageCode, context: Context, read: Reader) -> Interpretation | None:
    """What asks for the rest of the plan that was stopped last, beside other words: `continue, but slowly`; else None.

    As after a stop, nothing is driven before a yes. What else speaks of the rest is asked about.
    """
    last = context.dialogue.last_motion
    if last is None or last.outcome != "stopped" or last.remaining is None:
        return None
    goes_on, speaks_of_it = _patterns(language)
    said = goes_on.sub(f" {_REST} ", text)
    if said == text:
        asks = text.rstrip().endswith(("?", "？"))
        return None if asks or not speaks_of_it.search(text) else _unclear(text, language)
    words = {**context.dialogue.words, _REST: last.remaining}
    meant = read(said, language, replace(context, dialogue=replace(context.dialogue, words=words)))
    if meant.plan is None or meant.define:
        return _unclear(text, language)
    return proposed(meant, language) or meant


def goes_on_beside(text: str) -> bool:
    """Whether a text says to go on, and something beside it: `continue, but slowly`."""
    return any(_patterns(code)[0].search(text) is not None for code in REPLY_LANGUAGES)


def _unclear(text: str, language: LanguageCode) -> Interpretation:
    return asked_back(Unclear("unclear_motion", text[:_SHOWN]), language)


@cache
def _patterns(language: str) -> tuple[re.Pattern[str], re.Pattern[str]]:
    table = load_table(language, "resuming")
    said = sorted((*table["words"], *table["more"]), key=len, reverse=True)
    words = "|".join(re.escape(word).replace(r"\ ", ",? ") for word in said)
    parts = {"words": words, "beside": "|".join(map(re.escape, table["beside"]))}
    goes_on = in_full(table["rest"], parts)
    return re.compile(goes_on, re.IGNORECASE), re.compile(table["speaks_of_rest"], re.IGNORECASE)
