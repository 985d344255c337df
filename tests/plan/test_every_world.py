"""Every built-in world is driven through: each of its places is understood by each of its names, and reached."""

from __future__ import annotations

import math
import re

import pytest

from chatrobot.cli.world_check import problems, unsaid_names
from chatrobot.compose import Setup, connect
from chatrobot.core.event import Event
from chatrobot.core.geometry import ORIGIN
from chatrobot.core.sensed_events import TruePose
from chatrobot.dialogue.options import Options
from chatrobot.language.normalise import has_chinese
from chatrobot.plan.context import Route
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.robots.load import DEFAULT_PROFILE, list_profiles, load_profile
from chatrobot.sim.load import find_world, world_names
from chatrobot.sim.world import check_start

WORLDS = [name for name in world_names() if name != "empty"]
WIDE = load_profile("generic_diff")
"""0.4 m square: what it passes, the small bases pass."""
LIMITS = {"max_speed_mps": 8.0, "max_rate_radps": 16.0, "acceleration_mps2": 40.0,
          "angular_acceleration_radps2": 200.0, "deceleration_mps2": 40.0}  # fmt: skip
CHANGES = {rf"({name} = {{ value = )[\d.]+": rf"\g<1>{value}" for name, value in LIMITS.items()} | {
    r"\nspeed_mps = .*": "\nspeed_mps = 8.0", r"\nrate_radps = .*": "\nrate_radps = 16.0",
    r"\n\[lidar\](\n.+)*": "", r"\nscan_topic = .*": "",
}  # fmt: skip
"""Of the profile of the default robot. Each second of a drive costs 50 ticks, however fast it is driven: 500 legs at
0.3 m/s would take minutes. The lidar costs a third; what rehearsal knows of the world stays, as do the robot's size
and kinematics."""
NEAR_M = 0.05


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


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The default robot, but quick: its profile's file."""
    text = next(entry for entry in list_profiles() if entry.name == DEFAULT_PROFILE).file.read_text("utf-8")
    for before, after in CHANGES.items():
        text, count = re.subn(before, after, text)
        assert count, before
    path = tmp_path_factory.mktemp("robots") / "quick.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("name", WORLDS)
def test_sentences_drive_to_each_place_by_its_first_or_last_name(name: str, quick: str) -> None:
    """Each time from another place; where the robot then is, the simulator says. The other names lead to the same step
    (above)."""
    truth: list[TruePose] = []

    def hear(event: Event) -> None:
        if isinstance(event, TruePose):
            truth[:] = [event]

    options = Options(interpreter="offline")
    setup = Setup(world=name, robot=quick, fast=True, trace=True, options=options)
    connection = connect(setup, hear)
    world = connection.world
    places = list(world.places)
    trip = [(place, world.names_of(place)[-(number % 2)]) for number, place in enumerate(places)]
    missed = []
    for place, said in trip:
        sentence = f"去{said}" if has_chinese(said) else f"go to the {said}"
        result = connection.session.do(sentence)
        off_m = math.dist((truth[0].x_m, truth[0].y_m), world.places[place][:2])
        if result.outcome != "completed" or off_m > NEAR_M:
            missed.append((sentence, result.outcome, result.reply, off_m))
    connection.close()
    assert missed == []
