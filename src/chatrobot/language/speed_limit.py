"""The highest speed that a person allows: `never faster than 0.2 m/s`. Every plan of the dialogue keeps to it."""

from __future__ import annotations

import math
from dataclasses import replace

from chatrobot.language.context import Context
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import say
from chatrobot.language.proposals import offer
from chatrobot.plan.base import with_each
from chatrobot.plan.steps import Arc, Drive, Go, Plan, RawTwist, Repeat, Step
from chatrobot.robots.profile import RobotProfile

_DRIVEN = (Drive, Arc, Go)
"""Steps that have a speed, or go as fast as usual."""


def bounded(profile: RobotProfile, limit_mps: float) -> RobotProfile:
    """The profile of a robot that is no faster than `limit_mps`, and as fast as usual where that is slower."""
    limits, defaults = profile.limits, profile.defaults
    return replace(
        profile,
        limits=replace(limits, max_speed_mps=min(limits.max_speed_mps, limit_mps)),
        defaults=replace(defaults, speed_mps=min(defaults.speed_mps, limit_mps)),
    )


def without_limit(context: Context) -> Context:
    """The context of a reader who has the limit in its profile."""
    dialogue = context.dialogue
    return replace(context, dialogue=replace(dialogue, usual=dialogue.usual._replace(limit_mps=None)))


def plan_within(plan: Plan, limit_mps: float, profile: RobotProfile) -> Plan:
    """The plan with every step no faster than `limit_mps`."""
    return Plan(tuple(kept_within(step, limit_mps, profile) for step in plan.steps))


def kept_within(step: Step, limit_mps: float, profile: RobotProfile) -> Step:
    """The step no faster than `limit_mps`, on the same path. `profile`: the robot's own."""
    return with_each(step, lambda each: _kept_within(each, limit_mps, profile))


def _kept_within(step: Step, limit_mps: float, profile: RobotProfile) -> Step:
    if isinstance(step, _DRIVEN):
        is_slower = (step.speed_mps or profile.defaults.speed_mps) <= limit_mps
        return step if is_slower else replace(step, speed_mps=limit_mps)
    if isinstance(step, RawTwist) and (speed_mps := math.hypot(step.vx_mps, step.vy_mps)) > limit_mps:
        share = limit_mps / speed_mps
        return replace(
            step,
            vx_mps=step.vx_mps * share,
            vy_mps=step.vy_mps * share,
            wz_radps=step.wz_radps * share,
            duration_s=step.duration_s / share,
        )
    return step


def within_limit(meant: Interpretation, limit_mps: float, profile: RobotProfile) -> Interpretation:
    """What is meant, with its plan within the limit; a plan that says more is asked about, at the limit."""
    plan = meant.plan or meant.held_plan or meant.offered_plan
    if plan is None:
        return meant
    slowed, language = plan_within(plan, limit_mps, profile), meant.language
    if meant.plan is None:
        if slowed == plan or meant.proposal is None:
            return meant
        asked = offer(slowed, language, code="held" if meant.is_held else "did_you_mean")
        return replace(meant, reply=meant.reply.replace(meant.proposal.say, asked.say), proposal=asked)
    if not any(_says_more(step, limit_mps) for step in plan.steps):
        return replace(meant, plan=slowed)
    asked = offer(slowed, language, code="did_you_mean")
    reply = f"{say(language, 'above_said_limit', mps=f'{limit_mps:.3g}')} {asked.say}"
    return Interpretation("refused", reply, language, code="above_said_limit", proposal=asked)


def _says_more(step: Step, limit_mps: float) -> bool:
    if isinstance(step, Repeat):
        return any(_says_more(one, limit_mps) for one in step.steps)
    if isinstance(step, RawTwist):
        return math.hypot(step.vx_mps, step.vy_mps) > limit_mps
    return isinstance(step, _DRIVEN) and (step.speed_mps or 0.0) > limit_mps
