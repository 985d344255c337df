"""docs/simulation.md and docs/worlds.md say what the program does."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest

from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import parse_world

PAGES = Path(__file__).parents[2] / "docs"
DOCS, WORLDS = ((PAGES / name).read_text(encoding="utf-8") for name in ("simulation.md", "worlds.md"))


def test_the_example_world_can_be_loaded() -> None:
    example = re.findall(r"```yaml\n(.*?)```", WORLDS, re.DOTALL)[0]
    world = parse_world(example, "the example")
    assert world.name == "workshop"
    assert len(world.obstacles) == 4
    assert world.place("工作台") is not None
    assert world.allowed_area is not None


@pytest.mark.parametrize("key", [field.name for field in dataclasses.fields(FaultInjection)])
def test_every_lie_is_described(key: str) -> None:
    assert f"| `{key}` |" in DOCS


@pytest.mark.parametrize("options", re.findall(r"--sim ([a-z_]+=[^\s`]*\d)", DOCS))
def test_the_lies_of_the_examples_are_understood(options: str) -> None:
    assert FaultInjection.parse(options) != FaultInjection()
