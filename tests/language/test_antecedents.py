"""What names an earlier motion is read of that motion, and asked about where it names none, or several."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import check_nothing_done, conversation, plan_of


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        # the first of several alike
        (("forward 50 cm", "twice as far", "now go half as far as the first time"), "drive 0.25 m"),
        (
            ("forward 40 cm", "again but double the distance", "again but half of the first one"),
            "drive 0.2 m",
        ),
        (
            ("circle left, radius 60 cm", "the other way", "like the first time"),
            "arc left 360 deg radius 0.6 m",
        ),
        (
            ("绕个圆 半径60cm 往左绕", "往右也绕一个 一样大", "第一个那种再来半圈"),
            "arc left 180 deg radius 0.6 m",
        ),
        # the first of all
        (
            ("slide right 30 cm", "turn left", "now the first thing I asked for, once more"),
            "drive 0.3 m right",
        ),
        (("forward 70 cm", "turn around", "forward the same as at the start"), "drive 0.7 m"),
        # the last of a kind
        (
            ("back up 4 feet", "turn left 60", "forward the same distance as you backed up"),
            "drive 1.2192 m",
        ),
        (
            ("turn left 30", "forward 1 m", "now turn right by the same as you turned left"),
            "turn right 30 deg",
        ),
        (("倒退一米", "左转三十度", "再倒退，跟刚才倒的一样多"), "drive 1 m back"),
        (
            ("drive 40 cm and then turn left", "undo the turn", "now the drive again but only half"),
            "drive 0.2 m",
        ),
        (
            ("drive 40 cm", "turn left 30", "slide right 20 cm", "the turn again, but the other way"),
            "turn right 30 deg",
        ),
        (("倒退一米", "左转三十度，开五十公分", "再倒退，跟头一次倒的一样多"), "drive 1 m back"),
        # an amount that the last motion has not
        (
            ("forward 2.5 m", "turn right", "and now the same distance as in the very first order"),
            "drive 2.5 m",
        ),
        (("drive 1 m", "turn right 45", "twice the distance"), "drive 2 m"),
        (("drive 1 m", "turn right 45", "back the same distance"), "drive 1 m back"),
        (("turn right 30", "drive 50 cm", "turn left by as much as before"), "turn left 30 deg"),
        (("前进一米", "右转45度", "距离翻倍"), "drive 2 m"),
        (("右转30度", "前进50厘米", "转回去同样的角度"), "turn left 30 deg"),
        # a step by its number
        (
            (
                "第一步前进一米，第二步左转六十度，第三步前进五十厘米",
                "第三步再执行一次",
                "第二步反方向执行一次",
            ),
            "turn right 60 deg",
        ),
        (("前进七十厘米", "右转三十度", "像第一步那样再走一次，距离翻倍"), "drive 1.4 m"),
        # what was repeated, once
        (
            ("drive back and forth 3 times, always 1 m", "again but only twice"),
            "drive 1 m\ndrive 1 m back\ndrive 1 m\ndrive 1 m back",
        ),
        (("往前开一米再倒回来，来三遍", "再来两遍"), "drive 1 m\ndrive 1 m back\ndrive 1 m\ndrive 1 m back"),
    ],
)
def test_an_earlier_motion_that_is_named_is_the_one_that_is_meant(turns: tuple[str, ...], plan: str) -> None:
    assert plan_of(*turns) == plan


@pytest.mark.parametrize(
    "turns",
    [
        # another drive lies before the turn: which of them was first?
        ("forward 2 m", "turn left", "forward 50 cm", "twice as far", "half as far as the first time"),
        ("forward 1 m", "turn right as much as you turned left"),
        ("前进一米", "第二步反方向执行一次"),
    ],
)
def test_a_motion_that_cannot_be_told_is_asked_about(turns: tuple[str, ...]) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is None
    assert meant.outcome == "unclear"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("turn left 90 and go 1 m", "undo the drive"), "drive 1 m back"),
        (
            ("turn left 90 and go 1 m", "slide right 50 cm", "undo the slide", "undo the drive"),
            "drive 1 m back",
        ),
        (("drive 1 m, then turn left", "undo the turn"), "turn right 90 deg"),
        (("forward 1 m, right, forward 2 m", "oops, the last bit was meant to be 1 m"), "drive 1 m back"),
        (("前进一米，右转九十度", "错了，是二十度"), "turn left 70 deg"),
        (("turn left 60, then 40 cm forward", "should have been 60 cm"), "drive 0.2 m"),
        (("请左转九十度，然后往前走四十厘米", "应该是六十厘米"), "drive 0.2 m"),
        (("forward 1.5 m", "turn left 30", "undo that", "half the distance back"), "drive 0.75 m back"),
        (("drive 1 m", "turn right 45", "again the same distance"), "drive 1 m"),
        (("forward 3 feet", "the same, but twice, and make it 6 feet"), "drive 1.8288 m\ndrive 1.8288 m"),
        (("slide right 80 cm", "slide right 40 cm", "slide left, back to the start"), "drive 1.2 m left"),
        (
            ("slide left 1 m", "no, I mean, undo that and turn left instead"),
            "drive 1 m right\nturn left 90 deg",
        ),
        (
            ("turn right 30", "Right, all done, sorry about that. Could you turn left thirty degrees now?"),
            "turn left 30 deg",
        ),
    ],
)
def test_a_part_or_another_measure_of_what_was_done(turns: tuple[str, ...], plan: str) -> None:
    assert plan_of(*turns) == plan


@pytest.mark.parametrize(
    "text",
    [
        "Go ahead a metre and, no, hang on, there's a cable lying there. Don't move.",
        "now turn left and, no, don't bother, stop as you are",
        "往前走两米，啊不不，先不要走，对不起",
        "往前走两米，啊等等别走，我的乐高在地上",
        "fahre einen Meter nach vorn, nein, halt, lass es vorerst bleiben",
        "drive 1 m, but wait",
    ],
)
def test_an_order_that_is_taken_back_in_one_breath_moves_nothing(text: str) -> None:
    check_nothing_done(text)


def test_what_was_taken_back_is_said_so_where_its_order_was_read_or_not() -> None:
    for text in ("slide left 20 cm, oh no, leave it", "drive 1 m, no wait, don't move"):
        assert "forgotten" in conversation().say(text).reply


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("drive 2 m and then turn left, no, skip the turn", "drive 2 m"),
        ("左转，不是左，是右", "turn right 90 deg"),
        ("do a full circle to the left", "arc left 360 deg radius 0.5 m"),
        ("turn a full circle to the left", "turn left 360 deg"),
    ],
)
def test_what_is_left_of_an_order_is_done(text: str, plan: str) -> None:
    assert plan_of(text) == plan


def test_approval_repeats_nothing() -> None:
    check_nothing_done("dreh dich 30 Grad nach links", "Genau so, nu.")
