"""A motion that a text tells twice, and means once, is proposed once; one that is ordered twice is done twice."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import parse_plan
from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("小家伙,你往前头走个一米二,哎对,就一米二。", "drive 1.2 m"),
        ("往前走三米……不对不对，是两米，走完两米之后右转四十五度", "drive 2 m\nturn right 45 deg"),
        ("沿着半径五十厘米的圆，顺时针走一圈", "arc right 360 deg radius 0.5 m"),
        (
            "make a u-turn like a real car, so a half circle to the right, radius 50 cm",
            "arc right 180 deg radius 0.5 m",
        ),
    ],
)
def test_a_motion_that_is_told_twice_is_proposed_once(text: str, plan: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None
    assert meant.proposal is not None
    assert parse_plan(meant.proposal.plan_text) == parse_plan(plan)


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("go forward 1 m, then forward 1 m again", "drive 1 m\ndrive 1 m"),
        ("往前一米，再往前一米", "drive 1 m\ndrive 1 m"),
        ("half circle left radius 1 m, about face", "arc left 180 deg radius 1 m\nturn left 180 deg"),
        (
            "an arc left 90 degrees radius 1 m, then a quarter turn left",
            "arc left 90 deg radius 1 m\nturn left 90 deg",
        ),
        (
            "drive diagonally forward left 1 m, then 45 degrees left",
            "drive 1 m toward 45 deg\nturn left 45 deg",
        ),
        ("strafe right a metre, then a quarter turn left", "drive 1 m right\nturn left 90 deg"),
    ],
)
def test_a_motion_that_is_ordered_twice_is_done_twice(text: str, plan: str) -> None:
    assert Conversation().say(text).plan == parse_plan(plan)
