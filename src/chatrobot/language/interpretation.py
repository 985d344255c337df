"""What an utterance means: what is handed to whoever acts on it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple, get_args

from chatrobot.core.event import Proposal
from chatrobot.language.conditions import is_condition
from chatrobot.language.ledger import Walk
from chatrobot.language.phrases import describe_plan, say
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import with_each
from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn, Wait
from chatrobot.plan.text import parse_plan

LanguageCode = Literal["en", "zh", "de"]
_CODES: Mapping[str, LanguageCode] = {code: code for code in get_args(LanguageCode)}
Outcome = Literal["plan", "stop", "unclear", "refused", "answered"]


_QUOTED = 60
"""So much of the text of the motion before is quoted."""
_ROUNDED = ("distance_m", "duration_s", "radius_m", "speed_mps", "angle_rad")


@dataclass(frozen=True)
class Placement:
    """A thing that is put somewhere, metres in the odom frame; without a place it is taken away."""

    name: str
    at_m: tuple[float, float] | None = None


class Usual(NamedTuple):
    """What holds where a text does not say it, as a person set it; None: the profile's.

    `limit_mps` holds whatever a text says; infinite: the profile's again.
    """

    speed_mps: float | None = None
    rate_radps: float | None = None
    distance_m: float | None = None
    turn_rad: float | None = None
    limit_mps: float | None = None

    def changed(self, new: Usual) -> Usual:
        """The same with what `new` sets."""
        return Usual(*(old if value is None else value for old, value in zip(self, new)))


@dataclass(frozen=True)
class Interpretation:
    """What an utterance means.

    `unaccounted` is the part that nothing explains, `code` the reason in a word (see `phrases.toml`).
    `append`: it goes on where the running motion ends. `proposal`: the reply asks about that plan. The last eight
    are for the dialogue's memory and hold from the moment the session accepts the turn; `remember_place` is where
    the robot stands now, `walk` what of the ledger of turns the plan undoes or does again; `corrects`: it puts the
    turn before right; `renamed`: what a taught place or word is called from now on, nothing where it is forgotten;
    `obstacles`: what is to be put into the simulation or taken out of it; `usual`: what is set from now on;
    `open_text`: what a question asks about, where that is not the text itself.
    """

    outcome: Outcome
    reply: str
    language: LanguageCode
    plan: Plan | None = None
    append: bool = False
    unaccounted: str = ""
    code: str = ""
    proposal: Proposal | None = None
    define: Mapping[str, Plan] = field(default_factory=dict)
    remember_place: str = ""
    walk: Walk | None = None
    corrects: bool = False
    renamed: Mapping[str, str] = field(default_factory=dict)
    obstacles: tuple[Placement, ...] = ()
    usual: Usual = field(default_factory=Usual)
    open_text: str = ""

    @property
    def is_held(self) -> bool:
        """The plan that it proposes waits for a `go`, and was no guess; an answer in between leaves it waiting."""
        return self.proposal is not None and (self.code == "held" or self.outcome == "answered")

    @property
    def held_plan(self) -> Plan | None:
        """The plan that waits for a `go`."""
        return self._proposed_plan if self.is_held else None

    @property
    def offered_plan(self) -> Plan | None:
        """The plan that is asked about."""
        return None if self.is_held else self._proposed_plan

    @property
    def _proposed_plan(self) -> Plan | None:
        return parse_plan(self.proposal.plan_text) if self.proposal is not None else None

    @property
    def teaches(self) -> bool:
        """A place or a word is learnt by it, called otherwise or forgotten, beside what it may drive."""
        return bool(self.remember_place or self.renamed or self.define)

    @property
    def is_about_turn_before(self) -> bool:
        """It undoes, does again or puts right, so that the turn before must have ended."""
        return self.walk is not None or self.corrects


def language_of_tags(tags: str) -> LanguageCode:
    """Return the first language of tags such as `de_AT.UTF-8` or `zh-CN,zh;q=0.9` that people are answered in.

    English, where none is.
    """
    codes = (re.split(r"[-_.;@]", tag.strip())[0].casefold() for tag in tags.split(","))
    return next((_CODES[code] for code in codes if code in _CODES), "en")


def planned(
    steps: list[Step], language: LanguageCode, *, append: bool = False, walk: Walk | None = None
) -> Interpretation:
    """These steps are to be done.

    Raises:
        Unclear: where there are none.
    """
    try:
        plan = Plan(tuple(with_each(step, _rounded) for step in steps))
    except ValueError:
        raise Unclear("nothing_to_do") from None
    return Interpretation("plan", describe_plan(plan, language), language, plan, append, walk=walk)


def _rounded(step: Step) -> Step:
    """Return the step without what arithmetic adds to its numbers: 0.7 m, not 0.7000000000000001 m."""
    if not isinstance(step, (Drive, Turn, Arc, Wait)):
        return step
    values = {name: getattr(step, name, None) for name in _ROUNDED}
    told = {name: value for name, value in values.items() if isinstance(value, float)}
    rounded: dict[str, Any] = {
        name: math.radians(_near(math.degrees(value))) if name.endswith("_rad") else _near(value)
        for name, value in told.items()
    }
    return replace(step, **rounded)


def _near(value: float) -> float:
    """Return the short number that is meant, where it is as near as that; a seventh stays what it is."""
    short = round(value, 6)
    return short if abs(value - short) < 1e-9 else value


def taught(name: str, plan: Plan, language: LanguageCode) -> Interpretation:
    """The answer that a word means a plan from now on."""
    reply = say(language, "defined", name=name, text=describe_plan(plan, language))
    return Interpretation("answered", reply, language, define={name: plan})


def stopped(language: LanguageCode) -> Interpretation:
    """It is a stop."""
    return Interpretation("stop", say(language, "stop"), language)


def asked_back(problem: Unclear, language: LanguageCode, before: str = "") -> Interpretation:
    """It was not understood, or is refused. `before` is what the motion before was told, if there was one."""
    outcome: Outcome = "refused" if problem.refused else "unclear"
    if problem.code == "nothing_before" and before:
        reply = say(language, "nothing_in_before", before=before[:_QUOTED])
    else:
        reply = say(language, "conditional" if is_condition(problem) else problem.code, part=problem.part)
    return Interpretation(
        outcome, reply, language, unaccounted=problem.part, code=problem.code, open_text=problem.open_text
    )
