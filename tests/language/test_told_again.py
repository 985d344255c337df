"""What is told once more in other words: a count put right, what a motion comes to, a heading, the frame."""

from __future__ import annotations

import pytest

from tests.language.test_usual import done

EIGHT = "arc left 360 deg radius 0.6 m; arc right 360 deg radius 0.6 m"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("forward 1 m, 3 times, sorry, make it 2", "drive 1 m; drive 1 m"),
        ("forward and back 1 m four times, no, make it one", "drive 1 m; drive 1 m back"),
        ("turn left 90, twice, no, make it 45", "unclear"),
        ("drive 10 s at 0.3 m/s, which makes 3 m", "drive 10 s at 0.3 m/s"),
        ("fahr 10 s mit 0.3 m/s, dann sollten das drei Meter sein", "drive 10 s at 0.3 m/s"),
        ("以0.3米每秒开10秒，那就是三米", "drive 10 s at 0.3 m/s"),
        ("drive 10 s at 0.3 m/s, that makes 4 m", "unclear"),
        ("drive 10 s at 0.3 m/s, then 3 m", "drive 10 s at 0.3 m/s; drive 3 m"),
        ("Do two steps: 1) forward 1 m 2) turn left", "drive 1 m; turn left 90 deg"),
        ("Do this: forward 1 m, turn left", "drive 1 m; turn left 90 deg"),
        ("1) 1 m vor 2) links drehen", "drive 1 m; turn left 90 deg"),
        ("turn completely to the right twice", "turn right 360 deg; turn right 360 deg"),
        ("dreh dich zweimal vollständig nach links", "turn left 360 deg; turn left 360 deg"),
        ("forward 3 m, quarter turn left, another 1.5", "unclear"),
        ("spin round so you're facing back the way you came", "turn left 180 deg"),
        ("figure eight, first circle to the left, then the circle to the right, both with 60 cm radius", EIGHT),
        ("figure eight, first the circle to the left, then to the right, 60 cm radius", EIGHT),
        ("Where you stand is the origin, x is ahead and y left. Go to x = 2, y = 3", 'go to 2 3 named "(2, 3)"'),
        ("fahr auf (1.5, -2), x zeigt nach vorn und y nach links", 'go to 1.5 -2 named "(1.5, -2)"'),
        ("去(2, 1)，x朝前，y朝左", 'go to 2 1 named "(2, 1)"'),
        ("go to (2, 3), x is right and y is ahead", "unclear"),
        ("forward 1² m", "unclear"),
        ("fahr 1.250,5 mm vor", "drive 1.2505 m"),
        ("turn left 90º", "turn left 90 deg"),
        ("back up 2 metres, no scrap that, 1 metre", "drive 1 m back"),
        ("2 m ahead at 0.2 m/s, no, too slow, make it 0.4", "drive 2 m at 0.4 m/s"),
        ("zwo Meter zurück, nein Moment, drei Meter zurück, ich hab mich vertan", "drive 3 m back"),
        ("fahr einsfuffzig vor", "drive 1.5 m"),
        ("elfhundert Millimeter vor", "drive 1.1 m"),
        ("advance two decimal five metres", "drive 2.5 m"),
        ("slide left 2 metres, then slide back to your mark", "drive 2 m left; drive 2 m right"),
        ("回原点，车头还朝最开始那个方向", "go to 0 0 facing 0 deg"),
        ("沿轴线往前走3米", "drive 3 m"),
        ("2 m ahead, then ten seconds standing", "drive 2 m; wait 10 s"),
        ("2 m ahead, then ten seconds for the doors", "unclear"),
        ("forward 2 s, then 3 s", "drive 2 s; drive 3 s"),
        ("先到(1,0)，停两秒，再到(1,2)", 'go to 1 0 named "(1, 0)"; wait 2 s; go to 1 2 named "(1, 2)"'),
        ("for i in range(2): 50cm vor, 2s warten", "drive 0.5 m; wait 2 s; drive 0.5 m; wait 2 s"),
        ("全程15cm/s，前进60cm，再左移60cm", "drive 0.6 m at 0.15 m/s; drive 0.6 m left at 0.15 m/s"),
        ("1m50 back", "drive 1.5 m back"),
        ("turn right 30 degrees and turn back to the left by the same angle", "turn right 30 deg; turn left 30 deg"),
        ("The driving comes last, 1.4 m forward; first turn left", "unclear"),
        ("you there in the back row, move a metre left please", "unclear"),
        ("Und Sie da hinten rücken mal einen Meter nach links", "unclear"),
        ("那边那个同学往左移一米", "unclear"),
        ("三百六十度评价", "unclear"),
        ("forward 1 m, then turn left and before that wait 3 s", "drive 1 m; wait 3 s; turn left 90 deg"),
        ("drive 5 s at 0.1 m/s, then back at twice the speed", "drive 5 s at 0.1 m/s; drive 0.5 m back at 0.2 m/s"),
        ("turn left, then drive 1 m, no, forget the driving", "unclear"),
        ("reverse the order", "unclear"),
        ("Keep going, love, you're nearly there, two more reps!", "unclear"),
        ("继续走", "unclear"),
        ("前进两米啊不是 我是说后退两米啊也不是 算了别动", "unclear"),
        ("直行四米,第二米开始减速", "unclear"),
        ("先往前两米再转回来再走两米", "drive 2 m; turn left 180 deg; drive 2 m"),
        ("往前走一公尺喔", "drive 1 m"),
        ("前进一米再左转,左转之前等两秒", "drive 1 m; wait 2 s; turn left 90 deg"),
        ("先左转九十度再前进一米,不过左转之前先倒退半米", "drive 0.5 m back; turn left 90 deg; drive 1 m"),
        ("直行四米,中途在两米处停三秒", "drive 2 m; wait 3 s; drive 2 m"),
        ("直走六米,第三米处右转", "unclear"),
        ("前进1米左转90度重复四次但是最后一次不用转", "unclear"),
        ("真的假的 三圈喔", "unclear"),
        ("go forward twice 40 cm plus 15 cm", "unclear"),
        ("drive 2 m, come back two thirds of the way", "drive 2 m; drive 1.3333333334 m back"),
        ("Give me an L: long arm 2 m, short arm 1 m, turning right", "drive 2 m; turn right 90 deg; drive 1 m"),
    ],
)  # fmt: skip
def test_it_is_done_once(said: str, plan: str) -> None:
    assert done(said) == plan


def test_the_axes_are_not_read_where_the_robot_has_moved() -> None:
    assert done("drive 1 m", "You are at the origin, x is ahead, y is left. Go to (1, 2)") == "unclear"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("great. now just step 3 again", "drive 0.6 m"),
        ("repeat the step number 2", "turn right 90 deg"),
        ("schön. jetzt nur schritt 3 nochmal", "drive 0.6 m"),
    ],
)
def test_a_step_is_named_by_its_number(said: str, plan: str) -> None:
    assert done("drive 1 m, turn right 90 degrees, drive 60 cm", said) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("drive 2 m", "now the half of this, but backwards"), "drive 1 m back"),
        (("drive 2 m", "10 seconds"), "unclear"),
        (("drive 1.2 m", "that was 20 cm too much, take it back"), "drive 0.2 m back"),
        (("slide left 1 m", "undo 20 cm"), "drive 0.2 m right"),
        (("turn left 90", "ok undo 10 degrees of that"), "turn right 10 deg"),
        (("drive 1.2 m", "1 m would have been enough"), "drive 0.2 m back"),
        (("前进120公分", "应该前进1米，把多走的退回来"), "drive 0.2 m back"),
        (("往前走五米", "两米啊 那么远"), "unclear"),
        (("往右平移一公尺", "一公尺喔 夠嗎"), "unclear"),
        (("右转", "右转喔 怎么不是左转"), "unclear"),
        (("前進一公尺", "這布一公尺多少錢", "三公尺八塊喔"), "unclear"),
        (("前進兩公尺", "那個沙發到電視有幾公尺啊", "三公尺左右吧"), "unclear"),
        (("前进三米", "快回来 你的手机忘了"), "unclear"),
        (("前进两米", "撤回 我发错群了"), "unclear"),
        (("转一圈", "同学们再来一次"), "unclear"),
        (("drive 1 m, right 90", "same with left in place of right"), "drive 1 m; turn left 90 deg"),
        (("arc left 60 degrees, 1 m radius", "now drive it backwards"), "arc back left 60 deg radius 1 m"),
        (("drive 1 m", "Rewind that bit, I missed the goal."), "unclear"),
        (("drive 2 m", "Same again, landlord, and a packet of crisps."), "unclear"),
        (("drive for 2 s", "another 3 s"), "drive 3 s"),
        (("往前走两米", "再走一半那么远"), "drive 1 m"),
        (
            ("fahr 1.5 m vor", "jetzt rückwärts die strecke wieder zurück, halb so schnell"),
            "drive 1.5 m back at 0.15 m/s",
        ),
        (
            ("merk dir die stelle hier mal als ladeplatz", "fahr 1 m vor", "und wieder zum ladeplatz"),
            'go to 0 0 named "ladeplatz"',
        ),
        (
            ("This spot here's the dock, yeah? Remember it.", "forward 1 m", "back to the dock"),
            'go to 0 0 named "dock"',
        ),
        (
            (
                "remember this place as desk",
                "1 m ahead",
                "remember this place as mat",
                "1 m ahead",
                "go to the mat, no sorry, to the desk",
            ),
            'go to 0 0 named "desk"',
        ),
    ],
)
def test_the_last_turn_is_done(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan
