"""How a robot is driven whose base holds its last command, by a machine that a network may part from it.

When the network goes, nobody can reach the base any more, and it drives on with what it was told last. Nothing that
runs on the far machine can prevent that: it can only see to it that the last command was a slow one.
"""

from __future__ import annotations

from dataclasses import replace

from chatrobot.robots.profile import RobotProfile

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
