"""Every built-in world is driven through: each of its places from the start and back."""

from __future__ import annotations

import math

import pytest

from chatrobot.cli.world_check import problems, unsaid_names
from chatrobot.compose import Setup, connect
from chatrobot.core.geometry import ORIGIN
from chatrobot.plan.context import Route
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import find_world, world_names
from chatrobot.sim.world import check_start

WORLDS = [name for name in world_names() if name != "empty"]
WIDE = load_profile("generic_diff")
"""0.4 m square: what it passes, the small bases pass."""
TOURS = {
    "classroom": "go to the blackboard",
    "football": "去中圈",
    "home": "go to the sofa",
    "maze": "forward 2 m, then go to the entrance",
    "office": "去前台",
    "warehouse": "go to rack A",
}


@pytest.mark.parametrize("name", WORLDS)
def test_each_place_is_reached_from_the_start_and_so_from_each_other(name: str) -> None:
    world = find_world(name).world
    check_start(world, WIDE, name)
    routes = GridRoutePlanner(world, WIDE)
    for goal in world.places.values():
        for start, end in ((ORIGIN, goal), (goal, ORIGIN)):
            assert isinstance(routes.route(start, (end.x_m, end.y_m), named_place=True), Route)


@pytest.mark.parametrize("name", WORLDS)
def test_each_place_is_understood_and_each_thing_has_a_chinese_name(name: str) -> None:
    file = find_world(name)
    profile = load_profile("wheeltec_mini_mec")
    assert [str(problem) for problem in (*problems(file, profile), *unsaid_names(file, profile))] == []
    named = (*((obstacle.name, *obstacle.aliases) for obstacle in file.world.obstacles),)
    for names in (*named, *map(file.world.names_of, file.world.places)):
        assert any("一" <= char <= "鿿" for name in names for char in name), names


@pytest.mark.parametrize("name", WORLDS)
def test_a_sentence_drives_to_one_of_its_places(name: str) -> None:
    connection = connect(Setup(world=name, fast=True), lambda _: None)
    result = connection.session.do(TOURS[name])
    assert result.outcome == "completed", result.reply
    places = connection.world.places.values()
    assert min(math.dist(result.pose[:2], place[:2]) for place in places) < 0.05
    connection.close()


def test_every_world_has_a_tour() -> None:
    assert sorted(TOURS) == sorted(WORLDS)
