"""Metamorphic: say it with another number, unit, side, order or courtesy, and the geometry follows."""

from __future__ import annotations

import itertools
import math

import pytest

from chatrobot.plan.steps import Drive, Turn
from tests.language.dialogue_runner import Conversation

LENGTHS = {
    "one metre": 1.0, "2 m": 2.0, "fifty centimetres": 0.5, "half a meter": 0.5, "two and a half feet": 0.762,
    "1.2 metres": 1.2, "a hundred and twenty cm": 1.2, "three quarters of a metre": 0.75,
    "a yard and a half": 1.3716,
    "1 m 20 cm": 1.2,
}  # fmt: skip
LENGTHS_ZH = {
    "一米": 1.0, "两米": 2.0, "五十厘米": 0.5, "半米": 0.5, "一米二": 1.2, "一百二十公分": 1.2,
    "1.5米": 1.5, "两米半": 2.5,
    "零点八米": 0.8, "三百毫米": 0.3,
}  # fmt: skip
WAYS = {"forward": 0.0, "backward": math.pi, "to the left": math.pi / 2, "to the right": -math.pi / 2}
WAYS_ZH = {"向前走": 0.0, "往后退": math.pi, "往左平移": math.pi / 2, "向右横移": -math.pi / 2}
ANGLES = {
    "90 degrees": 90,
    "forty-five degrees": 45,
    "a quarter turn": 90,
    "pi over three radians": 60,
    "120°": 120,
}
ANGLES_ZH = {"九十度": 90, "四分之一圈": 90, "半圈": 180, "一百二十度": 120, "45°": 45}


def only_step(text: str) -> object:
    plan = Conversation().say(text).plan
    assert plan is not None, text
    assert len(plan.steps) == 1, text
    return plan.steps[0]


def same_angle(a: float, b: float) -> bool:
    return abs(math.remainder(a - b, 2 * math.pi)) < 1e-6


@pytest.mark.parametrize(
    "frame", ["move {way} {length}", "{length} {way}", "could you please go {way} by {length}?"]
)
def test_drives_any_length_any_way(frame: str) -> None:
    for (length, metres), (way, angle) in itertools.product(LENGTHS.items(), WAYS.items()):
        step = only_step(frame.format(length=length, way=way))
        assert isinstance(step, Drive)
        assert step.distance_m == pytest.approx(metres)
        assert same_angle(step.direction_rad, angle)


@pytest.mark.parametrize("frame", ["{way}{length}", "请{way}{length}吧", "麻烦你{way}{length}，谢谢"])
def test_drives_any_length_any_way_in_chinese(frame: str) -> None:
    for (length, metres), (way, angle) in itertools.product(LENGTHS_ZH.items(), WAYS_ZH.items()):
        step = only_step(frame.format(length=length, way=way))
        assert isinstance(step, Drive)
        assert step.distance_m == pytest.approx(metres)
        assert same_angle(step.direction_rad, angle)


@pytest.mark.parametrize(
    ("frame", "left"),
    [
        ("turn left {a}", True),
        ("rotate {a} clockwise", False),
        ("{a} to the right, please", False),
        ("turn {a} ccw", True),
    ],
)
def test_turns_any_angle_to_the_side_that_was_said(frame: str, left: bool) -> None:
    for said, degrees in ANGLES.items():
        step = only_step(frame.format(a=said))
        assert isinstance(step, Turn)
        assert step.left is left
        assert math.degrees(step.angle_rad or 0) == pytest.approx(degrees)


@pytest.mark.parametrize(
    ("frame", "left"), [("左转{a}", True), ("顺时针转{a}", False), ("往右边拐{a}", False)]
)
def test_turns_any_angle_in_chinese(frame: str, left: bool) -> None:
    for said, degrees in ANGLES_ZH.items():
        step = only_step(frame.format(a=said))
        assert isinstance(step, Turn)
        assert step.left is left
        assert math.degrees(step.angle_rad or 0) == pytest.approx(degrees)


@pytest.mark.parametrize("typo", ["trun left", "turn lfet", "tunr left", "turn leftt"])
def test_mends_a_typo_but_never_across_a_side(typo: str) -> None:
    step = only_step(f"{typo} 90 degrees")
    assert isinstance(step, Turn)
    assert step.left


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("go forward 2 m, sorry, I mean 3 m", 3.0),
        ("往前走十厘米，不对，二十厘米", 0.2),
        ("drive 1 m, make that 1.5 m", 1.5),
    ],
)
def test_a_correction_replaces_the_amount(text: str, metres: float) -> None:
    step = only_step(text)
    assert isinstance(step, Drive)
    assert step.distance_m == pytest.approx(metres)
