"""A turn that corrects the one before: it is undone, and what was meant is done instead."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import conversation


@pytest.mark.parametrize(
    ("turns", "x_m", "yaw_deg"),
    [
        (("turn left 90 degrees", "no, I meant right"), 0.0, -90.0),
        (("turn right 40 degrees", "no, the other way, I meant left"), 0.0, 40.0),
        (("turn left 90 degrees", "no, I meant turn right"), 0.0, -90.0),
        (("turn left 90 degrees", "I meant right 45 degrees"), 0.0, -45.0),
        (("go forward 50 cm", "oops, that should have been 70 cm"), 0.7, 0.0),
        (("go forward 1 m", "sorry, I meant backwards"), -1.0, 0.0),
        (("go forward 1 m", "no, I meant back 50 cm"), -0.5, 0.0),
        (("turn left 30 degrees", "no, right"), 0.0, -30.0),
        (("turn left 30 degrees", "sorry, right"), 0.0, -30.0),
        (("turn left 30 degrees", "not left, right!"), 0.0, -30.0),
        (("turn left 30 degrees", "right instead"), 0.0, -30.0),
        (("turn left 45 degrees", "make that 60"), 0.0, 60.0),
        (("go forward 2 m", "make it 3 metres"), 3.0, 0.0),
        (("go forward 2 m", "not that far, only 1 metre"), 1.0, 0.0),
        (("go forward 1 m", "undo that and go back 1 m"), -1.0, 0.0),
    ],
)
def test_the_turn_before_counts_as_if_it_had_been_said_right_at_once(
    turns: tuple[str, ...], x_m: float, yaw_deg: float
) -> None:
    pose = conversation(*turns).track.pose
    assert pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert math.degrees(pose.yaw_rad) == pytest.approx(yaw_deg, abs=1e-6)


def test_the_way_back_and_the_way_meant_are_one_where_they_lie_on_one_line() -> None:
    talk = conversation("go forward 50 cm", "oops, that should have been 70 cm")
    assert talk.track.path_m == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("before", "said"),
    [
        ("go forward 1 m", "no, I meant left"),  # a turn, or sideways?
        ("drive a square", "no, I meant right"),  # which of its eight steps?
        ("turn left 90 degrees", "no, I meant forward"),  # how far?
        ("slide left 30 cm", "no, the other left"),
        ("drive at 0.2 m/s for 3 s", "sorry, 5 s"),
    ],
)
def test_a_correction_that_may_mean_two_things_is_asked_about(before: str, said: str) -> None:
    assert conversation(before).say(said).outcome == "unclear"


def test_undoing_a_correction_takes_back_the_correction() -> None:
    pose = conversation("turn left 90 degrees", "no, I meant right", "undo").track.pose
    assert math.degrees(pose.yaw_rad) == pytest.approx(90.0)


def test_a_correction_of_nothing_is_a_command() -> None:
    assert math.degrees(conversation("I meant right 30 degrees").track.pose.yaw_rad) == pytest.approx(-30.0)
