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
