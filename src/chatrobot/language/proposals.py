"""A plan that is asked about before it is driven."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.core.event import Proposal
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.phrases import describe_plan, say
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan


def proposed(
    found: Interpretation, language: LanguageCode, left_out: Sequence[str] = (), *, code: str = "did_you_mean"
) -> Interpretation | None:
    """The question whether that is meant; None where there is nothing to do."""
    if found.plan is None:
        return None
    asked = offer(found.plan, language, code=code)
    named = max(left_out, key=len, default="")
    reply = f"{say(language, 'left_out', part=named)} {asked.say}" if named else asked.say
    return Interpretation("unclear", reply, language, unaccounted=named, code=code, proposal=asked)


def offer(plan: Plan, language: LanguageCode, *, code: str = "held") -> Proposal:
    """A plan, and the question whether it is to be driven."""
    return Proposal(format_plan(plan), say(language, code, text=describe_plan(plan, language)))
