"""Driving until an obstacle is near, in English: how near is read, or asked about with a proposal."""

from __future__ import annotations

import pytest

from chatrobot.plan.steps import Drive, ObstacleWithin
from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    ("said", "near_m"),
    [
        ("drive until you are half a metre from the wall", 0.5),
        ("go forward until you're 30 cm away from the table", 0.3),
        ("forward until the wall is 1 m away", 1.0),
    ],
)
def test_a_distance_to_an_obstacle_ends_the_drive(said: str, near_m: float) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert plan.steps == (Drive(until=ObstacleWithin(near_m)),)


@pytest.mark.parametrize(
    "said",
    [
        "go forward until you see a wall",
        "drive until there is an obstacle",
        "drive up to the wall",
        "一直往前走直到看见墙",
    ],
)
def test_without_a_distance_half_a_metre_is_proposed(said: str) -> None:
    meant = Conversation().say(said)
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text == "drive forward until obstacle within 0.5 m"


@pytest.mark.parametrize(
    "said",
    ["did you drive until you were 50 cm from the wall?", "he drives until the wall is 50 cm away",
     "wait until you see a wall", "don't drive until you see a wall"],
)  # fmt: skip
def test_what_only_tells_of_it_moves_nothing(said: str) -> None:
    assert Conversation().say(said).plan is None
