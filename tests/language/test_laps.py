"""One more lap: of the circle or shape that was driven, and of nothing that was none; parts of a shape in Chinese."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation


def last(*turns: str) -> str:
    """The plan of the last of these turns, in one line; an empty string where nothing moves."""
    talk = conversation(*turns[:-1])
    plan = talk.say(turns[-1]).plan
    return format_plan(plan).replace("\n", "; ").strip("; ") if plan is not None else ""


SQUARE = "drive 0.5 m; turn left 90 deg; " * 4


@pytest.mark.parametrize(
    ("before", "said", "plan"),
    [
        ("往左画个圆，半径六十公分", "再走一圈", "arc left 360 deg radius 0.6 m"),
        ("往左画个圆，半径六十公分", "再来两圈", "arc left 720 deg radius 0.6 m"),
        ("走个正方形，边长半米", "再走一圈", SQUARE.strip("; ")),
        ("走个正方形，边长半米，走两圈", "再来一圈", SQUARE.strip("; ")),
        ("原地左转一圈", "再一圈", "turn left 360 deg"),
        ("前进一米", "再走一圈", ""),
        ("往左拐四分之一圆，半径一米", "再来一圈", ""),
        ("往左画个圆，半径六十公分", "速度放慢一点，再一圈", ""),
    ],
)
def test_one_more_lap_is_one_of_what_was_driven(before: str, said: str, plan: str) -> None:
    assert last(before, said) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("正方形边长半米，先走两条边",), "drive 0.5 m; turn left 90 deg; drive 0.5 m"),
        (("正方形边长半米，先走两条边", "下一条边"), "turn left 90 deg; drive 0.5 m"),
        (
            ("先走正方形的前三个边，边长半米，往右", "最后一条边"),
            "turn right 90 deg; drive 0.5 m; turn right 90 deg",
        ),
        (("正方形边长半米，先走两条边", "第四条边"), ""),
        (("画个圆的四分之一，半径一米，往左", "再画下一个四分之一"), "arc left 90 deg radius 1 m"),
        (("画个圆的四分之一，半径一米，往左", "再画最后四分之一"), ""),
    ],
)
def test_a_shape_is_driven_part_by_part_in_chinese(turns: tuple[str, ...], plan: str) -> None:
    assert last(*turns) == plan
