"""What changes the motion before: an amount, a side, a step left out, two swapped, the rest of a shape."""

from __future__ import annotations

import pytest

from tests.language.test_likeliest import done

SQUARE = "drive {0} m\nturn {1} 90 deg\n" * 4


def square(side: str, way: str = "left") -> str:
    return SQUARE.format(side, way).strip()


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (["forward 2 m, left 30", "once more with 60 instead of 30"], "drive 2 m\nturn left 60 deg"),
        (
            ["forward 30 cm, left 40 degrees", "again, with all the amounts doubled"],
            "drive 0.6 m\nturn left 80 deg",
        ),
        (["forward 1 m, left 90, back 1 m", "the same without the last step"], "drive 1 m\nturn left 90 deg"),
        (["前进一米，左转90度，后退半米", "再来一遍，去掉第二步"], "drive 1 m\ndrive 0.5 m back"),
        (["back 40 cm", "the same distance again"], "drive 0.4 m back"),
        (["turn left 360 degrees", "and right"], "turn right 360 deg"),
        (["turn left 90", "10 degrees back"], "turn right 10 deg"),
        (
            ["forward 1 m, left 90, forward 1 m", "again but 2 m each"],
            "drive 2 m\nturn left 90 deg\ndrive 2 m",
        ),
        (["forward 1 m, left 90", "again, but turn right instead"], "drive 1 m\nturn right 90 deg"),
        (["forward 1 m", "do it again but only half"], "drive 0.5 m"),
        (
            ["draw a square of 40 cm", "the same but a triangle"],
            ("drive 0.4 m\nturn left 120 deg\n" * 3).strip(),
        ),
        (
            ["draw a square of 1 m", "now a triangle the same way"],
            ("drive 1 m\nturn left 120 deg\n" * 3).strip(),
        ),
        (["forward 2 m", "never mind, go back"], "drive 2 m back"),
        (["forward 80 cm", "same, backwards"], "drive 0.8 m back"),
        (["forward 1 m, right 90", "again, but turn first"], "turn right 90 deg\ndrive 1 m"),
        (["forward 1 m, right 90", "now the same in the opposite order"], "turn right 90 deg\ndrive 1 m"),
        (["forward 1 m, right 90", "now only the first part"], "drive 1 m"),
        (["forward 1 m, right 90", "now only the turn again"], "turn right 90 deg"),
        (["前进一米", "一共要三米"], "drive 2 m"),
        (["turn right 60", "undo that, turn left 30"], "turn left 60 deg\nturn left 30 deg"),
        (["前进八十厘米", "再走二十"], "drive 0.2 m"),
        (["forward a bit", "now back the same amount"], "drive 0.25 m back"),
        (["turn right 45", "the same amount left"], "turn left 45 deg"),
        (["slide right 30 cm", "left 90"], "turn left 90 deg"),
        (["slide right 30 cm", "and 30 left"], "unclear: drive 0.3 m left"),
        (["forward 1 m, left 90", "now the same path mirrored"], "drive 1 m\nturn right 90 deg"),
        (["往左转四十五度", "再往右转同样多"], "turn right 45 deg"),
        (["后退半米", "再退这么多"], "drive 0.5 m back"),
        (["走个三角形，边长六十公分", "换成正方形"], square("0.6")),
        (["draw a circle with radius 1 m", "make the radius half a metre"], "arc left 360 deg radius 0.5 m"),
        (
            ["half a circle to the right, radius 1 m", "the second half, please"],
            "arc right 180 deg radius 1 m",
        ),
        (["turn left 90", "no, the other way"], "turn right 180 deg"),
        (["turn left 30", "turn right by a quarter"], "turn right 90 deg"),
        (["slide left 50 cm", "the same distance in the opposite direction"], "drive 0.5 m right"),
        (["左转60度", "反方向转同样的角度"], "turn right 60 deg"),
        (["slide to the right 2 m", "go half of that distance back"], "drive 1 m left"),
        (["slide right 1 m", "slide back 20 cm"], "drive 0.2 m left"),
        (["向左平移一米", "多了,移回三十公分"], "drive 0.3 m right"),
        (["draw a square of 1 m turning left", "same again, but turning right"], square("1", "right")),
        (["draw a square of 1 m", "the same but with sides of 2 m"], square("2")),
        (["走一个边长一米的正方形", "再来一次，边长半米"], square("0.5")),
        (["curve left 90 degrees, radius 1 m", "again with radius 2 m"], "arc left 90 deg radius 2 m"),
        (["forward 2 m at 0.3 m/s", "again but faster, 0.5 m/s"], "drive 2 m at 0.5 m/s"),
        (["half a circle to the right, radius 1 m", "now finish the circle"], "arc right 180 deg radius 1 m"),
        (["向左走半圆，半径一米", "把圆走完"], "arc left 180 deg radius 1 m"),
        (
            ["forward 1 m, left 90, forward 1 m", "finish the square"],
            "turn left 90 deg\n" + "drive 1 m\nturn left 90 deg\n" * 2,
        ),
        (["forward 2 m, slide left 1 m", "now with the two distances swapped"], "drive 1 m\ndrive 2 m left"),
        (["drive 1 m and turn left 90", "now turn first and then drive"], "turn left 90 deg\ndrive 1 m"),
        (["右移一米", "回到刚才的位置"], "drive 1 m left"),
        (["forward 2 m", "undo that movement"], "drive 2 m back"),
        (["draw a square of 1 m", "three times as big"], square("3")),
        (["draw a square of 1 m", "half the size"], square("0.5")),
        (["走一个边长一米的正方形", "大一倍"], square("2")),
        (["turn right 40 degrees, then back 2 m", "half of that"], "turn right 40 deg\ndrive 1 m back"),
        (["forward 1 m, right 20 degrees", "twice the angle"], "drive 1 m\nturn right 40 deg"),
        (["turn right 40 degrees", "twice as far"], "turn right 80 deg"),
        (["back 1 m, turn right 30 degrees", "once more, mirrored"], "drive 1 m back\nturn left 30 deg"),
        (["forward 2 m, slide right 40 cm", "mirror that"], "drive 2 m\ndrive 0.4 m left"),
        (["draw a square of 1 m", "mirror image"], square("1", "right")),
        (["前进两米，右转30度", "镜像"], "drive 2 m\nturn left 30 deg"),
        (["forward 1 m, left 45", "mirrored to the right"], "drive 1 m\nturn right 45 deg"),
        (["back 2 m", "again but 30 cm further"], "drive 2.3 m back"),
        (["back 2 m", "the same but go 30 cm further"], "drive 2.3 m back"),
        (["turn right 40 degrees", "the same but 5 degrees more"], "turn right 45 deg"),
        (["后退一米", "再来一次，多30厘米"], "drive 1.3 m back"),
        (["forward 1 m", "the same plus 20 cm"], "drive 1.2 m"),
        (
            ["half a circle to the left, radius 1 m", "keep going till the circle is complete"],
            "arc left 180 deg radius 1 m",
        ),
        (["forward 1 m", "the same and 20 cm more"], "drive 1.2 m"),
        (["forward 1 m", "the same minus 20 cm"], "drive 0.8 m"),
        (["forward 1 m", "again but 20 cm shorter"], "drive 0.8 m"),
        (["turn left 45", "the same plus 10 degrees"], "turn left 55 deg"),
        (["前进一米", "一样，加二十厘米"], "drive 1.2 m"),
        (["前进一米", "再来一次，少二十厘米"], "drive 0.8 m"),
        (["back 2 m", "30 cm further"], "drive 0.3 m back"),
    ],
)
def test_the_motion_before_is_changed_as_said(turns: list[str], plan: str) -> None:
    assert done(*turns) == plan.strip()


@pytest.mark.parametrize(
    "turns",
    [
        ["forward 1 m, left 90, forward 2 m", "again with 3 m"],  # which of them?
        ["forward 30 cm", "3 more"],  # centimetres or rounds?
        ["前进八十厘米", "再走二"],
        ["back 40 cm", "back the same distance"],  # once more, or to where it came from?
        ["forward 1 m, slide left 1 m", "and back a metre"],  # to where it came from, or backwards?
        ["turn left 30", "five more"],
        ["forward 1 m", "10 degrees back"],
        ["a rectangle of 1 m by 2 m", "the same but a triangle"],
        ["left 90, right 90", "again but turning left"],  # turned both ways
        ["forward 1 m", "without the second step"],
        ["forward 1 m", "mirror that"],  # nothing was to a side
        ["forward 1 m, left 45", "mirrored to the left"],
        ["forward 1 m, left 45", "turn half of that"],
        ["forward 1 m, left 90, forward 2 m", "the same but 20 cm further"],
        ["forward 1 m", "again, another 20 cm"],
        ["turn left 45", "the same minus 60 degrees"],
        ["forward 1 m", "keep going till the circle is complete"],
        ["curve left with radius 1 m until the circle is done"],  # the rest of what?
        ["forward 1 m, back 2 m", "the same plus 20 cm"],
        ["forward 1 m, left 30, then the same mirrored"],
        ["forward 1 m, then draw a triangle and do that twice"],  # the triangle, or all of it?
        ["forward 1 m, left 45", "finish the square"],
        ["forward 1 m", "once more with 90 instead of 45"],
    ],
)
def test_a_change_that_fits_nothing_or_several_is_asked_about(turns: list[str]) -> None:
    assert done(*turns).partition(":")[0] in ("unclear", "answered")


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (["go forward 2"], "drive 2 m"),
        (["turn left 20"], "turn left 20 deg"),
        (["后退1"], "drive 1 m back"),
        (["forward 50 cm", "back 20"], "drive 0.2 m back"),
        (["drive 50"], "unclear: drive 0.5 m"),
        (["forward 5"], "unclear: drive 5 m"),
        (["前进半"], "unclear"),
        (["turn left 2"], "unclear"),
    ],
)
def test_a_bare_number_has_the_unit_that_makes_sense_or_is_proposed(turns: list[str], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    ("whole", "once", "count"),
    [
        ("draw a square, then a pentagon and do all that three times", "draw a square, then a pentagon", 3),
        ("back 1 m, then draw a triangle and do all of it twice", "back 1 m, then draw a triangle", 2),
        ("先走一个正方形，再走一个三角形，全部做两遍", "先走一个正方形，再走一个三角形", 2),
        ("draw a square, then a triangle, and repeat all that", "draw a square, then a triangle", 2),
    ],
)
def test_all_that_is_the_whole_sentence_with_its_figures(whole: str, once: str, count: int) -> None:
    assert done(whole) == "\n".join([done(once)] * count)


@pytest.mark.parametrize(
    ("turns", "last"),
    [
        (
            ("make a circle with 50 cm radius to the left", "now one to the right"),
            "arc right 360 deg radius 0.5 m",
        ),
        (("画个半径半米的圆，逆时针", "再画一个顺时针的"), "arc right 360 deg radius 0.5 m"),
        (("slide left 40 cm", "and now to the right"), "drive 0.4 m right"),
        (("turn left 30 degrees", "now one to the right"), "turn right 30 deg"),
        (("drive 2 m and turn right 90", "do the first part again"), "drive 2 m"),
        (("forward 60 cm", "turn left 30", "forward 80 cm", "repeat just the second"), "turn left 30 deg"),
        (
            ("forward 60 cm", "turn left 30", "forward 80 cm", "repeat the last two"),
            "turn left 30 deg\ndrive 0.8 m",
        ),
        (("前进一米然后左转九十度", "重复第二步"), "turn left 90 deg"),
        (("前进一米", "左转九十度", "这两步再来一次"), "drive 1 m\nturn left 90 deg"),
        (
            ("0.5 m forward", "turn left 90", "repeat both twice"),
            "\n".join(["drive 0.5 m", "turn left 90 deg"] * 2),
        ),
    ],
)
def test_what_points_at_a_figure_a_side_or_a_step_takes_it_from_before(
    turns: tuple[str, ...], last: str
) -> None:
    assert done(*turns) == last


def test_what_points_at_nothing_is_asked_about() -> None:
    assert done("drive 1 m", "do the second step again") == "unclear"
    assert done("drive 1 m", "what was the first thing I told you?", "Right. Do that one again.") == "unclear"


def test_what_was_meant_is_done_although_it_sounds_like_a_remark() -> None:
    assert done("turn right 90", "oops I meant left") == "turn left 180 deg"
