"""What points at earlier turns: how often, which way and how far; what may mean two things is asked about."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import Conversation, conversation


def test_two_more_of_those_are_turns_not_degrees() -> None:
    talk = conversation("turn right 30 degrees", "two more of those")
    assert math.degrees(talk.track.turned_rad) == pytest.approx(-90.0)
    assert math.degrees(
        conversation("turn right 30 degrees", "one more of those").track.turned_rad
    ) == pytest.approx(-60.0)


def test_both_again_repeats_both() -> None:
    pose = conversation("forward 1 m", "left 90", "do both again").track.pose
    assert [pose.x_m, pose.y_m] == pytest.approx([1.0, 1.0])


def test_more_without_turning_is_a_length() -> None:
    pose = conversation("forward 30 cm", "and 30 more to the left without turning").track.pose
    assert [pose.x_m, pose.y_m, pose.yaw_rad] == pytest.approx([0.3, 0.3, 0.0])


def test_the_same_to_the_right_is_the_same_length() -> None:
    assert conversation("forward 50 cm", "same to the right").track.pose.y_m == pytest.approx(-0.5)


@pytest.mark.parametrize(
    ("before", "said"),
    [
        ("forward 1 m", "come back a little"),
        ("forward 1 m", "come back part of the way"),
        ("forward 50 cm", "repeat that until you've gone 2 metres in all"),
    ],
)
def test_some_of_it_is_not_all_of_it(before: str, said: str) -> None:
    assert conversation(before).say(said).outcome == "unclear"


@pytest.mark.parametrize(
    ("said", "metres"),
    [
        ("first a metre ahead, second a right turn of 90 degrees, third half a metre ahead", 1.5),
        ("drive forward 1 m rather than 2", 1.0),
        ("go one metre, turn a quarter left, go two metres", 3.0),
    ],
)
def test_ordinals_and_comparisons_are_no_amounts(said: str, metres: float) -> None:
    assert conversation(said).track.path_m == pytest.approx(metres)


def test_to_hold_right_is_asked_about() -> None:
    assert Conversation().say("hold right for 2 seconds").outcome == "unclear"
