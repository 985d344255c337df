"""Driving until an obstacle is near, in English: how near is read, or asked about with a proposal."""

from __future__ import annotations

import pytest

from chatrobot.plan.steps import Drive, ObstacleWithin
from chatrobot.plan.text import format_plan
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


@pytest.mark.parametrize(
    "text",
    [
        "fahr, bis etwas 50 cm vor dir ist",
        "fahr vor, bis du 50 cm vor einem Hindernis bist",
        "前进直到前面50厘米有东西",
        "drive until something is 50 cm ahead",
    ],
)
def test_what_the_answer_to_a_condition_names_is_driven(text: str) -> None:
    plan = Conversation().say(text).plan
    assert plan is not None
    assert format_plan(plan) == "drive forward until obstacle within 0.5 m"


@pytest.mark.parametrize(
    "text",
    [
        "if there is something in front of you, turn around",
        "when you see the wall turn left",
        "wenn etwas vor dir ist, dreh dich um",
        "如果前面有东西，就掉头",
    ],
)
def test_a_condition_that_nobody_judges_is_told_as_one(text: str) -> None:
    meant = Conversation().say(text)
    assert (meant.plan, meant.code) == (None, "unknown_part")
    assert "50" in meant.reply
