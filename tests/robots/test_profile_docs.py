"""docs/robots.md says what the program does."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest

from chatrobot.robots.load import ProfileEntry, list_profiles
from chatrobot.robots.profile import Calibration, Defaults, Lidar, Limits, Wiring

DOCS = (Path(__file__).parents[2] / "docs" / "robots.md").read_text(encoding="utf-8")
BUILT_IN = [entry for entry in list_profiles() if entry.origin == "built-in"]


@pytest.mark.parametrize("entry", BUILT_IN, ids=lambda entry: entry.name)
def test_the_list_of_profiles_has_the_numbers_of_the_files(entry: ProfileEntry) -> None:
    robot = entry.load()
    timeout = robot.wiring.base_timeout_s
    holds = "for ever" if timeout is None else f"{timeout:g} s"
    limits = robot.limits
    row = (
        f"| `{robot.name}` | {robot.kinematics} | {limits.max_speed_mps:g} m/s "
        f"| {limits.max_rate_radps:g} rad/s | {holds} |"
    )
    assert row in DOCS


def test_every_profile_of_the_list_is_there() -> None:
    table = DOCS.split("## Built-in profiles")[1].split("\n\n")[1]
    assert set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == {entry.name for entry in BUILT_IN}


@pytest.mark.parametrize("part", [Limits, Defaults, Lidar, Calibration, Wiring])
def test_every_field_is_described(part: type) -> None:
    assert [field.name for field in dataclasses.fields(part) if f"`{field.name}`" not in DOCS] == []
