"""A name of what is driven, before the moves that it is made of, orders nothing of its own."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import Conversation
from tests.language.test_usual import done

ZIGZAG = "turn left 45 deg; drive 0.5 m; turn right 90 deg; drive 0.5 m"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("zigzag please! turn 45 left, half a metre, then 90 right, half a metre", ZIGZAG),
        ("a zigzag: 45 degrees left, 0.5 m, 90 degrees right, 0.5 m", ZIGZAG),
        ("Zickzack: 45 Grad links, 0,5 m, dann 90 Grad rechts, 0,5 m", ZIGZAG),
        ("走个之字形：左转45度，前进半米，右转90度，前进半米", ZIGZAG),
        ("do a twirl, two full turns to the right", "turn right 720 deg"),
        ("转个圈，向右两圈", "turn right 720 deg"),
        ("掉个头，向左转180度", "turn left 180 deg"),
        (
            "an S curve: a half circle left of radius 50 cm and then a half circle right of radius 50 cm",
            "arc left 180 deg radius 0.5 m; arc right 180 deg radius 0.5 m",
        ),
        (
            "a figure eight, a circle to the left of 50 cm radius and then one to the right",
            "arc left 360 deg radius 0.5 m; arc right 360 deg radius 0.5 m",
        ),
    ],
)
def test_only_the_moves_behind_the_name_are_driven(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    ("said", "steps"),
    [
        ("a square with 1 m sides, then forward 1 m", 9),  # the name has its own measure
        ("边长一米的正方形，然后前进一米", 9),
        ("spin once, then 90 left", 2),
        ("a zigzag with 45 degree turns and 1 m legs, then turn right 90, and go 1 m", 11),
    ],
)
def test_a_figure_with_a_measure_and_what_comes_then_are_both_driven(said: str, steps: int) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert len(plan.steps) == steps
