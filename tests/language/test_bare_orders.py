"""An order that tells no amount is proposed where what was left out beside it may tell one, or whom it is for."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation, conversation


@pytest.mark.parametrize(
    "said",
    [
        "你往左手边看，那是我家",
        "路在脚下，往前走吧朋友们",
        "头往左歪，我给你剪头发",
        "物理题:小车以v=0.4m/s向前匀速行驶t=5s,求路程。。。懒得算了你直接开给我看吧",
        "Show the children what a triangle looks like, all three sides the same, eighty centimetres each.",
        "I've a bet on wi Senga here that ye can birl on the spot. Three times the hale way roon, clockwise, show her.",
    ],
)
def test_it_is_not_done_unasked(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("turn left and forward 1 m", "turn left 90 deg; drive 1 m"),
        ("could you turn right?", "turn right 90 deg"),
        ("forward one meter and then turn right?", "drive 1 m; turn right 90 deg"),
        ("drive left and forward 1 m", "drive 1 m toward 45 deg"),
        ("back! back!", "drive 0.5 m back; drive 0.5 m back"),
        ("forward 3 m. Then undo 1 m of it", "drive 3 m; drive 1 m back"),
        ("take 5 seconds to turn left", "turn left 90 deg at 18 deg/s"),
        ("前进3米，然后撤销1米", "drive 3 m; drive 1 m back"),
        ("前进一米两秒后左转", "drive 1 m; wait 2 s; turn left 90 deg"),
        ("前进一米停一下左转停一下前进一米", "drive 1 m; wait 1 s; turn left 90 deg; wait 1 s; drive 1 m"),
    ],
)
def test_a_side_or_a_back_is_that_of_its_verb(said: str, plan: str) -> None:
    found = Conversation().say(said).plan
    assert found is not None
    assert format_plan(found).replace("\n", "; ") == plan


@pytest.mark.parametrize(
    "said",
    [
        "come here",
        "get out",
        "from now on when I say left I mean slide left",
        "forward 1 m and slide left 1 m, without the slide",
        "forward 1 m then left, actually skip the left",
        "go 50 cm towards A",
        "过来",
        "左移一米不是左转",
        "左转四十五不是九十",
        "左转你就左转",
        "每两秒左转三十度转三次",
        "到头左转",
        "可以走直线吗",
        "这里叫啥",
        "yes, but only 60 cm",
        "go the rest of the way",
    ],
)
def test_what_it_cannot_know_or_leave_out_moves_nothing(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    "said", ["the sun is out. Go forward", "Good boy! Now turn right.", "thanks. turn left", "谢谢，往前走"]
)
def test_a_plain_order_beside_talk_is_done(said: str) -> None:
    assert Conversation().say(said).plan is not None


@pytest.mark.parametrize(
    "said", ["can you drive?", "can you go?", "你能走吗？", "kannst du fahren?", "could you drive?"]
)
def test_a_question_whether_it_can_is_answered(said: str) -> None:
    assert Conversation().say(said).outcome == "answered"


@pytest.mark.parametrize(
    ("said", "outcome"),
    [
        (
            "I am standing 2 metres straight ahead of you. Come towards me and stop 20 cm before me.",
            "unclear",
        ),
        (
            "five metres up, do a one-eighty, and roll the same five metres down to where you started",
            "unclear",
        ),
        ("zurück nach A", "unclear"),
        ("could you please pirouettify us five metres, slowly at 0.2 m/s?", "unclear"),
    ],
)
def test_what_is_not_accounted_for_is_asked_about(said: str, outcome: str) -> None:
    assert Conversation().say(said).outcome == outcome


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
        ("turn left 90 and forward 1 m / undo the drive", 0),
        ("go forward 1 m / go forward 2 m / undo the second one", 0),
        ("slide left 30 cm, turn right 30, slide left 30 cm / again but with the turn the other way", 0),
        ("forward 1 m / the same to the left and to the right", 0),
        ("forward 2 m / left double that / back by the same plus 10 cm", 0),
        ("spin around twice / spin the other way once", 1),
        ("前进3米 / 撤销最后50厘米", 0),
        ("前进一米左转 / 恢复刚才的撤销", 0),
        ("前进一米左转前进两米 / 第一个前进改成后退", 0),
        ("左转九十度 / 转速减半", 0),
        ("画个正方形边长一米 / 把最后一条边撤销", 0),
        ("前进一米左转九十度 / 倒着做一遍", 0),
        ("前进两米 / 右转 / 前进一米 / 回到上一个位置", 0),
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
