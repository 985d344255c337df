"""What is said of a plan before it is done: of its speed and its steps, and of what is left of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Literal

from chatrobot.language.acts import order_log_odds, read_acts
from chatrobot.language.answers import with_manner
from chatrobot.language.context import Context
from chatrobot.language.data_files import load_table
from chatrobot.language.glossed import in_known_words
from chatrobot.language.held import is_no_order, names_part
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.normalise import normalise
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import in_full, rephrased
from chatrobot.language.rules import Rules, form, rules
from chatrobot.language.speed_limit import bounded, plan_within, without_limit
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import expanded
from chatrobot.plan.speed_scaling import SpeedScaling, speed_scaling
from chatrobot.plan.steps import Go, Plan, Step
from chatrobot.robots.profile import RobotProfile

_REMARK = -3.0
"""A text that names a part of a plan, with lower odds of an order, remarks on it: `the turn comes now`."""


def rescaled(
    plan: Plan, said: str, step_number: int, context: Context, profile: RobotProfile
) -> tuple[Plan, SpeedScaling] | None:
    """The plan at the speed that is `said` of it, and what makes it of `plan`; None for any other text. Never raises.

    Args:
        step_number: of the step under way, repeats counted.
    """
    language, text = in_known_words(said, context)
    plain = _of_speed(normalise(text), language)
    limit_mps = context.dialogue.usual.limit_mps
    if limit_mps is not None:
        profile, context = bounded(profile, limit_mps), without_limit(context)
    after = _with_manner(plan, rephrased(plain, language), Reading(language, context, profile))
    if after is not None and limit_mps is not None:
        after = plan_within(after, limit_mps, profile)
    scaling = speed_scaling(plan, after, profile, step_number=step_number) if after is not None else None
    if after is None or scaling is None or _says_otherwise(plain, language, is_faster=scaling.is_faster):
        return None
    return after, scaling


def says(what: Literal["left", "wrong", "no_more", "last_not"], text: str, context: Context) -> bool:
    """Whether `text` asks what is `left` (`how much longer?`), or calls the way `wrong` (`not that way!`).

    Or wants `no_more` than the step under way (`finish this and stop`), or what was said last not (`skip that one`).
    """
    language, text = in_known_words(text, context)
    return form(language, "driven", what).search(normalise(text)) is not None


def changed(
    plan: Plan,
    said: str,
    after: Context,
    profile: RobotProfile,
    read: Callable[[str, Context], Interpretation],
) -> list[Step] | None:
    """The steps of a plan that is not done yet with what is `said` of them, repeats counted out; None for no change.

    It is read as of a plan that waits for a `go`, unless it is an order of its own. No step where it takes all out.

    Args:
        after: what is known once the plan is done.
        read: reads a text in a context, and notes nothing.
    """
    language, known = in_known_words(said, after)
    plain = in_full(normalise(known), language)
    without = _without_place(plan, plain, language)
    if without is not None:
        return without
    if not _may_change(plain, Reading(language, after, profile)):
        return None
    alone = replace(after.dialogue, turns=(), pending="", offered=None, held=None)
    is_own = read(said, replace(after, dialogue=alone)).plan is not None
    if is_own and not read(said, after).corrects:
        return None
    meant = read(said, replace(after, dialogue=replace(alone, turns=after.dialogue.turns, held=plan)))
    if meant.code == "all_left_out":
        return []
    new = meant.held_plan if meant.code == "held" else None
    return list(expanded(new.steps)) if new is not None and new != plan else None


def drops(plan: Plan, text: str, context: Context) -> bool:
    """Whether `text` will not have gone to the place that is all that a plan goes to: `skip the kitchen`."""
    language, known = in_known_words(text, context)
    return _without_place(plan, in_full(normalise(known), language), language) == []


def _without_place(plan: Plan, plain: str, language: str) -> list[Step] | None:
    """The steps without the way to the place that a normalised text will not have gone to; None for any other text."""
    said = form(language, "driven", "drops").search(plain)
    steps = [*expanded(plan.steps)]
    named = said["place"].strip() if said is not None else ""
    left = [step for step in steps if not (isinstance(step, Go) and named and step.place.casefold() == named)]
    return left if len(left) < len(steps) else None


def _with_manner(plan: Plan, plain: str, reading: Reading) -> Plan | None:
    """The plan as fast or slow as a text says of all of it; None where it orders a motion, or names a part."""
    try:
        if not plain or names_part(plain, reading) or not is_no_order(plain, reading):
            return None
        return with_manner(plan, plain, reading)
    except Unclear:
        return None


def _of_speed(plain: str, language: str) -> str:
    """A normalised text in the words that change a plan, `slower` for `too fast`; "" where it orders nothing.

    What is no known form has to order something: `you are quick today` tells, and `is it fast?` asks.
    """
    found = _rules(language)
    known = next((rule.applied(plain) for rule in found.that_may_match(plain) if rule.is_in(plain)), "")
    return known or (plain if _is_order(plain) else "")


def _may_change(plain: str, reading: Reading) -> bool:
    """Whether it orders something; words that name a part of a plan, or correct it, need but be no sure remark."""
    is_about = form(reading.language, "held", "instead").search(plain) or names_part(plain, reading)
    return _is_order(plain, _REMARK if is_about else 0.0)  # not `I said 40 to my friend`


def _is_order(plain: str, least_log_odds: float = 0.0) -> bool:
    return not plain.endswith("?") and order_log_odds(read_acts(plain)) >= least_log_odds


def _says_otherwise(plain: str, language: str, *, is_faster: bool) -> bool:
    """Whether it has only words of the other direction: 减速60% is no share of the highest speed, which is more."""
    slows, hastens = (
        form(language, "driven", name).search(plain) is not None for name in ("slows", "hastens")
    )
    return slows and not hastens if is_faster else hastens and not slows


@cache
def _rules(language: str) -> Rules:
    table = load_table(language, "driven")
    return rules(f"driven_{language}", table["rules"], table["parts"])
