"""What is said of a plan while it is driven: of its speed, and of what is left of it."""

from __future__ import annotations

from functools import cache

from chatrobot.language.acts import order_log_odds, read_acts
from chatrobot.language.context import Context
from chatrobot.language.data_files import load_table
from chatrobot.language.glossed import in_known_words
from chatrobot.language.normalise import normalise
from chatrobot.language.rules import Rules, form, rules


def of_speed(plain: str, language: str) -> str:
    """A normalised text in the words that change a plan, `slower` for `too fast`; "" where it orders nothing.

    What is no known form has to order something: `you are quick today` tells, and `is it fast?` asks.
    """
    found = _rules(language)
    known = next((rule.applied(plain) for rule in found.that_may_match(plain) if rule.is_in(plain)), "")
    is_order = not plain.endswith("?") and order_log_odds(read_acts(plain)) >= 0.0
    return known or (plain if is_order else "")


def asks_what_is_left(text: str, context: Context) -> bool:
    """Whether `text` asks how far the plan is, what comes next or where it leads: `how much longer?`."""
    language, text = in_known_words(text, context)
    return form(language, "driven", "left").search(normalise(text)) is not None


def says_otherwise(text: str, context: Context, *, is_faster: bool) -> bool:
    """Whether `text` has only words of the other direction: 减速60% is no share of the highest speed, which is more."""
    language, text = in_known_words(text, context)
    plain = of_speed(normalise(text), language)
    slows, hastens = (
        form(language, "driven", name).search(plain) is not None for name in ("slows", "hastens")
    )
    return slows and not hastens if is_faster else hastens and not slows


@cache
def _rules(language: str) -> Rules:
    table = load_table(language, "driven")
    return rules(f"driven_{language}", table["rules"], table["parts"])
