"""The way to a place that was remembered, or that the world has."""

from __future__ import annotations

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, Place
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Drive, Go
from chatrobot.plan.text import parse_plan
from tests.language.profiles import MECANUM

PLACES = {"home": Place(Pose(1.0, 2.0, 0.0)), "家": Place(Pose(1.0, 2.0, 0.0))}
CONTEXT = Context(Dialogue(places=PLACES), world_places={"kitchen": Pose(3.0, 0.0, 0.0)})


def meant_by(said: str) -> Interpretation:
    return OfflineInterpreter(MECANUM).interpret(said, CONTEXT)


def driven(said: str) -> list[str]:
    """The places that the plan goes to; other steps by their kind."""
    plan = meant_by(said).plan
    assert plan is not None, said
    return [step.place or "start" if isinstance(step, Go) else step.kind for step in plan.steps]


@pytest.mark.parametrize(
    "verb", ["go", "drive", "head", "walk", "come", "go straight", "return", "please get"]
)
def test_back_before_a_place_says_where_to_and_not_which_way(verb: str) -> None:
    back = "" if verb == "return" else "back"
    assert driven(f"{verb} {back} home") == ["home"]
    assert driven(f"{verb} {back} to the kitchen") == ["kitchen"]
    assert driven(f"forward 1 m, then {verb} {back} home") == ["drive", "home"]


@pytest.mark.parametrize("said", ["回家", "回到家", "返回家", "走回家", "退回家", "开回家", "然后回家吧"])
def test_the_way_home_in_chinese(said: str) -> None:
    assert driven(said) == ["家"]


@pytest.mark.parametrize("said", ["reverse back home", "go backwards to the kitchen", "turn back home"])
def test_a_manner_in_which_no_place_is_reached_is_asked_about(said: str) -> None:
    assert meant_by(said).outcome == "unclear"


@pytest.mark.parametrize(
    "said", ["go to the kitchen and back", "go to the kitchen, back", "go to the kitchen, return"]
)
def test_there_and_back_is_two_ways(said: str) -> None:
    assert driven(said) == ["kitchen", "start"]


def test_one_place_after_another_is_two_ways() -> None:
    assert driven("go to the kitchen, back home") == ["kitchen", "home"]
    assert driven("go home, back 1 m") == ["home", "drive"]


def test_back_before_anything_else_is_a_direction() -> None:
    plan = meant_by("back 1 m, then home").plan
    assert plan is not None
    assert isinstance(plan.steps[0], Drive)


@pytest.mark.parametrize(
    "said", ["go to the kichen", "go to the kitchn now", "drive back hoem", "go to hom, then forward 1 m"]
)
def test_a_misspelt_place_is_asked_about_and_never_driven_to(said: str) -> None:
    meant = meant_by(said)
    assert (meant.outcome, meant.code) == ("unclear", "did_you_mean_place")
    assert "kitchen" in meant.reply or "home" in meant.reply


@pytest.mark.parametrize("said", ["go to the chicken", "go to the kettle", "go to the kitten"])
def test_another_word_is_no_misspelt_place(said: str) -> None:
    assert meant_by(said).code != "did_you_mean_place"


def test_the_place_that_is_asked_about_is_offered_as_a_plan() -> None:
    meant = meant_by("forward 1 m, then go to the kichen")
    assert meant.proposal is not None
    steps = parse_plan(meant.proposal.plan_text).steps
    assert [getattr(step, "place", "") for step in steps] == ["", "kitchen"]
    assert meant.proposal.say in meant.reply


@pytest.mark.parametrize("said", ["go to the kichen and wibble", "go to the kichen unless it rains"])
def test_no_place_is_offered_where_a_yes_would_not_be_understood(said: str) -> None:
    assert meant_by(said).proposal is None


def test_a_place_that_is_as_near_as_another_is_not_named() -> None:
    places = {"desk1": Pose(1.0, 0.0, 0.0), "desk2": Pose(2.0, 0.0, 0.0), "docka": Pose(), "dockb": Pose()}
    meant = OfflineInterpreter(MECANUM).interpret("go to dockc", Context(world_places=places))
    assert (meant.outcome, meant.code, meant.proposal) == ("unclear", "where_to", None)


ROOMS = ("kitchen", "sofa", "tv", "front door", "open-plan office", "living room", "前台", "打印机")
HERE = Context(world_places={name: Pose(1.0 + i, 0.0, 0.0) for i, name in enumerate(ROOMS)})


@pytest.mark.parametrize(
    ("said", "places"),
    [
        ("go to the tv, then to the sofa", ["tv", "sofa"]),
        ("go to the living room, then to the kitchen", ["living room", "kitchen"]),
        ("go to the open-plan office", ["open-plan office"]),
        ("go to the open plan office, then to the tv", ["open-plan office", "tv"]),
        ("drive to the front door", ["front door"]),
        ("往前台开", ["前台"]),
        ("从前台去打印机", ["前台", "打印机"]),
    ],
)
def test_a_name_is_whole_and_each_of_them_is_driven_to(said: str, places: list[str]) -> None:
    plan = OfflineInterpreter(MECANUM).interpret(said, HERE).plan
    assert plan is not None
    assert [step.place for step in plan.steps if isinstance(step, Go)] == places
    assert len(plan.steps) == len(places)


@pytest.mark.parametrize(
    "said",
    [
        "you went to the sofa, then to the kitchen",
        "the kitchen is next to the living room",
        "to the living room? no way",
        "你刚才去了前台，然后去了打印机",
        "你去打印机了吗？",
    ],
)
def test_places_in_what_is_told_or_asked_are_not_driven_to(said: str) -> None:
    assert OfflineInterpreter(MECANUM).interpret(said, HERE).plan is None
