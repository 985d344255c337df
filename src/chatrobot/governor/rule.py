"""Rules of the governor: each sees a request and the situation, and says how much of it may be sent.

Rules only ever take away: a factor from 0 to 1, dimensionless. The governor asks all of them and the smallest factor
wins. Here are those that need no geometry; those about the space around the robot are in `space_rules`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.robots.profile import RobotProfile


class Ruling(NamedTuple):
    """A rule's answer to a request: the twist may be sent times `factor` (0..1).

    `urgent` means that a ramp that would come too late is skipped: zero at once. A rule that only wants the robot
    slower, but has no distance to keep, leaves it to the ramp.
    """

    factor: float
    reason: Reason | None = None
    urgent: bool = True


FREE = Ruling(1.0)


@dataclass(frozen=True)
class Sensed:
    """Tells how old the robot's sensor data is.

    `ages_s` tells by name (`odom`, `scan`, `imu`) how long ago each was last heard; a name that is missing was
    never heard. `battery_percent` is None where nobody told.
    """

    ages_s: Mapping[str, float] = field(default_factory=dict)
    battery_percent: float | None = None


NOTHING_SENSED = Sensed()


class Situation(NamedTuple):
    """All that a rule may know: `pose` in `odom`, None where unknown; `begins` where a new motion asks to begin."""

    pose: Pose | None
    sensed: Sensed = NOTHING_SENSED
    begins: bool = False


class Rule(Protocol):
    """One reason to go slower, or not at all."""

    @property
    def name(self) -> str:
        """Return what a verdict calls it."""
        ...

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Say how much of `asked` (within the profile's limits already) may be sent."""
        ...


class Composed(NamedTuple):
    """All rulings in one: `factor` is the smallest, `urgent_factor` the smallest of the urgent ones."""

    rule: str
    ruling: Ruling
    urgent_factor: float


UNRULED = Composed("", FREE, 1.0)


def compose(rules: Sequence[Rule], asked: Twist, situation: Situation) -> Composed:
    """Ask every rule; the most restrictive wins, the first of equals. A factor that is NaN or negative counts as 0."""
    composed = UNRULED
    for rule in rules:
        ruling = rule.judge(asked, situation)
        if not ruling.factor >= 0.0:
            ruling = Ruling(0.0, ruling.reason)
        urgent = min(composed.urgent_factor, ruling.factor) if ruling.urgent else composed.urgent_factor
        if ruling.factor < composed.ruling.factor:
            composed = Composed(rule.name, ruling, urgent)
        else:
            composed = Composed(composed.rule, composed.ruling, urgent)
    return composed


class NarrowedRule:
    """Limits narrowed at run time. There is no way to widen them: a new run begins at the profile's."""

    name = "narrowed"

    def __init__(self) -> None:
        self._speed_mps = math.inf
        self._rate_radps = math.inf

    def narrow(self, speed_mps: float, rate_radps: float) -> None:
        """At most these from now on, and never more than before. Raises ValueError for what is no limit."""
        for limit in (speed_mps, rate_radps):
            if not limit >= 0.0:  # so that NaN is none
                raise ValueError(f"not a limit: {limit}")
        self._speed_mps = min(self._speed_mps, speed_mps)
        self._rate_radps = min(self._rate_radps, rate_radps)

    def judge(self, asked: Twist, situation: Situation) -> Ruling:  # noqa: ARG002 - the protocol's
        """Scale what is beyond the limits, without haste."""
        factor = at_most(asked, self._speed_mps, self._rate_radps)
        if factor == 1.0:
            return FREE
        reason = Reason("narrowed", {"speed_mps": asked.speed_mps * factor})
        return Ruling(factor, reason, urgent=False)


SILENT_S = 0.3
"""Odometry and gyros speak at 20 Hz at least."""

SCAN_SILENT_S = 0.5
SCANS_MISSED = 4.0
"""A slow lidar may miss so many scans before it counts as silent."""


def silent_after_s(profile: RobotProfile, sensor: str) -> float:
    """Return how long a sensor may say nothing before it counts as silent, seconds."""
    if sensor == "scan" and profile.lidar is not None:
        return max(SCAN_SILENT_S, SCANS_MISSED / profile.lidar.rate_hz)
    return SILENT_S


class SensorRule:
    """Refuses while a required sensor is silent, or never spoke."""

    name = "sensors"

    def __init__(self, profile: RobotProfile) -> None:
        self._due_s = {sensor: silent_after_s(profile, sensor) for sensor in profile.safety.requires}

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Refuse motion while a required sensor is silent."""
        if asked.is_zero:
            return FREE
        for sensor, due_s in self._due_s.items():
            if not situation.sensed.ages_s.get(sensor, math.inf) <= due_s:
                return Ruling(0.0, Reason("sensor_silent", {"sensor": sensor}))
        return FREE


SLOW_SHARE = 0.5
"""Of the speed and rate limits, dimensionless: enough to come home, and less current."""


class BatteryRule:
    """With a battery that runs low no new motion begins, and what is under way goes on slowly."""

    name = "battery"

    def __init__(self, profile: RobotProfile, low_percent: float) -> None:
        self._low_percent = low_percent
        self._speed_mps = SLOW_SHARE * profile.limits.max_speed_mps
        self._rate_radps = SLOW_SHARE * profile.limits.max_rate_radps

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        """Refuse what begins below the mark; slow what is under way."""
        percent = situation.sensed.battery_percent
        if percent is None or math.isnan(percent) or percent >= self._low_percent:
            return FREE
        reason = Reason("battery_low", {"percent": round(percent, 1), "low_percent": self._low_percent})
        if situation.begins:
            return Ruling(0.0, reason)
        factor = at_most(asked, self._speed_mps, self._rate_radps)
        return Ruling(factor, reason, urgent=False) if factor < 1.0 else FREE


def at_most(asked: Twist, speed_mps: float, rate_radps: float) -> float:
    """Return the share of `asked`, 0 to 1, that keeps to a speed and a rate."""
    factor = 1.0
    if asked.speed_mps > speed_mps:
        factor = speed_mps / asked.speed_mps
    if abs(asked.wz_radps) * factor > rate_radps:
        factor = rate_radps / abs(asked.wz_radps)
    return factor
