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


def with_rest(text: str, language: LanguageCode, context: Context) -> tuple[str, Context]:
    """A text in which what is left of the plan that was stopped last is a taught word: `continue, but slowly`.

    Raises:
        Unclear: it speaks of the rest in words that are not known: `only half of the rest`.
    """
    last = context.dialogue.last_motion
    if last is None or last.outcome != "stopped" or last.remaining is None:
        return text, context
    goes_on, speaks_of_it = _of_rest(language)
    said = goes_on.sub(f" {_REST} ", text)
    if said == text:
        if speaks_of_it.search(text) and not text.rstrip().endswith(("?", "？")):
            raise Unclear("unclear_motion", text[:_SHOWN])
        return text, context
    words = {**context.dialogue.words, _REST: last.remaining}
    return said, replace(context, dialogue=replace(context.dialogue, words=words))


def asked_for_rest(meant: Interpretation, said: str, language: LanguageCode) -> Interpretation:
    """What a text with the rest of a stopped plan means: as after a stop, nothing is driven before a yes."""
    if meant.plan is None or meant.define:
        return asked_back(Unclear("unclear_motion", said[:_SHOWN]), language)
    return proposed(meant, language) or meant


@cache
def _of_rest(language: str) -> tuple[re.Pattern[str], re.Pattern[str]]:
    table = load_table(language, "resuming")
    said = sorted((*table["words"], *table["more"]), key=len, reverse=True)
    words = "|".join(re.escape(word).replace(r"\ ", ",? ") for word in said)
    parts = {"words": words, "beside": "|".join(map(re.escape, table["beside"]))}
    goes_on = in_full(table["rest"], parts)
    return re.compile(goes_on, re.IGNORECASE), re.compile(table["speaks_of_rest"], re.IGNORECASE)
