"""How a robot is driven that nobody may be able to stop, or to see: slowly.

A base that holds its last command drives on when a network parts it from us. Nothing on the far machine can prevent
that; the last command can be a slow one.

Open loop, where a person asks for it, drives a robot that measures nothing of its motion. Nobody sees whether it goes
or stops as it is told, so it goes slowly and for a short time, and nothing is told as measured. It is no way round
odometry that is lost: a robot whose profile has odometry is not driven like this.
"""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.errors import UsageError
from chatrobot.robots.profile import MotionBudget, RobotProfile

SLOW_MPS = 0.15
SLOW_RADPS = 0.5
"""Slow enough to be caught on foot, and to be held by a hand."""

LONG_HOLD_S = 1.0
"""A base that holds its last command for no longer than this stops by itself."""


def drives_on_alone(profile: RobotProfile) -> bool:
    """The base goes on for longer than `LONG_HOLD_S` after the last command."""
    timeout_s = profile.wiring.base_timeout_s
    return timeout_s is None or timeout_s > LONG_HOLD_S


def slowed(profile: RobotProfile, most_mps: float = SLOW_MPS, most_radps: float = SLOW_RADPS) -> RobotProfile:
    """The same robot, never faster than `most_mps` and `most_radps`; limits only ever shrink."""
    limits, defaults = profile.limits, profile.defaults
    speed_mps = min(limits.max_speed_mps, most_mps)
    rate_radps = min(limits.max_rate_radps, most_radps)
    if not profile.can_turn_on_the_spot:
        rate_radps = min(rate_radps, speed_mps / limits.min_turning_radius_m)
    return replace(
        profile,
        limits=replace(
            limits,
            max_speed_mps=speed_mps,
            max_sideways_mps=min(limits.max_sideways_mps, speed_mps),
            max_rate_radps=rate_radps,
        ),
        defaults=replace(
            defaults,
            speed_mps=min(defaults.speed_mps, speed_mps),
            rate_radps=min(defaults.rate_radps, rate_radps),
        ),
    )


OPEN_LOOP_MPS = 0.2
OPEN_LOOP_RADPS = 0.5
OPEN_LOOP_S = 10.0
"""How long one text or program may drive."""

NO_ODOMETRY = "no_odometry"
"""The profile that stands in where a person asks for open loop and names no robot."""


def as_chosen(profile: RobotProfile, budget: MotionBudget, *, open_loop: bool) -> RobotProfile:
    """The robot with what a person chose for it when it was connected.

    Raises:
        UsageError: open loop was chosen for a robot that has odometry.
    """
    profile = profile.with_budget(budget)
    return driven_open_loop(profile) if open_loop else profile


def driven_open_loop(profile: RobotProfile) -> RobotProfile:
    """The same robot, to be driven open loop; limits only ever shrink.

    Raises:
        UsageError: it has odometry.
    """
    if profile.has_odometry:
        raise UsageError(
            f"{profile.name} has odometry (on {profile.wiring.odom_topic}), and is driven by it alone",
            where="open loop",
            allowed=f'only for a robot without odometry: the profile {NO_ODOMETRY}, or yours with odom_topic = "none"',
        )
    slow = slowed(profile, OPEN_LOOP_MPS, OPEN_LOOP_RADPS)
    budget = replace(slow.safety.budget, ceiling_s=OPEN_LOOP_S)
    return replace(slow, open_loop=True, safety=replace(slow.safety, budget=budget))
