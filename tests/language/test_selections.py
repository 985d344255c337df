"""A part of what was done is done again by its number or its kind; what is no such part is asked about."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation

THREE = "go forward 1 m, turn left 90 degrees, go forward 2 m"
THREE_ZH = "前进一米，左转九十度，再前进两米"


def done(*turns: str) -> str:
    meant = conversation(*turns[:-1]).say(turns[-1])
    return "; ".join(format_plan(meant.plan).splitlines()) if meant.plan else meant.outcome


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        ((THREE, "repeat the last step"), "drive 2 m"),
        ((THREE, "do the second step again"), "turn left 90 deg"),
        ((THREE, "please repeat the last two steps"), "turn left 90 deg; drive 2 m"),
        ((THREE, "repeat the second to last step"), "turn left 90 deg"),
        ((THREE, "first leg again"), "drive 1 m"),
        ((THREE, "repeat step 2"), "turn left 90 deg"),
        ((THREE, "repeat the turn"), "turn left 90 deg"),
        ((THREE, "hmm, do just the first part again, twice"), "drive 1 m; drive 1 m"),
        ((THREE, "do the last two again"), "turn left 90 deg; drive 2 m"),
        (("go forward 1 m, turn left 90 degrees", "repeat the two steps"), "drive 1 m; turn left 90 deg"),
        ((THREE, "repeat the 2nd step"), "turn left 90 deg"),
        ((THREE_ZH, "重复前一步"), "drive 2 m"),
        ((THREE_ZH, "重复最后一步"), "drive 2 m"),
        ((THREE_ZH, "第二步再做一遍"), "turn left 90 deg"),
        ((THREE_ZH, "前两步再来一遍"), "drive 1 m; turn left 90 deg"),
        (("go forward 1 m", "turn left 90 degrees", "go back 50 cm", "repeat the second step"), "turn left 90 deg"),
        (("go forward 1 m", "turn left 90 degrees", "do the first command again"), "drive 1 m"),
    ],
)  # fmt: skip
def test_a_part_of_what_was_done_is_done_again(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    "text",
    [
        "do the fifth step again", "do the first step again and then the last", "第五步再做一遍",
        "repeat the two steps", "重复这两步",
    ],
)  # fmt: skip
def test_what_is_no_part_that_was_done_is_asked_about(text: str) -> None:
    assert done(THREE if text.isascii() else THREE_ZH, text) == "unclear"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go forward 2 m", "turn around and do the same"), "turn left 180 deg; drive 2 m"),
        (("go forward 2 m", "now turn right and do that again"), "turn right 90 deg; drive 2 m"),
        (("go forward 2 m", "turn left 45 degrees and repeat"), "turn left 45 deg; turn left 45 deg"),
    ],
)
def test_the_same_after_a_motion_of_its_own_is_the_motion_before(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


def test_the_same_after_a_correction_is_asked_about() -> None:
    assert done("go forward 1 m", "no, I meant 2 m", "turn around and do the same") == "unclear"


@pytest.mark.parametrize("count", ["1e999", "1000000000"])
@pytest.mark.parametrize(
    "text", ["repeat the last step", "do the turn again", "repeat both", "again", "undo"]
)
def test_more_times_than_a_plan_holds_are_asked_about(text: str, count: str) -> None:
    assert done("go forward 1 m", "turn left 90 degrees", f"{text} {count} times") == "unclear"
    assert done(THREE, f"{text} {count} times") == "unclear"


@pytest.mark.parametrize(
    ("before", "text"),
    [("drive a triangle with 1 m sides", "now with 50 cm"), ("走一个边长一米的三角形", "现在用五十厘米")],
)
def test_another_length_with_a_shape_is_its_side(before: str, text: str) -> None:
    assert done(before, text).count("drive 0.5 m") == 3


def test_another_length_after_sides_of_two_lengths_is_asked_about() -> None:
    assert done("drive a rectangle of 1 m by 2 m", "now with 30 cm") == "unclear"


LIST = "turn left 90, forward 20 cm, slide right 30 cm"
REST = "turn left 90 deg; drive 0.2 m"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        ((LIST, "again, but skip the slide"), REST),
        ((LIST, "again, skip the left"), "drive 0.2 m; drive 0.3 m right"),
        ((LIST, "without the turn"), "drive 0.2 m; drive 0.3 m right"),
        (("前进半米，右转九十度", "去掉右转再来一遍"), "drive 0.5 m"),
        (("左转九十度，前进半米，右转45度", "除了最后一步都做一遍"), "turn left 90 deg; drive 0.5 m"),
        (("左转九十度，前进半米，右转45度", "不要右转，再来一次"), "turn left 90 deg; drive 0.5 m"),
        (("前进半米，左转30度", "顺序反过来再做一遍"), "turn left 30 deg; drive 0.5 m"),
    ],
)
def test_a_part_that_is_named_by_its_way_is_left_out(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    "turns",
    [
        (LIST, "add 20 cm to the first step"),
        (LIST, "again, but sideways"),
        (LIST, "now the same but opposite"),
        ("前进一米，左转九十度，后退半米", "最后一步反过来"),
        ("左转九十度 前进一米 右转九十度 前进一米", "把前两步对调"),
        ("左转三十度，前进半米", "倒着来一遍"),
        ("画圆 半径五十公分 往右", "换个方向再来一个小一点的"),
    ],
)
def test_what_may_change_a_motion_is_not_passed_over(turns: tuple[str, ...]) -> None:
    assert done(*turns) == "unclear"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("when I say hop go forward 10 cm", "hop slowly"), "drive 0.1 m at 0.15 m/s"),
        (("when I say hop go forward 10 cm", "hop twice as far"), "drive 0.2 m"),
        (("when I say hop go forward 10 cm", "hop backwards"), "drive 0.1 m back"),
        (("when I say boo go back 10 cm", "boo now means back 20 cm", "boo"), "drive 0.2 m back"),
        (("hop is forward 10 cm", "hop"), "drive 0.1 m"),
        (("remember this spot as A", "half a metre forward", "go to A"), 'go to 0 0 named "a"'),
    ],
)
def test_a_taught_word_is_done_as_it_is_said(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("turn right 45", "turn 30", "the same way"), "turn right 30 deg"),
        (("turn right 45", "turn 20", "the other way"), "turn left 20 deg"),
        (("go forward 1 m", "and now back"), "drive 1 m back"),
        (("draw a circle with a radius of 50 cm", "to the right"), "arc right 360 deg radius 0.5 m"),
        (("go forward one metre but stop halfway",), "drive 0.5 m"),
        (("往前走一米，走到一半停下来",), "drive 0.5 m"),
        (("slide left 1 m", "no, I meant right", "no wait, I meant left but 50 cm"), "drive 1.5 m left"),
        (("往前开一米", "不是一米，是一米二"), "drive 0.2 m"),
        (("前进一米，右转九十度", "错了，是右转三十度"), "turn left 60 deg"),
        (("forward 50 cm then turn left", "no, I meant right 90"), "turn right 180 deg"),
        (("slide left 30 cm", "now to the right but 60"), "unclear"),
        (("fahr 1 m vor", "nicht 1 m, sondern 1,2 m"), "drive 0.2 m"),
        (("slide right 50 cm", "slide right 0.25", "-0.25"), "unclear"),
    ],
)
def test_an_answer_or_a_correction_is_read_beside_what_it_is_about(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
