"""What points at the motion before, or at the way back, takes no more than it names, and changes what it says."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import Conversation, conversation
from tests.language.test_usual import done

SHOP = "this is the shop / forward 2 m / this is the garage / "
RIGHT_TRIANGLE = "; ".join(["drive 1 m; turn right 120 deg"] * 3)
LEFT_40 = "; ".join(["drive 0.4 m; turn left 90 deg"] * 4)


def _last(said: str) -> str:
    return done(*said.split(" / "))


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
        ("2 m forward, about turn, 2 m back", "drive 2 m; turn left 180 deg; drive 2 m"),
        ("forward 50 cm / go back so it's only 15 cm from where you stood", "drive 0.35 m back"),
        ("turn 30 right / now go 1 meter in this direction that you are looking", "drive 1 m"),
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
        ("triangle with 1 m sides / the whole triangle but to the right", RIGHT_TRIANGLE),
        ("走个三角形边长1米 / 整个三角形，但是向右", RIGHT_TRIANGLE),
        ("前进三米 / 往回一米 / 再往回一米", "drive 1 m back"),
        ("前进两米再左转 / 所有距离翻倍", "drive 4 m; turn left 90 deg"),
        ("左转九十右转四十五 / 再来一遍左右对调", "turn right 90 deg; turn left 45 deg"),
        ("forward 1 m / again but a bit further", "unclear"),
        ("forward 1 m / the same but further", "unclear"),
    ],
)
def test_a_side_and_a_size_change_the_motion_before_together(said: str, plan: str) -> None:
    assert _last(said) == plan


@pytest.mark.parametrize(
    ("said", "steps"),
    [
        ("drive 1 m at 0.2 m/s / back 1 m / now the same move forward again at double the speed", 0),
        ("forward 1 m, left 90, forward 0.5 m / do the last step once more", 1),
        ("2 m vor, links 90 grad, 1 m vor / mach den letzten Schritt nochmal", 1),
        ("turn left 90 / Fahren Sie dieselbe Strecke rückwärts wieder zurück.", 0),
        (
            "arc left 90 deg radius 1 m / drive 1 m back / the first move once more, but only half the angle",
            1,
        ),
        ("前进1m，左转60°，再前进0.5m / 从当前位姿再跑一遍，第二步改成右转60°", 3),
        ("drive 2 m at 0.2 m/s / That was rather slow. Even I am quicker, and I have a stick.", 0),
        ("strafe right 40 cm / And same amount diagonally also, front-left at 45 deg", 0),
        ("turn left 90 and forward 1 m / undo the drive", 1),
        ("go forward 1 m / go forward 2 m / undo the second one", 0),
        ("slide left 30 cm, turn right 30, slide left 30 cm / again but with the turn the other way", 0),
        ("forward 1 m / the same to the left and to the right", 0),
        ("forward 2 m / left double that / back by the same plus 10 cm", 0),
        ("spin around twice / spin the other way once", 1),
        ("前进3米 / 撤销最后50厘米", 0),
        ("前进一米左转 / 恢复刚才的撤销", 0),
        ("前进一米左转前进两米 / 第一个前进改成后退", 0),
        ("左转九十度 / 转速减半", 0),
        ("前进一米左转九十度前进两米 / 再来一遍第三步慢一点", 0),
        ("画个正方形边长一米 / 把最后一条边撤销", 0),
        ("前进一米左转九十度 / 倒着做一遍", 0),
        ("前进两米 / 右转 / 前进一米 / 回到上一个位置", 1),
        (
            "this is the shop / forward 2 m / this is the garage / go from the shop to the garage and back twice",
            0,
        ),
        ("square 50 cm, stopping 1 second at each corner / again without stopping", 8),
        ("zap means turn left 90 and forward 20 cm / zap but right", 2),
        ("drive 1 m / drive 0.5 m back / Genau so, danke schön, da freut sich der Herr Krause.", 0),
        ("umdrehen / zwei Meter vor / Jetzt bitte wieder dahin, wo Sie ganz am Anfang gestanden sind.", 1),
    ],
)
def test_a_reference_takes_no_more_than_it_names(said: str, steps: int) -> None:
    *before, last = said.split(" / ")
    plan = conversation(*before).say(last).plan
    assert (len(plan.steps) if plan is not None else 0) == steps


def test_half_the_angle_of_a_curve_keeps_its_radius() -> None:
    plan = conversation("arc left 90 deg radius 1 m").say("once more, but only half the angle").plan
    assert plan is not None
    assert plan.steps[0] == Conversation().say("arc left 45 deg radius 1 m").plan.steps[0]  # type: ignore[union-attr]
