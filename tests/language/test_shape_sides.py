"""Which way a shape turns, told in a clause after it."""

from __future__ import annotations

import pytest

from chatrobot.plan.steps import Arc, Turn
from tests.language.dialogue_runner import Conversation


def _turns(said: str) -> list[bool]:
    """Whether each turn or arc of what is understood goes left; none where it is asked about."""
    plan = Conversation().say(said).plan
    return [step.left for step in plan.steps if isinstance(step, (Turn, Arc))] if plan else []


@pytest.mark.parametrize(
    ("said", "corners"),
    [
        ("an octagon with one-foot sides, turning right at every corner", 8),
        ("a hexagon, 30 cm sides, turn right", 6),
        ("a square with 50 cm sides. turn right at the corners", 4),
        ("triangle 40 cm a side, turning to the right each time", 3),
        ("pentagon, sides of 40 cm, always turning right", 5),
        ("rectangle 1 m by 2 m, turning clockwise", 4),
        ("circle of radius 1 m, turn right", 1),
        ("我要一个正六边形 边长30厘米 往右拐", 6),
        ("正方形，边长一米，向右转", 4),
        ("画个五边形 每边半米 拐角都往右转", 5),
        ("走个八边形，每边三十厘米，向右拐弯", 8),
        ("长方形，长两米，宽一米，向右拐", 4),
        ("画个圆，半径一米，往右转", 1),
    ],
)
def test_a_turn_without_an_amount_tells_which_way_the_shape_turns(said: str, corners: int) -> None:
    assert _turns(said) == [False] * corners


@pytest.mark.parametrize(
    "said",
    [
        "drive a square of 1 m, then turn right",
        "drive a square of 1 m and then turn right",
        "走一个正方形，边长一米，然后右转",
    ],
)
def test_a_turn_after_then_comes_after_the_shape(said: str) -> None:
    assert _turns(said) == [*[True] * 4, False]


@pytest.mark.parametrize(
    "said",
    [
        "drive a square of 1 m and turn right",
        "drive a square of 1 m. Turn right.",
        "square of 1 m, turn right, forward 2 m",
        "drive a square of 1 m to the left, turning right at each corner",
        "正方形边长一米，右转，前进两米",
    ],
)
def test_a_turn_that_may_be_the_side_or_come_after_the_shape_is_asked_about(said: str) -> None:
    assert Conversation().say(said).outcome == "unclear"


@pytest.mark.parametrize("said", ["forward 1 m, turn left and draw a triangle", "前进一米，左转，画个三角形"])
def test_a_turn_before_a_shape_is_a_turn_of_its_own(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert [type(step).__name__ for step in plan.steps][:3] == ["Drive", "Turn", "Drive"]
    assert len(plan.steps) == 8
