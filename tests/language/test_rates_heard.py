"""A rate that is told with another preposition, or without one, is how fast the motion beside it is done."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Drive, Step, Turn
from tests.language.dialogue_runner import Conversation


def _only(said: str) -> Step:
    plan = Conversation().say(said).plan
    assert plan is not None
    (step,) = plan.steps
    return step


@pytest.mark.parametrize(
    ("said", "angle_deg", "rate_deg"),
    [
        ("turn right 90 degrees at 30 degrees for second", 90, 30),
        ("turn right 90 degrees, 30 degrees for second", 90, 30),
        ("turn right 90 degrees at 45 degrees by second", 90, 45),
        ("turn right ninety degrees at thirty degrees for second", 90, 30),
        ("rotate left 60 degrees, 20 degrees by second", 60, 20),
        ("左转90度，速度30度一秒", 90, 30),
        ("以30度一秒左转90度", 90, 30),
        ("左转90度，30度一秒", 90, 30),
        ("右转九十度，四十五度一秒", 90, 45),
        ("左转90度，一秒30度", 90, 30),
    ],
)
def test_a_turn_has_one_angle_and_that_rate(said: str, angle_deg: float, rate_deg: float) -> None:
    step = _only(said)
    assert isinstance(step, Turn)
    assert math.degrees(step.angle_rad or 0.0) == pytest.approx(angle_deg)
    assert math.degrees(step.rate_radps or 0.0) == pytest.approx(rate_deg)


@pytest.mark.parametrize(
    "said",
    [
        "go forward 1 m at 0.2 meters for second",
        "go forward 1 m at 0.2 meters by second",
        "go forward 1 m at 0.2 meters a second",
        "go forward 1 m, 0.2 meters each second",
        "forward 1 m, 20 cm for second",
        "forward 1 m at a speed of 0.2 meters for second",
        "前进1米 0.2米一秒",
        "前进一米，速度是20厘米一秒",
        "用二十厘米一秒的速度前进一米",
        "以0.2米一秒前进一米",
        "前进一米，二十厘米一秒",
    ],
)
def test_a_drive_has_one_length_and_that_speed(said: str) -> None:
    step = _only(said)
    assert isinstance(step, Drive)
    assert step.distance_m == pytest.approx(1.0)
    assert step.speed_mps == pytest.approx(0.2)


@pytest.mark.parametrize(
    "said",
    [
        "turn right 90 degrees, 30 degrees",
        "turn left 30 degrees for second",
        "左转90度，30度",
        "左转90度30度",
    ],
)
def test_an_angle_that_is_neither_a_rate_nor_a_turn_of_its_own_is_asked_about(said: str) -> None:
    assert Conversation().say(said).outcome == "unclear"


def test_an_angle_after_then_is_a_turn_of_its_own() -> None:
    plan = Conversation().say("turn right 90 degrees, then 30 degrees").plan
    assert plan is not None
    assert len(plan.steps) == 2
