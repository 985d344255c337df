"""Amounts that are multiples or parts of others, and amounts told twice."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Drive, Turn
from tests.language.dialogue_runner import Conversation


def _step(text: str) -> object:
    plan = Conversation().say(text).plan
    assert plan is not None, text
    assert len(plan.steps) == 1, text
    return plan.steps[0]


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("前进四倍的30公分", 1.2),
        ("前进30公分的四倍", 1.2),
        ("后退一米的三分之二", 2 / 3),
        ("往前走两米的一半", 1.0),
        ("往前走一米的百分之八十", 0.8),
        ("前进20厘米乘以3", 0.6),
        ("前进3乘以20厘米", 0.6),
        ("往前走一米六除以四", 0.4),
        ("前进比一米多二十厘米", 1.2),
        ("前进比一米少二十厘米", 0.8),
        ("往前走三尺，也就是一米", 1.0),
        ("往前走一米（也就是一百厘米）", 1.0),
    ],
)
def test_a_length_may_be_reckoned(text: str, metres: float) -> None:
    step = _step(text)
    assert isinstance(step, Drive)
    assert step.distance_m == pytest.approx(metres)


@pytest.mark.parametrize(
    ("text", "degrees"), [("左转九十度的一半", 45), ("左转30度的三倍", 90), ("左转半圈，也就是180度", 180)]
)
def test_an_angle_may_be_reckoned(text: str, degrees: float) -> None:
    step = _step(text)
    assert isinstance(step, Turn)
    assert math.degrees(step.angle_rad or 0.0) == pytest.approx(degrees)


@pytest.mark.parametrize("text", ["往前走三尺，也就是两米", "左转一圈，也就是90度"])
def test_two_tellings_that_differ_are_asked_about(text: str) -> None:
    assert Conversation().say(text).outcome == "unclear"


def test_a_multiple_of_the_speed_is_no_multiple_of_the_way() -> None:
    step = _step("用两倍的速度前进一米")
    assert isinstance(step, Drive)
    assert step.distance_m == pytest.approx(1.0)
