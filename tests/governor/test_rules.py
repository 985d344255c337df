"""Rules compose, and the most restrictive wins."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import pytest
from tests.governor.situations import MECANUM, at, with_safety

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import make_rules
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import UNRULED, Ruling, Situation, compose
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Circle, Point, RobotProfile, Safety

ASKED = Twist(1.0, 0.0, 0.0)


@dataclass
class Says:
    """A rule that always says the same."""

    name: str
    factor: float
    urgent: bool = True

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        assert (asked, situation) == (ASKED, at())
        return Ruling(self.factor, Reason(self.name), self.urgent)


def test_the_smallest_factor_wins_and_names_its_rule() -> None:
    composed = compose([Says("a", 0.7), Says("b", 0.2), Says("c", 0.5)], ASKED, at())
    assert (composed.rule, composed.ruling.factor, composed.ruling.reason) == ("b", 0.2, Reason("b"))


def test_of_equals_the_first_is_named() -> None:
    assert compose([Says("a", 0.5), Says("b", 0.5)], ASKED, at()).rule == "a"


def test_rules_that_say_nothing_change_nothing() -> None:
    assert compose([Says("a", 1.0), Says("b", 7.0)], ASKED, at()) == UNRULED
    assert compose([], ASKED, at()) == UNRULED


@pytest.mark.parametrize("nonsense", [math.nan, -0.5, -math.inf])
def test_a_rule_that_talks_nonsense_stops_the_robot(nonsense: float) -> None:
    composed = compose([Says("fine", 0.5), Says("broken", nonsense)], ASKED, at())
    assert (composed.rule, composed.ruling, composed.urgent_factor) == (
        "broken",
        Ruling(0.0, Reason("broken")),
        0.0,
    )


def test_the_most_urgent_is_kept_apart_from_the_smallest() -> None:
    rules = [Says("soft", 0.2, urgent=False), Says("hard", 0.6), Says("harder", 0.4)]
    composed = compose(rules, ASKED, at())
    assert (composed.rule, composed.ruling.factor, composed.urgent_factor) == ("soft", 0.2, 0.4)
    assert compose(rules[:1], ASKED, at()).urgent_factor == 1.0


def test_a_soft_rule_that_stops_the_robot_stays_soft() -> None:
    composed = compose([Says("soft", 0.0, urgent=False)], ASKED, at())
    assert (composed.ruling.factor, composed.urgent_factor) == (0.0, 1.0)


def names(profile: RobotProfile, seen: ObstacleMemory | None = None, area: Sequence[Point] = ()) -> list[str]:
    return [rule.name for rule in make_rules(profile, seen, area)]


def test_a_robot_gets_the_rules_that_its_profile_and_its_world_call_for() -> None:
    turtle = load_profile("turtlesim")
    assert names(turtle) == []
    assert MECANUM.lidar is not None
    seen = ObstacleMemory(MECANUM.lidar)
    assert names(MECANUM, seen) == ["obstacle", "blind"]
    full = with_safety(Safety(Circle(0, 0, 1), ("odom",), 0.1, 20.0))
    area = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    assert names(full, seen, area) == ["sensors", "obstacle", "blind", "fence", "fence", "battery"]
    assert names(replace(full, safety=Safety()), None, ()) == []
