"""`go to` a place faces the heading that the place was given, where that is asked for, and says so."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import chatrobot
from chatrobot.core.events import Event, Interpreted
from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, Place
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Go
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

HOME = load_world("home")
CONTEXT = Context(
    Dialogue(places={"base": Place(Pose(1.0, 2.0, 0.5))}),
    world_places={alias: HOME.places[main] for alias, main in HOME.aliases.items()},
    places_without_heading=frozenset({"sofa"}),
)
INTERPRETER = OfflineInterpreter(load_profile("wheeltec_mini_mec"))


def first_go(text: str) -> Go:
    plan = INTERPRETER.interpret(text, CONTEXT).plan
    assert plan is not None, text
    go = plan.steps[0]
    assert isinstance(go, Go)
    return go


@pytest.mark.parametrize(
    "text",
    [
        "go to the desk and face its heading", "go to the desk, then turn to its heading",
        "drive to the desk facing its direction", "go to the desk and face the way it says",
        "go to the desk and align with it", "go slowly to the desk with its orientation, then wait 1 s",
        "去书桌，朝向它的方向", "去书桌并且按它的朝向", "开到书桌，对准它的朝向",
    ],
)  # fmt: skip
def test_the_heading_of_a_place_is_faced_where_it_is_asked_for(text: str) -> None:
    assert first_go(text).yaw_rad == pytest.approx(math.radians(45.0))


@pytest.mark.parametrize("text", ["go to the desk", "park at the dock", "desk", "去书桌"])
def test_otherwise_it_is_not(text: str) -> None:
    assert first_go(text).yaw_rad is None


def test_a_place_of_ones_own_has_the_heading_it_was_remembered_with() -> None:
    assert first_go("go to base and face its heading").yaw_rad == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "told"),
    [("go to the sofa and face its heading", "without a heading"), ("去沙发，朝向它的方向", "沙发")],
)
def test_a_place_without_a_heading_is_asked_about(text: str, told: str) -> None:
    context = CONTEXT if "sofa" in text else Context(
        world_places=CONTEXT.world_places, places_without_heading=frozenset({"沙发"})
    )  # fmt: skip
    meant = INTERPRETER.interpret(text, context)
    assert meant.outcome == "unclear"
    assert told in meant.reply


@pytest.mark.parametrize("text", ["face its heading", "forward 1 m and face its heading", "朝向它的方向"])
def test_without_a_place_it_is_asked_about(text: str) -> None:
    assert INTERPRETER.interpret(text, CONTEXT).outcome == "unclear"


@pytest.mark.parametrize(
    ("text", "announced", "told"),
    [
        (
            "go to the desk and face its heading",
            "go to desk and face 45°, its heading",
            "the heading of “desk” is 45°",
        ),
        ("去书桌，朝向它的方向", "去书桌，朝向它的方向 45°", "“书桌”规定的朝向是 45°"),
    ],
)
def test_it_is_announced_and_what_was_measured_is_told(text: str, announced: str, told: str) -> None:
    heard: list[Event] = []
    with chatrobot.connect(fast=True) as robot:
        robot.on_event(heard.append)
        result = robot.do(text)
        again = robot.do(text)
    assert next(event.reply for event in heard if isinstance(event, Interpreted)) == announced
    assert result.pose.yaw_rad == pytest.approx(math.radians(45.0), abs=0.02)
    assert told in result.reply
    assert told in again.reply


def test_a_world_file_may_leave_the_heading_out(tmp_path: Path) -> None:
    file = tmp_path / "yard.yaml"
    file.write_text(
        "places:\n  - {name: gate, aliases: [门], x_m: 1, y_m: 0}\n  - {name: shed, x_m: 1, y_m: 1, yaw_deg: 0}\n",
        encoding="utf-8",
    )
    with chatrobot.connect(fast=True, world=file) as robot:
        assert robot.do("go to the gate and face its heading").outcome == "unclear"
        assert robot.do("去门，朝向它的方向").outcome == "unclear"
        assert robot.do("go to the shed and face its heading").outcome == "completed"
