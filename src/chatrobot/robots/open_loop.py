"""Open loop: how a robot is driven that measures nothing of its motion, where a person has asked for it.

Nobody sees whether such a robot goes where it is told, or stops when it is told. So it goes slowly and for a short
time, and nothing is told of it as measured. It is never a way round odometry that is lost: a robot whose profile has
odometry is not driven like this.
"""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.errors import UsageError
from chatrobot.core.motion_budget import MotionBudget
from chatrobot.robots.cautious import slowed
from chatrobot.robots.profile import RobotProfile

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
