"""不对，我是说左边: corrections of the turn before, and steps undone or done again, as Chinese says them."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    ("before", "said", "x_m", "y_m", "yaw_deg"),
    [
        ("右转九十度", "不对，我是说左边", 0, 0, 90),
        ("右转九十度", "错了，应该往左", 0, 0, 90),
        ("右转九十度", "搞错了，本来应该朝左四十五度的，你给改过来", 0, 0, 45),
        ("右转九十度", "转反了", 0, 0, 90),
        ("前进一米", "方向反了", -1, 0, 0),
        ("前进一米", "不对，是后退", -1, 0, 0),
        ("前进一米", "说错了，是往左平移半米", 0, 0.5, 0),
        ("前进一米", "不，后退半米", -0.5, 0, 0),
        ("前进一米", "不对，五十厘米", 0.5, 0, 0),
        ("turn left 90 degrees", "no, I meant right", 0, 0, -90),
        ("turn left 90 degrees", "no, right", 0, 0, -90),
        ("slide left 1 m", "no no, I meant to the right", 0, -1, 0),
    ],
)
def test_a_correction_replaces_the_turn_before(
    before: str, said: str, x_m: float, y_m: float, yaw_deg: float
) -> None:
    talk = Conversation()
    talk.say(before)
    assert talk.say(said).plan is not None
    assert talk.track.pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert talk.track.pose.y_m == pytest.approx(y_m, abs=1e-6)
    assert math.degrees(talk.track.pose.yaw_rad) == pytest.approx(yaw_deg, abs=1e-6)


@pytest.mark.parametrize("said", ["不对，再左转三十度", "不对，再往左转三十度"])
def test_what_goes_on_from_here_undoes_nothing(said: str) -> None:
    talk = Conversation()
    talk.say("左转六十度")
    talk.say(said)
    assert math.degrees(talk.track.pose.yaw_rad) == pytest.approx(90, abs=1e-6)


def test_asks_which_part_of_several_was_wrong() -> None:
    talk = Conversation()
    talk.say("前进一米，右转九十度")
    assert talk.say("转反了").outcome == "unclear"


def test_a_correction_of_nothing_is_a_command() -> None:
    meant = Conversation().say("不对，右转九十度")
    assert meant.plan is not None
    assert len(meant.plan.steps) == 1


@pytest.mark.parametrize("said", ["不对", "错了", "转反了"])
def test_a_correction_without_what_is_right_moves_nothing_at_first(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    "turns",
    [
        ("前进一米，左转九十度", "撤销刚才两步"),
        ("前进一米", "左转九十度", "撤销刚才两步"),
        ("前进一米", "左转九十度", "右移半米", "把刚才那三步都撤销"),
        ("前进一米", "左转九十度", "把上一步取消", "撤销"),
    ],
)
def test_as_many_steps_are_undone_as_are_said(turns: tuple[str, ...]) -> None:
    talk = Conversation()
    for said in turns:
        talk.say(said)
    pose = talk.track.pose
    assert (pose.x_m, pose.y_m, pose.yaw_rad) == pytest.approx((0, 0, 0), abs=1e-6)


def test_asks_whether_two_steps_are_two_turns() -> None:
    talk = Conversation()
    talk.say("前进一米")
    talk.say("左转九十度，后退半米")
    assert talk.say("撤销刚才两步").outcome == "unclear"


@pytest.mark.parametrize("turns", [("前进一米，左转90度",), ("前进一米", "左转90度")])
def test_the_last_two_steps_are_done_once_more(turns: tuple[str, ...]) -> None:
    talk = Conversation()
    for said in (*turns, "刚才两步再做一遍"):
        talk.say(said)
    pose = talk.track.pose
    assert (pose.x_m, pose.y_m) == pytest.approx((1, 1), abs=1e-6)
    assert abs(math.degrees(pose.yaw_rad)) == pytest.approx(180, abs=1e-6)
