"""Names that were taught are changed and forgotten; what would be done is told; a simulation is furnished by words."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.context import Context, Dialogue, RobotState, Thing
from chatrobot.language.interpretation import Interpretation, Placement
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.sim.world import World
from tests.language.dialogue_runner import MECANUM, Conversation


def last_of(*turns: str) -> Interpretation:
    conversation = Conversation()
    return [conversation.say(turn) for turn in turns][-1]


@pytest.mark.parametrize(
    ("taught", "changed", "then"),
    [
        ("remember this spot as base camp", "rename base camp to tent", "go to tent"),
        ("remember this spot as base camp", "call base camp tent from now on", "go to tent"),
        ("shuffle means slide left 30 cm", "rename shuffle to hop", "hop"),
        ("记住这里叫营地", "把营地改名为基地", "去基地"),
        ("merk dir diesen Ort als Lager", "benenne Lager in Basis um", "fahr zu Basis"),
    ],
)
def test_a_taught_name_is_changed_and_counts_from_then_on(taught: str, changed: str, then: str) -> None:
    assert last_of(taught, changed, then).plan is not None


@pytest.mark.parametrize(
    ("taught", "forgotten", "then"),
    [
        ("remember this spot as base camp", "forget the place base camp", "go to base camp"),
        ("shuffle means slide left 30 cm", "forget shuffle", "do a shuffle"),
        ("记住这里叫营地", "忘掉营地", "去营地"),
        ("merk dir diesen Ort als Lager", "lösch den Ort Lager", "fahr zum Lager"),
    ],
)
def test_a_forgotten_name_means_nothing_any_more(taught: str, forgotten: str, then: str) -> None:
    assert last_of(taught, forgotten).outcome == "answered"
    assert last_of(taught, forgotten, then).plan is None


def test_a_name_of_the_map_stays_and_no_two_places_get_one_name() -> None:
    context = Context(Dialogue(), RobotState(), {"kitchen": Pose(1.0)}, place_names=(("kitchen",),))
    assert OfflineInterpreter(MECANUM).interpret("forget the kitchen", context).code == "name_of_map"
    one, other = "remember this spot as oak", "remember this spot as elm"
    assert last_of(one, other, "rename oak to elm").code == "name_taken"
    assert last_of(one, "forget it").outcome == "stop"


@pytest.mark.parametrize(
    "text",
    [
        "what would “drive 1 m” do?",
        "what would you do if I said drive 1 m?",
        "如果我说“前进一米”，你会做什么？",
        "Was würde „fahr einen Meter vor“ tun?",
    ],
)
def test_what_a_text_would_do_is_told_and_not_done(text: str) -> None:
    meant = last_of(text)
    assert (meant.outcome, meant.plan) == ("answered", None)
    assert "1" in meant.reply


@pytest.mark.parametrize(
    ("text", "name", "at"),
    [
        ("put a box in front of you", "box", (2.0, 1.0)),
        ("place a chair 50 cm to your left", "chair", (1.0, 1.5)),
        ("在前面两米放一个箱子", "箱子", (3.0, 1.0)),
        ("Stell eine Kiste hinter dich", "Kiste", (0.0, 1.0)),
    ],
)
def test_a_thing_is_put_where_it_is_told_from_the_robot(
    text: str, name: str, at: tuple[float, float]
) -> None:
    context = Context(Dialogue(), RobotState(Pose(1.0, 1.0)))
    assert OfflineInterpreter(MECANUM).interpret(text, context).obstacles == (Placement(name, at),)


def test_on_a_real_robot_nothing_is_put_anywhere() -> None:
    understanding = Understanding(MECANUM, World("bare"), None)
    assert understanding.interpret("put a box in front of you").outcome == "refused"
    understanding.is_simulated = True
    assert understanding.interpret("put a box in front of you").outcome == "answered"
    assert understanding.interpret("take the box away").obstacles == (Placement("box"),)


def taken_away(text: str, *added: str) -> tuple[str, ...]:
    """What a text takes out of a simulation that these were put into, by its name there."""
    things = (Thing(("sofa",), math.hypot), *(Thing((name,), math.hypot, is_added=True) for name in added))
    meant = OfflineInterpreter(MECANUM).interpret(text, Context(things=things))
    assert (meant.outcome, meant.plan) == ("answered", None)
    assert all(thing.at_m is None for thing in meant.obstacles)
    return tuple(thing.name for thing in meant.obstacles)


@pytest.mark.parametrize(
    "text",
    [
        "remove obstacle 3", "take away obstacle number three", "Take obstacle 3 away, please",
        "拿走障碍物3", "把三号障碍物拿走", "Entferne Hindernis 3", "Nimm das Hindernis Nummer 3 weg",
    ],
)  # fmt: skip
@pytest.mark.parametrize("name", ["Obstacle 3", "障碍物3", "Hindernis 3"])
def test_an_obstacle_is_taken_away_by_its_number(text: str, name: str) -> None:
    assert taken_away(text, "Obstacle 1", name, "Obstacle 13", "box") == (name,)


@pytest.mark.parametrize(
    "text",
    [
        "take all obstacles away", "remove all of the obstacles", "clear the obstacles",
        "把所有障碍物都拿走", "Nimm alle Hindernisse weg",
    ],
)  # fmt: skip
def test_all_that_was_put_there_is_taken_away(text: str) -> None:
    assert taken_away(text, "Obstacle 1", "box") == ("Obstacle 1", "box")
    assert taken_away(text) == ()


@pytest.mark.parametrize(
    ("text", "name"),
    [("remove all boxes", "box"), ("把全部箱子拿走", "箱子"), ("entferne alle Kisten", "Kiste")],
)
def test_all_things_of_a_kind_are_taken_away(text: str, name: str) -> None:
    assert taken_away(text, "Obstacle 1", name, f"{name} 2") == (name, f"{name} 2")


def test_what_nobody_put_there_is_named_as_it_was_said() -> None:
    assert taken_away("remove obstacle 7", "Obstacle 1", "Obstacle 17") == ("obstacle 7",)
    assert taken_away("remove all boxes", "Obstacle 1") == ("box",)
