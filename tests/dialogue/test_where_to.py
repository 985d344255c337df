"""What is said of an order to go where no place is known: which places are, and what only stands there."""

from __future__ import annotations

import pytest
from tests.dialogue.undo_rig import UndoRig

from chatrobot.core.events import Result
from chatrobot.dialogue.understanding import Understanding
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world


@pytest.fixture(scope="module")
def home() -> Understanding:
    return Understanding(load_profile("wheeltec_mini_mec"), load_world("home"), None)


@pytest.mark.parametrize(
    ("text", "known", "nearest"),
    [
        ("go to the plant", "I know the plant only as something in the way", ": sofa, TV, door,"),
        ("drive to the kitchen counter", "I know the kitchen counter only as", ": kitchen, fridge, table,"),
        ("go to the counter", "I know the kitchen counter only as", ": kitchen, fridge, table,"),
        ("go to the office chair", "I know the office chair only as", ": desk, fridge,"),
        ("去植物那里", "我只知道“植物”挡在那里", "：沙发，电视，"),
        ("fahr zum Bücherregal", "„Bücherregal“ kenne ich nur als etwas", ": Kühlschrank, Schreibtisch,"),
    ],
)
def test_what_only_stands_on_the_map_is_told_with_the_places_nearest_to_it(
    home: Understanding, text: str, known: str, nearest: str
) -> None:
    meant = home.would_mean(text)
    assert (meant.outcome, meant.code, meant.proposal) == ("unclear", "only_in_the_way", None)
    assert known in meant.reply
    assert nearest in meant.reply


@pytest.mark.parametrize(
    ("text", "unknown", "nearest"),
    [
        ("go to the bathroom", "I know no “bathroom”", ": bedroom, "),
        ("drive to the bathroom", "I know no “bathroom”", ": bedroom, "),
        ("back to the bathroom", "I know no “bathroom”", ": bedroom, "),
        ("go to the bathroom and then turn left", "I know no “bathroom”", ": bedroom, "),
        ("去浴室", "“浴室”我不知道", "：卧室，"),
        ("fahr ins Badezimmer", "Ich kenne „Badezimmer“ nicht", ": Schlafzimmer, "),
    ],
)
def test_an_unknown_place_is_asked_about_with_the_places_nearest_in_name(
    home: Understanding, text: str, unknown: str, nearest: str
) -> None:
    meant = home.would_mean(text)
    assert (meant.outcome, meant.code, meant.proposal) == ("unclear", "where_to", None)
    assert unknown in meant.reply
    assert nearest in meant.reply
    assert meant.reply.count("，" if "，" in nearest else ", ") >= 5  # five names, and that there are more


@pytest.mark.parametrize("text", ["turn bathroom", "forward 1 m plant", "face the plant"])
def test_where_no_place_is_expected_no_places_are_named(home: Understanding, text: str) -> None:
    assert home.would_mean(text).code not in ("where_to", "only_in_the_way")


def test_a_place_that_is_near_in_name_is_offered(home: Understanding) -> None:
    assert home.would_mean("go to the kichen").proposal is not None


def test_the_place_alone_answers_where_to_go() -> None:
    rig = UndoRig("home")
    rig.do("go to the bathroom")
    assert rig.do("sofa").outcome == "completed"


def test_without_any_place_it_is_told_how_to_teach_one() -> None:
    assert "remember this place as" in UndoRig("empty").do("go to the bathroom").reply


@pytest.mark.parametrize("text", ["no", "yes", "nope", "no thanks", "nein", "ja", "不", "不用", "好的"])
def test_an_answer_to_nothing_is_told_that_nothing_was_asked(text: str) -> None:
    rig = UndoRig()
    for result in (rig.do(text), rig.do(text)):
        assert result.outcome == "unclear"
        assert result.reply.startswith(("There is nothing to answer", "Es gibt nichts", "没有什么要回答的"))


def test_a_no_right_after_a_motion_is_still_about_that() -> None:
    rig = UndoRig()
    rig.do("turn left 90")
    assert "nothing to answer" not in rig.do("no").reply
    assert rig.do("right").path_m == 0.0
    assert rig.pose.yaw_rad < 0.0


def blocked(rig: UndoRig, name: str, circle: list[float]) -> Result:
    """Put something there, and say to go to the kitchen."""
    rig.session.change_obstacle(add=name, circle=circle)
    rig.live(0.5)
    return rig.do("go to the kitchen")


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("Obstacle 3", "I find no free way there: Obstacle 3 is in the way."),
        ("crate", "I find no free way there: the crate is in the way."),
    ],
)
def test_what_blocks_a_door_is_named(name: str, told: str) -> None:
    result = blocked(UndoRig("home"), name, [2.9, 1.25, 0.35])
    assert (result.outcome, result.reply) == ("refused", told)


def test_what_stands_elsewhere_is_not_named_and_blocks_nothing() -> None:
    assert blocked(UndoRig("home"), "crate", [-1.5, 1.0, 0.1]).outcome == "completed"


def test_a_thing_with_a_number_has_no_article() -> None:
    rig = UndoRig("empty")
    rig.session.change_obstacle(add="Obstacle 1", circle=[1.0, 1.0, 0.2])
    rig.live(0.5)
    reply = rig.do("turn left 90, forward 1 m, turn right 90, forward 2 m").reply
    assert "of Obstacle 1 after 1.62 m" in reply
    assert "1.6 m are free" in reply
