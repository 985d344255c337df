"""What other strangers said to somebody else, quoted or told, and what they ordered in words of their own."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done


@pytest.mark.parametrize(
    "turns",
    [
        ("forward 3 m", "hmm, actually I only wanted two"),
        ("forward 2 m please", "instead of that go left 2 m"),
        ("Drive 1 m.", "One metre, as ordered."),
        ("Drive 1 m.", "Good, one metre."),
        ("Slide left 40 cm.", "Great, forty centimetres."),
        ("Turn right 30.", "Thirty degrees, just like that."),
        ("Do a square.", "A square, indeed."),
        ("Drive 1 m.", "Really, again?"),
        ("Drive 1 m.", "Start at ten o'clock."),
        ("Right, two minutes, then we're going, kids.",),
        ("Right, one sec.",),
        ("In an hour, go two metres back.",),
        ("Wait on the right.",),
        ("Slide the bolt to the left.",),
        ("Left hand.",),
        ("Two metres apart.",),
        ("Drive 1 m.", "I'd love to go home now."),
        ("There, on the right.",),
        ("Slide 30 cm right.", "Repeat that, you're breaking up."),
        ("Turn left.", "Good, left."),
        ("Go 1 m.", "Do that again and you're grounded, young man!"),
        ("Drive 1 m.", "Spin twice and you'll fall over, kiddo."),
        ("Drive 1 m.", "How tall is your brother?", "Two metres."),
        ("Turn right.", "Which hand do you write with?", "Left."),
        ("What shape is this, kids?", "A figure eight!"),
        ("Left, right, left, right, left!",),
        ("Turn right.", "How many left?", "Five left."),
        ("That's right.", "Right. Right, right."),
        ("Stay back! Get back, all of you!",),
        ("Ready, steady, go!",),
        ("Drive 1 m.", "Again, Daddy, again!"),
        ("Straight ahead, my foot!",),
        ("Robot, stay where you are. Kids, come forward two metres.",),
        ("Robot, one metre forward; everyone else, one metre back.",),
        ("A train goes forward two metres every second.",),
        ("Success means moving forward.",),
        ("Go straight, then left, then left again, you can't miss it, sir.",),
        ("turn right until you have done two thirds of a circle",),
        ("go 4 m forward but pause for 2 seconds once you've done 1 m",),
        ("forward 3 m, and a metre before the end turn left 90",),
        ("back 2 m, the second metre twice as slow",),
        ("advance 3 m then retreat all but 50 cm of it",),
        ("forward 1 m and then back again plus 20 cm",),
        ("forward 2 m and 50 cm further after a one second break",),
        ("forward 1 m, turn right, and before each of them wait 2 s",),
        ("shift 30 cm right and 40 cm forward in one go",),
        ("curve left then curve right, 45 degrees each, one metre radius each",),
        ("真行，让你左转你偏右转。",),
        ("大家跟着我做：左转，右转，好，停。",),
        ("左转。", "等一下，我接个电话。喂，对，往右拐，一直走。"),
        ("向左转，向右转，全班都笑翻了。",),
        ("左转。", "好，左转完成。"),
        ("前进一米。", "嗯，就是往前走一米。"),
        ("前进两米。", "前进两米，搞定。"),
        ("这里叫家。", "前进两米。", "回家吧，爷爷，天黑了。"),
        ("前进一米。", "这里叫我想起了老家。"),
        ("走个来回，单程三米，到头等两秒",),
        ("前进一米", "按这个距离，走个正方形"),
    ],
    ids=lambda turns: turns[-1],
)
def test_it_moves_nothing_without_a_yes(turns: tuple[str, ...]) -> None:
    assert done(*turns) in ("unclear", "answered", "refused")


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go left 2 m", "stay on this course for another 1 m"), "drive 1 m left"),
        (("forward 2 m", "turn around", "continue in this direction for 1 m"), "drive 1 m"),
        (
            ("forward 1 m, wait 3 seconds, left 1 m", "now all that with no waiting"),
            "drive 1 m; drive 1 m left",
        ),
        (("前进三米每隔一米停三秒",), "drive 1 m; wait 3 s; drive 1 m; wait 3 s; drive 1 m"),
        (("Drive 1 m.", "one more metre"), "drive 1 m"),
        (("Drive 1 m.", "another metre please"), "drive 1 m"),
        (("退一米，我往前站一米",), "drive 1 m back"),
        (("我绕着你转一圈，你等着",), "wait 1 s"),
        (("往左移一米，我再往右走一米",), "drive 1 m left"),
        (("往前走，不是往后，一米二",), "drive 1.2 m"),
        (("朝左前方不是右前方走一米",), "drive 1 m toward 45 deg"),
        (("顺时针不是逆时针转半圈",), "turn right 180 deg"),
        (
            ("正方形，不是三角形，边长半米",),
            "; ".join(["drive 0.5 m", "turn left 90 deg"] * 4),
        ),
        (("转左边，别转右边，六十度",), "turn left 60 deg"),
        (("右移三十公分，三十公分吧，谢谢",), "drive 0.3 m right"),
        (("转两圈，对，两圈",), "turn left 720 deg"),
        (("上一组走了五米，你走三米。",), "drive 3 m"),
        (("快下班了，最后一次，后退半米。",), "drive 0.5 m back"),
        (("forward 2 m, before turning right wait 3 seconds",), "drive 2 m; wait 3 s; turn right 90 deg"),
        (("go right 2 m, back to the left half of that",), "drive 2 m right; drive 1 m left"),
        (
            ("u go 1 meter to front and after make 90 degree to left and after 1 meter more",),
            "drive 1 m; turn left 90 deg; drive 1 m",
        ),
        (("strafe right 0.75m (+/- 5 mm is fine)",), "drive 0.75 m right"),
    ],
)
def test_it_is_done_as_it_is_said(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
