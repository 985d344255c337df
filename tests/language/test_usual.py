"""What a person sets once holds where nothing is said; what is said all the same counts."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation


def done(*turns: str) -> str:
    meant = conversation(*turns[:-1]).say(turns[-1])
    return "; ".join(format_plan(meant.plan).splitlines()) if meant.plan else meant.outcome


@pytest.mark.parametrize(
    ("setting", "order", "plan"),
    [
        ("if I don't say how far, always go 25 cm", "forward", "drive 0.25 m"),
        ("go 30 cm whenever I don't give a distance", "back", "drive 0.3 m back"),
        ("set the default distance to 1 m", "forward", "drive 1 m"),
        ("if I don't say how many degrees, turn 45, ok?", "turn right", "turn right 45 deg"),
        ("a turn without an angle is 30 degrees", "turn left", "turn left 30 deg"),
        ("whenever you turn, do it at 30 degrees per second", "90 right", "turn right 90 deg at 30 deg/s"),
        ("以后没说距离就走20厘米", "前进", "drive 0.2 m"),
        ("没说角度的转弯，以后一律按45度来", "左转", "turn left 45 deg"),
    ],
)
def test_what_is_set_holds_from_then_on(setting: str, order: str, plan: str) -> None:
    assert done(setting) == "answered"
    assert done(setting, "forward 1 m", order) == plan


def test_an_amount_that_is_said_counts_all_the_same() -> None:
    assert done("if I don't say how far, go 25 cm", "forward 1 m") == "drive 1 m"


@pytest.mark.parametrize(
    "text",
    [
        "if I don't say how far it is, don't go",
        "when I don't say how far, wait",
        "if I don't say how far, go faster",
    ],
)
def test_what_sets_no_length_moves_nothing(text: str) -> None:
    assert done(text) == "unclear"


@pytest.mark.parametrize(
    ("taught", "changed", "word", "plan"),
    [
        ("when I say boo you drive back 1 m", "no wait make it half a metre", "boo", "drive 0.5 m back"),
        ("when I say boo you drive back 1 m", "I meant forward", "boo", "drive 1 m"),
        (
            "when I say boo, turn left and drive 1 m",
            "sorry, make the drive 2 m",
            "boo",
            "turn left 90 deg; drive 2 m",
        ),
        ("when I say boo you drive back 1 m", "no, turn left", "boo", "turn left 90 deg"),
        ("wenn ich hopp sage, fahr 1 m vor", "nein, 2 m", "hopp", "drive 2 m"),
    ],
)
def test_a_word_just_taught_is_corrected_and_nothing_moves(
    taught: str, changed: str, word: str, plan: str
) -> None:
    assert done(taught, changed) == "answered"
    assert done(taught, changed, word) == plan


@pytest.mark.parametrize(
    "text", ["one robot step is 30 cm, ok?", "a hop is 30 cm forward", "a step is 30 cm, got it?"]
)
def test_a_step_that_is_told_moves_nothing(text: str) -> None:
    assert done(text) == "answered"


def test_a_german_word_is_taught_as_it_is_written() -> None:
    meant = conversation().say("wenn ich hopp sage, fahr 1 m vor")
    assert [*meant.define] == ["hopp"]
    assert "„hopp“" in meant.reply


@pytest.mark.parametrize(
    ("taught", "order", "plan"),
    [
        ("a lap is a circle to the left with a radius of 1 m", "drive a lap", "arc left 360 deg radius 1 m"),
        ("remember this as grandma", "drive to grandma", 'go to 0 0 named "grandma"'),
    ],
)
def test_what_means_nothing_by_itself_is_done_once_it_was_taught(taught: str, order: str, plan: str) -> None:
    assert done(order) == "unclear"
    assert done(taught, "forward 1 m", order) == plan


def test_a_correction_of_another_kind_of_motion_is_put_right_by_what_it_drove() -> None:
    assert done("turn left 90", "no, I meant forward 1 m", "no, 2 m") == "drive 1 m"


def test_the_usual_speed_is_set_back_by_a_word() -> None:
    assert done("把速度调到每秒0.2米", "恢复默认", "前进一米") in ("drive 1 m", "drive 1 m at 0.3 m/s")
