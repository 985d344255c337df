"""A figure eight is one figure of two circles: the side that is named first is where it begins."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation

LEFT_FIRST = "arc left 360 deg radius 0.4 m\narc right 360 deg radius 0.4 m"
RIGHT_FIRST = "arc right 360 deg radius 0.4 m\narc left 360 deg radius 0.4 m"


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        (
            "draw a figure eight, both circles with 40 cm radius, one to the left, the other to the right",
            LEFT_FIRST,
        ),
        ("figure eight, the first circle to the left, the second to the right, radius 40 cm", LEFT_FIRST),
        ("could you do us an eight? radius 40 cm, first the right one, then the left one", RIGHT_FIRST),
        (
            "make a number 8, first the circle for the right, after the circle for the left, radius 40 cm",
            RIGHT_FIRST,
        ),
        (
            "Fahr eine Acht, Radius 40 cm, den ersten Kreis linksherum, den anderen dann rechtsherum.",
            LEFT_FIRST,
        ),
        ("Eine Acht, die erste Schleife nach rechts, die zweite nach links, Radius 40 cm", RIGHT_FIRST),
        ("走个8字，半径40公分，第一个圈往左，第二个圈往右", LEFT_FIRST),
        ("走个八字，先右边一个圈，再左边一个圈，半径40公分", RIGHT_FIRST),
        (
            "a figure eight with a radius of 40 cm to the left, then turn right",
            LEFT_FIRST + "\nturn right 90 deg",
        ),
    ],
)
def test_a_figure_eight_begins_with_the_side_that_is_named_first(text: str, plan: str) -> None:
    done = Conversation().say(text).plan
    assert done is not None
    assert format_plan(done) == plan


def test_a_figure_eight_with_circles_of_two_sizes_is_asked_about() -> None:
    assert Conversation().say("a figure eight, left loop 40 cm radius, right loop 60 cm radius").plan is None
