"""A base that holds its last command is driven slowly where a network may fail."""

from __future__ import annotations

import pytest

from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.robots.open_loop import SLOW_MPS, SLOW_RADPS, drives_on_alone, slowed
from chatrobot.robots.parse import parse_profile
from chatrobot.robots.rules import check

NAMES = [entry.name for entry in list_profiles()]


@pytest.mark.parametrize(
    ("name", "alone"), [("wheeltec_mini_mec", True), ("turtlesim", False), ("turtlebot4", False)]
)
def test_what_stops_by_itself_is_not_slowed(name: str, alone: bool) -> None:
    assert drives_on_alone(load_profile(name)) is alone


@pytest.mark.parametrize("name", NAMES)
def test_no_limit_grows_and_the_profile_still_makes_sense(name: str) -> None:
    before = load_profile(name)
    after = slowed(before)

    def fail(field: str, problem: str, allowed: str) -> None:
        raise AssertionError(f"{field}: {problem}; {allowed}")

    check(after, fail)  # type: ignore[arg-type]
    assert after.limits.max_speed_mps == min(before.limits.max_speed_mps, SLOW_MPS)
    assert after.limits.max_sideways_mps <= before.limits.max_sideways_mps
    assert after.limits.max_rate_radps <= min(before.limits.max_rate_radps, SLOW_RADPS)
    assert after.defaults.speed_mps <= before.defaults.speed_mps
    assert slowed(after) == after


def test_a_namespace_of_the_profile_is_read() -> None:
    from pathlib import Path

    text = (Path(list_profiles()[0].file)).read_text(encoding="utf-8")
    assert "[wiring]" in text
    named = text.replace("[wiring]", '[wiring]\nnamespace = "/robot1"')
    assert parse_profile(named, "x").wiring.namespace == "robot1"
