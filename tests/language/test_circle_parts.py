"""How much of a circle is told, and where its centre is."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Arc
from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    ("said", "degrees", "radius_m", "left"),
    [
        ("full circle clockwise radius 75cm", 360, 0.75, False),
        ("full circle with 75cm radius clockwise", 360, 0.75, False),
        ("complete circle to the right, radius 50 cm", 360, 0.5, False),
        ("half circle to the left radius 75 cm", 180, 0.75, True),
        ("three quarters of a circle to the left with radius 1 m", 270, 1.0, True),
        ("half a circle, centre 0.8 m to the left", 180, 0.8, True),
        ("quarter circle, its centre 0.8 m to the right", 90, 0.8, False),
        ("四分之一个圆 圆心在左侧0.8米处", 90, 0.8, True),
        ("半圆，圆心在左侧0.8米处", 180, 0.8, True),
        ("整圆，圆心在左侧0.8米", 360, 0.8, True),
        ("四分之三个圆，圆心在左侧0.8米处", 270, 0.8, True),
        ("以左侧0.8米处为圆心走半圆", 180, 0.8, True),
        ("以右边半米处为圆心走四分之一圆", 90, 0.5, False),
    ],
)
def test_the_part_of_a_circle_that_is_said_is_driven(
    said: str, degrees: float, radius_m: float, left: bool
) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    (step,) = plan.steps
    assert isinstance(step, Arc)
    assert math.degrees(step.angle_rad) == pytest.approx(degrees)
    assert step.radius_m == pytest.approx(radius_m)
    assert step.left is left
