"""再转一次, 把第一步也再做一遍: what Chinese points at before, beside remarks that change nothing."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import Conversation


def _after(*said: str) -> Conversation:
    talk = Conversation()
    for text in said:
        talk.say(text)
    return talk


@pytest.mark.parametrize(
    ("turns", "x_m", "y_m", "yaw_deg"),
    [
        (("前进1米，右转90度，前进半米", "把第二步再做一遍", "最后把第一步也再做一遍"), 0, -0.5, 180),
        (("前进1米，右转90度，前进半米", "最后再把第一步做一遍"), 1, -1.5, -90),
        (("前进50厘米", "左转90度", "把刚才两步都再来一次，左转换成右转"), 0.5, 0, 90),
        (("左移30厘米", "右转90度", "再做一次平移"), 0.3, 0.3, -90),
        (("slide left 30 cm", "turn right 90", "do the slide again"), 0.3, 0.3, -90),
        (("左转75度", "前进1米", "往右转跟刚才一样的角度"), 0.2588, 0.9659, 0),
        (("turn left 90", "forward 1 m", "turn right by the same angle"), 0, 1, 0),
        (("前进20厘米", "再来一次", "加上刚才的一共做五次"), 1.0, 0, 0),
        (("前进1米", "右转90度", "再加十度"), 1, 0, -100),
        (("往左平移半米", "哈哈哈", "再加二十公分"), 0, 0.7, 0),
    ],
)
def test_leads_to_what_it_points_at(turns: tuple[str, ...], x_m: float, y_m: float, yaw_deg: float) -> None:
    pose = _after(*turns).track.pose
    assert (pose.x_m, pose.y_m) == pytest.approx((x_m, y_m), abs=1e-3)
    off_rad = math.remainder(pose.yaw_rad - math.radians(yaw_deg), 2 * math.pi)
    assert off_rad == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize(
    "turns",
    [
        ("前进1米，等2秒，前进1米", "等待改成4秒"),
        ("前进1米", "再转一次"),
        ("前进1米", "做一次平移"),
        ("前进20厘米", "再来一次", "加上刚才的一共做两次"),
        ("前进1米", "接着走完"),
        ("前进1米", "把它走完"),
        ("这里设为A点", "前进1米", "删除A点", "去A点"),
        ("把这里记成起跑线", "前进2米", "忘掉起跑线", "去起跑线"),
        ("前进60厘米，左转90度，前进60厘米", "把这两步再做一遍，只是左转换成右转"),
    ],
)
def test_asks_where_there_is_none_of_it(turns: tuple[str, ...]) -> None:
    talk = _after(*turns[:-1])
    assert talk.say(turns[-1]).plan is None


@pytest.mark.parametrize("said", ["对，左转", "对，就是左转，我打错字了", "没错，往左", "是左转"])
def test_a_yes_to_what_was_done_repeats_nothing(said: str) -> None:
    talk = _after("左转90度", said, "再前进一米")
    assert math.degrees(talk.track.pose.yaw_rad) == pytest.approx(90, abs=1e-6)
    assert talk.track.pose.y_m == pytest.approx(1, abs=1e-6)


def test_a_yes_answers_a_question_and_a_way_of_its_own_is_done() -> None:
    assert _after("转90度").say("对，左转").plan is not None
    assert _after("右转90度").say("对，左转").plan is not None


def test_a_change_holds_for_each_time() -> None:
    meant = _after("前进1米，等2秒，前进1米").say("再跑两组，等待改成1秒")
    assert meant.plan is not None
    assert [step.kind for step in meant.plan.steps] == ["drive", "wait", "drive"] * 2


@pytest.mark.parametrize(
    ("taught", "said"),
    [
        ("我说苹果就是右转90度，我说香蕉就是左转90度，懂了吗", "香蕉"),
        ("我喊“哥哥”你就右转，我喊“妹妹”你就左转，记住了吗？", "妹妹"),
        ("以后我说“上课”就前进半米，说“下课”就左转90度", "下课"),
        ("不会啊？那我教你，跳舞就是左转30度，左转60度", "好，跳舞！"),
        ("定义例程test1：左转90度", "跑test1"),
    ],
)
def test_several_words_are_taught_at_once(taught: str, said: str) -> None:
    talk = _after(taught, said)
    assert math.degrees(talk.track.pose.yaw_rad) == pytest.approx(90, abs=1e-6)


@pytest.mark.parametrize(
    "named",
    [
        "改主意了，现在站的这儿才是家",
        "这块地方就当家了，记一下，名字叫“家”",
        "这儿呢，叫家，也记牢",
        "还是这儿当家吧",
    ],
)
def test_the_place_is_named_anew(named: str) -> None:
    talk = _after("前进1米", named, "前进1米", "回家")
    assert talk.track.pose.x_m == pytest.approx(1, abs=1e-6)


def test_a_place_of_one_letter_is_a_point_as_well() -> None:
    assert _after("记当前点为A", "前进1米", "去A点").track.pose.x_m == pytest.approx(0, abs=1e-6)
