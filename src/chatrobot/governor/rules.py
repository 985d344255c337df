"""All rules of the governor. A new one is added here: a function that makes it, or None where it does not apply."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from chatrobot.core.geometry import Twist
from chatrobot.governor.battery import BatteryRule
from chatrobot.governor.blind import BlindRule
from chatrobot.governor.fence import FenceRule
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.obstacles import ObstacleRule
from chatrobot.governor.rule import FREE, Rule, Ruling, Situation
from chatrobot.governor.sensors_due import SensorRule
from chatrobot.robots.profile import Point, RobotProfile


@dataclass(frozen=True)
class Setting:
    """What rules are made from. `area` is the corners of the area that the world allows, in `odom`."""

    profile: RobotProfile
    seen: ObstacleMemory | None = None
    area: Sequence[Point] | None = None


def _sensors(setting: Setting) -> Rule | None:
    return SensorRule(setting.profile) if setting.profile.safety.requires else None


def _obstacle(setting: Setting) -> Rule | None:
    return ObstacleRule(setting.profile, setting.seen) if setting.seen is not None else None


def _blind(setting: Setting) -> Rule | None:
    return BlindRule(setting.profile, setting.seen) if setting.seen is not None else None


def _fence(setting: Setting) -> Rule | None:
    fence = setting.profile.safety.fence
    return FenceRule(setting.profile, fence) if fence is not None else None


def _area(setting: Setting) -> Rule | None:
    return FenceRule(setting.profile, setting.area) if setting.area else None


def _battery(setting: Setting) -> Rule | None:
    low_percent = setting.profile.safety.battery_low_percent
    return BatteryRule(setting.profile, low_percent) if low_percent is not None else None


MAKERS: tuple[Callable[[Setting], Rule | None], ...] = (
    _sensors, _obstacle, _blind, _fence, _area, _battery,
)  # fmt: skip


def make_rules(setting: Setting) -> list[Rule]:
    """The rules that apply to one robot."""
    return [rule for rule in (make(setting) for make in MAKERS) if rule is not None]


@dataclass(frozen=True)
class Composed:
    """All rulings in one: `factor` is the smallest, `urgent_factor` the smallest of the urgent ones."""

    rule: str
    ruling: Ruling
    urgent_factor: float


UNRULED = Composed("", FREE, 1.0)


def compose(rules: Sequence[Rule], asked: Twist, situation: Situation) -> Composed:
    """Ask every rule; the most restrictive wins, the first of equals. A factor that is no number counts as 0."""
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
