"""Chinese as people say it: amounts in any form, either script, courtesies, sound-alikes, and what must not move."""

from __future__ import annotations

import itertools
import math
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.language.data_files import load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.plan.steps import Drive, Plan, RawTwist, Turn
from tests.language.dialogue_runner import Conversation

LENGTHS = {
    "一米": 1.0, "壹米": 1.0, "1米": 1.0, "1 m": 1.0, "一公尺": 1.0, "100公分": 1.0, "一百厘米": 1.0, "十分米": 1.0,
    "一千毫米": 1.0, "三尺": 1.0, "一米二": 1.2, "1米2": 1.2, "一米二五": 1.25, "1.25米": 1.25, "一米零五": 1.05,
    "两米半": 2.5, "一又二分之一米": 1.5, "三分之一米": 1 / 3, "半米": 0.5, "零点八米": 0.8, "0.8m": 0.8,
    "二十公分": 0.2,
    "三英尺": 0.9144,
}  # fmt: skip
WAYS = {
    "往前走": 0.0, "前进": 0.0, "直走": 0.0, "向前开": 0.0, "后退": math.pi, "往后倒": math.pi, "倒车": math.pi,
    "往左平移": math.pi / 2, "左移": math.pi / 2, "横着往左挪": math.pi / 2, "向右横移": -math.pi / 2,
    "右移": -math.pi / 2,
}  # fmt: skip
SAID = [
    "{way}{length}", "请{way}{length}", "麻烦你{way}{length}，谢谢", "那个，{way}{length}吧", "给我{way}{length}看看",
    "能不能{way}{length}呀", "小车同学，{way}{length}，好吗", "{way}，{length}", "{length}，{way}",
    "唔該{way}{length}啦",
    "我赶时间，{way}{length}", "前面没人，{way}{length}",
]  # fmt: skip
ANGLES = {
    "九十度": 90, "90度": 90, "90°": 90, "一个直角": 90, "四分之一圈": 90, "π/2": 90, "半圈": 180, "一圈半": 540,
    "一百八": 180, "三十度": 30, "两圈": 720, "一圈零九十度": 450, "1.57弧度": 89.95,
}  # fmt: skip
SIDES = {
    "左转": True, "往左转": True, "向左拐": True, "转左": True, "逆时针转": True, "往左手边转": True, "右转": False,
    "往右边拐": False, "转右": False, "顺时针转": False, "車頭往右擺": False,
}  # fmt: skip


def plan_of(text: str) -> Plan | None:
    return Conversation().say(text).plan


def only_step(text: str) -> object:
    plan = plan_of(text)
    assert plan is not None, text
    assert len(plan.steps) == 1, text
    return plan.steps[0]


@pytest.mark.parametrize("frame", SAID)
def test_drives_any_amount_any_way_however_politely(frame: str) -> None:
    """Each frame has every amount and every way, and each amount comes with each way in one of the frames."""
    ways = itertools.islice(itertools.cycle(WAYS.items()), SAID.index(frame), None)
    for (length, metres), (way, angle) in zip(LENGTHS.items(), ways):
        step = only_step(frame.format(length=length, way=way))
        assert isinstance(step, Drive)
        assert step.distance_m == pytest.approx(metres), (frame, length, way)
        assert abs(math.remainder(step.direction_rad - angle, 2 * math.pi)) < 1e-6, (frame, way)


@pytest.mark.parametrize("frame", ["{way}{a}", "请你{way}{a}吧", "原地{way}{a}", "{way}，{a}", "{a}，{way}"])
def test_turns_any_angle_to_the_side_that_was_said(frame: str) -> None:
    for (said, degrees), (way, left) in itertools.product(ANGLES.items(), SIDES.items()):
        step = only_step(frame.format(way=way, a=said))
        assert isinstance(step, Turn)
        assert step.left is left, (frame, way)
        assert math.degrees(step.angle_rad or 0) == pytest.approx(degrees, rel=1e-3), (frame, said)


def traditional(text: str) -> str:
    pairs = str(load_table("zh", "traditional")["pairs"]).split()
    table = {ord(pair[1]): pair[0] for pair in reversed(pairs)}
    return text.translate(table)


def corpus() -> list[dict[str, Any]]:
    path = Path(__file__).parent.parent / "corpus" / "zh.yaml"
    loaded = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert isinstance(loaded, list)
    return loaded


def test_either_script_means_the_same() -> None:
    for item in corpus():
        if "say" in item:
            assert plan_of(traditional(item["say"])) == plan_of(item["say"]), item["say"]


@pytest.mark.parametrize(
    ("heard", "said"),
    [
        ("前近一米", "前进一米"), ("有转九十度", "右转九十度"), ("左砖九十度", "左转九十度"),
        ("向钱走一米", "向前走一米"),
        ("往作平移一米", "往左平移一米"), ("前进五里米", "前进五厘米"), ("左转九是度", "左转九十度"),
        ("前进无秒中", "前进五秒钟"), ("后腿一米", "后退一米"), ("前进一蜜", "前进一米"), ("右转九十肚", "右转九十度"),
    ],
)  # fmt: skip
def test_a_sound_alike_is_what_was_said(heard: str, said: str) -> None:
    assert plan_of(heard) == plan_of(said) is not None


def test_no_sound_alike_reaches_across_to_the_other_side() -> None:
    opposite = {"左": "right", "右": "left", "前": "back", "后": "forward", "退": "forward", "进": "back"}
    for key, meaning in lexicon().guesses.items():
        for character in key:
            wrong = opposite.get(character)
            assert ("dir", wrong) not in meaning, key


@pytest.mark.parametrize(
    ("text", "rate"), [("角速度-0.5，持续2秒", -0.5), ("wz为-0.3，两秒", -0.3), ("角速度0.5，持续2秒", 0.5)]
)
def test_a_sign_is_never_lost(text: str, rate: float) -> None:
    step = only_step(text)
    assert isinstance(step, RawTwist)
    assert step.wz_radps == pytest.approx(rate)


COMMANDS = [
    "前进一米",
    "左转九十度",
    "往右平移半米",
    "后退两秒",
    "先前进一米，再左转九十度",
    "走一个边长一米的正方形",
]
plan_of_plain = cache(plan_of)
STRAY = ["冰箱", "苹果树", "阿巴", "电视机", "三号桌", "沙发", "七喜", "月亮", "隔壁老王"]
CONDITIONS = [
    "如果前面没人就", "要是下雨的话", "除非有人", "等他走了", "万一没电", "当门开的时候", "我喊停为止", "看到墙为止",
]  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(COMMANDS), st.sampled_from(STRAY), st.data())
def test_a_stray_word_never_makes_another_motion(command: str, stray: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(command)))
    plan = plan_of(command[:at] + stray + command[at:])
    assert plan is None or plan == plan_of_plain(command)


@pytest.mark.parametrize("condition", CONDITIONS)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_condition_is_never_passed_over(condition: str, command: str) -> None:
    for text in (f"{condition}{command}", f"{condition}，{command}", f"{command}，{condition}"):
        assert plan_of(text) is None, text


@pytest.mark.parametrize(
    "text",
    [
        "往前走5", "转30", "左转二十还是三十", "往左还是往右", "走到墙边", "往那个方向走一米", "往东走一米",
        "绕着它转一圈",
        "先往前，再……", "往前走到", "左转，那个，就是", "往左右移动一米", "前进一米或者两米", "前面没人就往前走一米",
        "前进负一米", "前进一到两米", "左转一米", "前进九十度", "去那个谁旁边", "往前走，我满意了你就停", "斜着走一米",
        "前进半", "照老样子走一圈", "平移一米", "转个九十度", "再来一次", "回厨房",
    ],
)  # fmt: skip
def test_asks_back_rather_than_guess(text: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None
    assert meant.outcome == "unclear", meant.reply


@pytest.mark.parametrize(
    "text",
    [
        "停停停",
        "唔好郁",
        "停低",
        "快挺下来",
        "先不走了，就待在那儿吧",
        "煞車",
        "别动！",
        "住手",
        "打住",
        "咪郁",
    ],
)
def test_a_stop_is_a_stop_in_any_dialect(text: str) -> None:
    assert Conversation().say(text).outcome == "stop"


@pytest.mark.parametrize(
    ("text", "x_m", "y_m", "turned_deg"),
    [
        ("你现在朝北。先朝东开一米，再朝北开一米，最后车头朝北", 1.0, -1.0, 0),
        ("往前半米再退回来，来回四趟，不许转身", 0, 0, 0),
        ("原地顺时针转一圈歇两秒，转满三圈为止", 0, 0, -1080),
        ("走半米，左转90度，这样来四下", 0, 0, 360),
        ("左转三十度，再做两次", 0, 0, 90),
        ("右转90度，一共右转四回", 0, 0, -360),
        ("先前进再后退，都是一米", 0, 0, 0),
        ("转三圈，两圈顺时针，一圈逆时针", 0, 0, -360),
        ("开慢一点，往前两米", 2.0, 0, 0),
        ("左移右移各二十厘米，来三次", 0, 0, 0),
        ("分五段走完两米，每段停一秒", 2.0, 0, 0),
        ("前进1米→左转90°→前进1米", 1.0, 1.0, 90),
        ("①前进一米②右转90度③后退半米", 1.0, 0.5, -90),
    ],
)
def test_does_what_is_put_in_idioms(text: str, x_m: float, y_m: float, turned_deg: float) -> None:
    talk = Conversation()
    assert talk.say(text).plan is not None
    assert talk.track.pose.x_m == pytest.approx(x_m, abs=1e-6)
    assert talk.track.pose.y_m == pytest.approx(y_m, abs=1e-6)
    assert math.degrees(talk.track.turned_rad) == pytest.approx(turned_deg, abs=1e-6)
