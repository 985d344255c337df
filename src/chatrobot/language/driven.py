"""What is said of a plan while it is driven: of its speed, and of what is left of it."""

from __future__ import annotations

from functools import cache

from chatrobot.language.context import Context
from chatrobot.language.data_files import load_table
from chatrobot.language.glossed import in_known_words
from chatrobot.language.normalise import normalise
from chatrobot.language.rules import Rules, form, rules


def of_speed(plain: str, language: str) -> str:
    """`Too fast`, a normalised text, in the words that change the speed of a plan; other texts as they are."""
    found = _rules(language)
    return next((rule.applied(plain) for rule in found.that_may_match(plain) if rule.is_in(plain)), plain)


def asks_what_is_left(text: str, context: Context) -> bool:
    """Whether `text` asks how far the plan is, what comes next or where it leads: `how much longer?`."""
    language, text = in_known_words(text, context)
    return form(language, "driven", "left").search(normalise(text)) is not None


@cache
def _rules(language: str) -> Rules:
    table = load_table(language, "driven")
    return rules(f"driven_{language}", table["rules"], table["parts"])
