"""Amounts that are told as sums, and by way of a thing that is measured first."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Drive, RawTwist
from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    ("said", "x_m"),
    [
        ("go forward 30 cm times four", 1.2),
        ("forward 3 * 20 cm", 0.6),
        ("drive to the point 3 metres in front of you", 3.0),
        ("go forward point 3 metres", 0.3),
        ("half a metre multiplied by 3, ahead", 1.5),
        ("forward 1.2 m / 2", 0.6),
        ("go back double 30 cm", -0.6),
        ("go forward twice 40 cm", 0.8),
        ("go forward the square root of 4 metres", 2.0),
        ("go forward 3 times the square root of 4 metres", 6.0),
        ("go forward the number of metres you get when you divide six by four", 1.5),
        ("go the number of metres you get when you subtract two from five", 3.0),
        ("my ruler is 30 cm long. go ahead three rulers", 0.9),
        ("go ahead two rulers and back one ruler, my ruler is 30 cm long", 0.3),
        ("you're standing 15 cm too far forward, fix that please", -0.15),
    ],
)
def test_a_sum_is_worked_out(said: str, x_m: float) -> None:
    talk = Conversation()
    talk.say(said)
    assert talk.track.pose.x_m == pytest.approx(x_m)


@pytest.mark.parametrize(
    "said",
    [
        "forward 1 m left 90 times four",  # the angle, or both?
        "forward 1 m left 90 degrees times four",
        "my car is 4 m long, go forward",
        "fwd 1 m / 90 left / 1 m",
        "take the straight line to the point 3 metres in front of you and 4 metres to your left",
        "turn left by the angle in each corner of an equilateral triangle",
    ],
)
def test_an_amount_that_may_belong_elsewhere_is_asked_about(said: str) -> None:
    assert Conversation().say(said).outcome == "unclear"


def test_a_rectangle_is_no_product() -> None:
    plan = Conversation().say("drive a rectangle 3 * 2 m").plan
    assert plan is not None
    assert [s.distance_m for s in plan.steps if isinstance(s, Drive)] == [3.0, 2.0, 3.0, 2.0]


def test_a_twist_may_say_all_of_a_kind_at_once() -> None:
    plan = Conversation().say("all linear zero, angular z -0.8, for 2.5 seconds").plan
    assert plan is not None
    assert plan.steps == (RawTwist(0.0, 0.0, -0.8, 2.5),)


def test_a_twist_that_breaks_off_is_asked_about() -> None:
    assert Conversation().say("Twist(linear=(-0.25, 0, 0), angular=(0, 0,").outcome == "unclear"


def test_half_a_turn_later_the_way_back_lies_ahead() -> None:
    talk = Conversation()
    talk.say("go forward 1.2 m, do a 180, and come back 90 cm")
    assert talk.track.pose.x_m == pytest.approx(0.3)
    assert abs(math.degrees(talk.track.pose.yaw_rad)) == pytest.approx(180.0)
