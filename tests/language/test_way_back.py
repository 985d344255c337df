"""A part of the way back, or all of it, whatever the robot did since it came."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import conversation

SHOP = "this is the shop / forward 2 m / this is the garage / "
LEFT_40 = "; ".join(["drive 0.4 m; turn left 90 deg"] * 4)


def _last(said: str) -> str:
    *before, last = said.split(" / ")
    meant = conversation(*before).say(last)
    return format_plan(meant.plan).replace("\n", "; ") if meant.plan is not None else meant.outcome


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("drive 2 m / turn around / half of the way home again, and no further", "drive 1 m"),
        ("drive 2 m / turn around / come half the way back", "drive 1 m"),
        ("drive 2 m / go back half way", "drive 1 m back"),
        ("走两米 / 掉头 / 回家走一半", "drive 1 m"),
        ("drive 2 m, turn left / go half way back home", "unclear"),  # it lies to a side
        ("turn left 90 / half of that back", "turn right 45 deg"),
        ("forward 1 m / forward 50 cm / go back as far as you've gone altogether", "drive 1.5 m back"),
        ("前进一米 / 停两秒再前进一米 / 刚才一共走了多远，就退多远", "drive 2 m back"),
        ("forward 2 m / drive back to the start in reverse", "drive 2 m back"),
        (
            SHOP + "go from the shop to the garage and back",
            'go to 0 0 named "shop"; go to 2 0 named "garage"; go to 0 0 named "shop"',
        ),
        (
            "drive 3 m slowly, then back 1 m / the same in the other order",
            "drive 1 m back; drive 3 m at 0.15 m/s",
        ),
        ("前进两米 / 倒着回到起点", "drive 2 m back"),
        ("forward 2 m / back to the start", "go to 0 0"),
        ("forward 2 m, turn around, then drive back 1 m", "drive 2 m; turn left 180 deg; drive 1 m"),
        ("turn right 180 degrees and go back half a metre", "turn right 180 deg; drive 0.5 m"),
        ("dreh dich um und fahr einen Meter zurück", "turn left 180 deg; drive 1 m"),
        ("turn around and reverse 1 m", "turn left 180 deg; drive 1 m back"),
        ("forward 1 m / turn left 90 / go back as far as you've gone altogether", "unclear"),
    ],
)
def test_it_ends_where_that_part_of_the_way_ends(said: str, plan: str) -> None:
    assert _last(said) == plan


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("左转三十度，走半米 / 同样的再来一遍，只是这次往右转", "turn right 30 deg; drive 0.5 m"),
        ("drive 1 m at 0.2 m/s / second run: identical distance, double the speed", "drive 1 m at 0.4 m/s"),
        (
            "先 forward 0.8m，speed 给 0.2 m/s / 同样的 distance 再跑一遍，speed double",
            "drive 0.8 m at 0.4 m/s",
        ),
        ("drive 1 m at 0.2 m/s / second run: congruent distance, double the speed", "unclear"),
        ("turn left 90 and go 1 m / I meant turn right ninety. start that over", "unclear"),
    ],
)
def test_what_is_said_of_the_motion_before_is_never_passed_over(said: str, plan: str) -> None:
    assert _last(said) == plan


def test_the_same_speed_is_that_of_the_same_text() -> None:
    assert _last("以0.4米每秒前进2米，右转90度，再以同样的速度前进1米") == (
        "drive 2 m at 0.4 m/s; turn right 90 deg; drive 1 m at 0.4 m/s"
    )


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("square, 60 cm sides, clockwise / same thing but counterclockwise and 40 cm sides", LEFT_40),
        ("Quadrat 60 cm rechtsherum / dasselbe linksherum mit 40 cm", LEFT_40),
        (
            "circle radius 50 cm to the left / same but to the right and radius 1 m",
            "arc right 360 deg radius 1 m",
        ),
        ("turn left 90, forward 1 m / same but right and 50 cm", "turn right 90 deg; drive 0.5 m"),
        ("左转90度 / 一样的，但是右转45度", "turn right 45 deg"),
        ("forward 1 m / again but longer, 2 m", "drive 2 m"),
        ("左转 / 左转错了是右转", "turn right 180 deg"),
        ("前进三米 / 往回一米 / 再往回一米", "drive 1 m back"),
        ("前进两米再左转 / 所有距离翻倍", "drive 4 m; turn left 90 deg"),
        ("左转九十右转四十五 / 再来一遍左右对调", "turn right 90 deg; turn left 45 deg"),
        ("forward 1 m / again but a bit further", "unclear"),
        ("forward 1 m / the same but further", "unclear"),
    ],
)
def test_a_side_and_a_size_change_the_motion_before_together(said: str, plan: str) -> None:
    assert _last(said) == plan
