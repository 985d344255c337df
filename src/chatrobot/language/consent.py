"""A yes or a no, said to a question that was asked."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from chatrobot.language.data_files import REPLY_LANGUAGES, load_table
from chatrobot.language.phrases import say

if TYPE_CHECKING:
    from chatrobot.language.context import Context
    from chatrobot.language.interpretation import Interpretation

_MARK = r"[\s,.!，。！、]"
_GAP = f"{_MARK}*"
_APOSTROPHE = str.maketrans("’", "'")


def read_consent(text: str) -> bool | None:
    """True for a yes, False for a no, None for anything else; each has to be the whole utterance."""
    if _consists_of("yes", text):
        return True
    return False if _consists_of("no", text) else None


def wants_to_edit(text: str) -> bool:
    """Neither: it is to be changed first."""
    return _consists_of("edit", text)


def unasked(meant: Interpretation, text: str, context: Context) -> Interpretation:
    """What `text` means; that there is nothing to answer, where it only answers what nobody asked.

    A no that comes next after a motion may be about that.
    """
    agrees, dialogue = read_consent(text), context.dialogue
    is_asked = bool(dialogue.pending) and read_consent(dialogue.pending) is None
    may_correct = agrees is False and bool(dialogue.turns) and dialogue.turns[-1].moved
    if agrees is None or meant.outcome != "unclear" or meant.proposal is not None or is_asked or may_correct:
        return meant
    reply = say(meant.language, "nothing_to_answer")
    return replace(meant, reply=reply, unaccounted="", code="nothing_to_answer")


def after_consent(text: str) -> str | None:
    """What is said after a yes, `but slowly` of `sure, but slowly`; None where there is no yes, or a question."""
    said = text.strip().casefold().translate(_APOSTROPHE)
    found = _leading_yes().fullmatch(said)
    return found["rest"] if found and not said.endswith(("?", "？", "吗")) else None


def opens_with_but(said: str) -> bool:
    """Whether what is said after a yes changes what is agreed to: `but turn right`."""
    return re.match(f"{_GAP}{_any_of('but')}", said.strip().casefold()) is not None


def _consists_of(answer: str, text: str) -> bool:
    return _pattern(answer).fullmatch(text.strip().casefold().translate(_APOSTROPHE)) is not None


@cache
def _pattern(answer: str) -> re.Pattern[str]:
    """One of that answer's phrases or more, with courtesy and punctuation around them."""
    return re.compile(f"{_GAP}{_beside()}(?:{_any_of(answer)}{_GAP}{_beside()})+")


@cache
def _leading_yes() -> re.Pattern[str]:
    """Chinese is written without spaces: only a comma or a `but` tells 好，慢一点 from 好慢.

    `Yes, then turn left`: what comes after a comma so goes on from what is agreed to.
    """
    ends = rf"(?:(?<={_MARK})|(?={_any_of('but')}))"
    beside = rf"(?:(?!(?<=[,.!] ){_any_of('after')}){_any_of('courtesy')}{_GAP})*"
    return re.compile(f"{_GAP}{_beside()}(?:{_any_of('yes')}{_GAP}{beside})+{ends}(?P<rest>.+)")


def _beside() -> str:
    return f"(?:{_any_of('courtesy')}{_GAP})*"


def _any_of(name: str) -> str:
    """Longest first; a Latin word ends where its letters end, Chinese is written without spaces."""
    phrases = [
        phrase for language in REPLY_LANGUAGES for phrase in load_table(language, "consent").get(name, ())
    ]
    found = "|".join(re.escape(phrase) for phrase in sorted(phrases, key=len, reverse=True))
    return rf"(?:(?:{found})(?:(?<![a-z])|(?<=[a-z])(?![a-z0-9'])))"
