"""What people say after a motion is read by what was done: it means another thing after a turn or a square."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_likeliest import done

LEGS, SQUARE = "go forward 1 m, turn left 90, go forward 50 cm", "draw a square with 50 cm sides"
THERE = "forward 50 cm, wait 2 seconds, back 50 cm"
BEINE = "fahr 1 m vor, dreh dich 90 Grad nach links, fahr 50 cm vor"
CIRCLE = "circle to the left with radius 40 cm"
HIN, QUADRAT = "fahr 50 cm vor, warte 2 Sekunden, fahr 50 cm zurück", "fahr ein Quadrat mit 50 cm Seitenlänge"
STEPS = "前进1米，左转90度，再前进50厘米"
FOUR = "\n".join(["drive {0} m", "turn {1} 90 deg"] * 4)


@pytest.mark.parametrize(
    ("before", "said", "plan"),
    [
        (LEGS, "the turn again", "turn left 90 deg"),
        (LEGS, "the first two again", "drive 1 m\nturn left 90 deg"),
        (LEGS, "first and third again", "drive 1 m\ndrive 0.5 m"),
        (LEGS, "the last one again", "drive 0.5 m"),
        (LEGS, "with 2 m instead of 1 m", "drive 2 m\nturn left 90 deg\ndrive 0.5 m"),
        (LEGS, "with 45 degrees instead of 90", "drive 1 m\nturn left 45 deg\ndrive 0.5 m"),
        (LEGS, "same but all distances halved", "drive 0.5 m\nturn left 90 deg\ndrive 0.25 m"),
        (LEGS, "swap left and right", "drive 1 m\nturn right 90 deg\ndrive 0.5 m"),
        (LEGS, "do it again but with a 3 second pause at the end", f"{done(LEGS)}\nwait 3 s"),
        (THERE, "wait 5 seconds instead", "drive 0.5 m\nwait 5 s\ndrive 0.5 m back"),
        (SQUARE, "one more time", FOUR.format("0.5", "left")),
        (SQUARE, "this time 2 m", FOUR.format("2", "left")),
        (SQUARE, "now one half the size", FOUR.format("0.25", "left")),
        (CIRCLE, "the same but twice around", "\n".join(["arc left 360 deg radius 0.4 m"] * 2)),
        (SQUARE, "one more lap", FOUR.format("0.5", "left")),
        ("turn left 45", "a little more", "turn left 22.5 deg"),
        ("turn left 45", "turn right instead", "turn right 90 deg"),
        ("slide left 30 cm", "reverse it", "drive 0.3 m right"),
        ("forward 1 m", "take that back", "drive 1 m back"),
        ("forward 1 m", "make it double", "drive 1 m"),
        ("forward 1 m", "with 0.1 m/s instead", "drive 1 m at 0.1 m/s"),
        ("forward 1 m", "redo that", "drive 1 m"),
        ("forward 1 m", "add a turn right at the end", "turn right 90 deg"),
        ("go forward 1 m and turn left 90", "10 degrees the other way", "turn right 10 deg"),
        (BEINE, "die Drehung nochmal", "turn left 90 deg"),
        (BEINE, "den zweiten nochmal", "turn left 90 deg"),
        (BEINE, "die letzten beiden nochmal", "turn left 90 deg\ndrive 0.5 m"),
        (BEINE, "alle Strecken doppelt so lang", "drive 2 m\nturn left 90 deg\ndrive 1 m"),
        (BEINE, "ohne die Drehung nochmal", "drive 1 m\ndrive 0.5 m"),
        ("fahr 1 m vor", "mach 50 cm draus", "drive 0.5 m back"),
        (HIN, "warte diesmal 5 Sekunden", "drive 0.5 m\nwait 5 s\ndrive 0.5 m back"),
        (QUADRAT, "jetzt als Dreieck", "\n".join(["drive 0.5 m\nturn left 120 deg"] * 3)),
        (STEPS, "转弯再来一次", "turn left 90 deg"),
        (STEPS, "所有距离加倍再来一次", "drive 2 m\nturn left 90 deg\ndrive 1 m"),
        (STEPS, "左右互换", "drive 1 m\nturn right 90 deg\ndrive 0.5 m"),
        (STEPS, "只做最后一步", "drive 0.5 m"),
        ("走一个边长50厘米的正方形", "再画一个", FOUR.format("0.5", "left")),
        ("走一个边长50厘米的正方形", "边长改成1米", FOUR.format("1", "left")),
        ("左转45度", "一半", "turn left 22.5 deg"),
        ("前进一米", "再慢一点来一次", "drive 1 m at 0.15 m/s"),
    ],
)  # fmt: skip
def test_what_is_said_after_a_motion_is_done_as_it_is_meant_after_that(
    before: str, said: str, plan: str
) -> None:
    assert done(before, said) == plan


@pytest.mark.parametrize(
    ("before", "said"),
    [
        ("turn left 45", "continue"),  # how far, and is it the turn?
        ("arc left 90 degrees, radius 50 cm", "carry on"),
        ("turn left 45", "three in total"),
        (SQUARE, "backwards this time"),
        ("slide left 30 cm", "backwards this time"),
        ("go forward 1 m and turn left 90", "10 cm the other way"),
        (LEGS, "undo step 2"),
        (LEGS, "make the last one longer"),
        (LEGS, "turn right instead of left"),
        (LEGS, "do it again but go 10 cm less"),
        ("slide left 40 cm", "with 2 m instead of 1 m"),  # nothing of it was 1 m
        (SQUARE, "go 1 m forward and do it again"),  # twice that, or the square?
        (SQUARE, "to the left this time"),
        (SQUARE, "start with the right side"),
        (SQUARE, "another one next to it"),
        ("drive a figure eight with radius 50 cm", "now clockwise"),
        (LEGS, "undo the last but one"),
        ("forward 50 cm", "the same on the other side"),
        ("走一个边长50厘米的正方形", "再大10厘米"),
        ("走一个边长50厘米的正方形", "往前一米再来一遍"),
        (QUADRAT, "daneben noch eins"),
        (QUADRAT, "fahr 1 m vor und mach das nochmal"),
        ("forward 1 m", "start again"),
        (BEINE, "mach die Drehung rückgängig"),
        (BEINE, "nochmal mit 20 cm mehr"),
        (STEPS, "停顿改成5秒"),
        (STEPS, "1米换成2米再来一次"),
        ("左转45度", "接着走"),
        ("向左走一个半径40厘米的圆", "再转两圈"),
    ],
)
def test_what_may_mean_several_things_after_a_motion_is_asked_about(before: str, said: str) -> None:
    meant = conversation(before).say(said)
    assert (meant.outcome, meant.plan, meant.proposal) == ("unclear", None, None)


@pytest.mark.parametrize(
    ("before", "said", "plan"),
    [
        ("turn left 45", "go back", "turn right 45 deg"),
        ("slide left 30 cm", "go back", "drive 0.3 m right"),
        ("slide left 30 cm", "hey, go back please", "drive 0.3 m right"),
        ("forward 1 m", "10 cm less", "drive 0.1 m back"),
        ("turn left 45", "10 degrees less", "turn right 10 deg"),
        ("forward 1 m", "make it a bit longer", "drive 2 m"),
        (LEGS, "make the turn 45 degrees", "drive 1 m\nturn left 45 deg\ndrive 0.5 m"),
        (LEGS, "make the first one 2 m", "drive 2 m\nturn left 90 deg\ndrive 0.5 m"),
        ("dreh dich 45 Grad nach links", "zurück", "turn right 45 deg"),
    ],
)
def test_what_a_follow_up_most_likely_means_is_proposed(before: str, said: str, plan: str) -> None:
    meant = conversation(before).say(said)
    assert meant.plan is None
    assert meant.proposal is not None
    assert meant.proposal.plan_text == plan


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("my friend, walk 2,35 meters ahead", "drive 2.35 m"),
        ("drive 10,5 cm", "drive 0.105 m"),
        ("turn right 22,5°", "turn right 22.5 deg"),
        ("turn left 90,2 m forward", "turn left 90 deg\ndrive 2 m"),
        ("fahr 1,5 Meter mit einem Zehntel Meter pro Sekunde", "drive 1.5 m at 0.1 m/s"),
        ("fahr ein Fünftel Meter vor", "drive 0.2 m"),
    ],
)
def test_a_decimal_comma_is_read_beside_anything_else(text: str, plan: str) -> None:
    assert done(text) == plan


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("turn left 45", "actually right", "again"), "turn right 45 deg"),
        (("go 1 m", "50 cm I meant", "again"), "drive 0.5 m"),
        (("go 1 m", "no, 2 m", "do that again"), "drive 2 m"),
        (("turn left 45", "make it 60", "thanks", "once more"), "turn left 60 deg"),
        (("dreh dich nach links", "nein, rechts meinte ich", "nochmal"), "turn right 90 deg"),
        (("左转45度", "我说的是右边", "再来一次"), "turn right 45 deg"),
    ],
)
def test_again_after_a_correction_does_what_was_meant(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


def test_an_amount_that_is_put_right_after_the_side_was_is_one_of_that_side() -> None:
    assert done("turn left 45", "no, right", "I meant 30 degrees") == "turn left 15 deg"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("forward 1 m", "turn left", "repeat everything"), "drive 1 m\nturn left 90 deg"),
        (("forward 1 m", "back 50 cm", "undo", "turn left", "everything again"), "drive 1 m\nturn left 90 deg"),
        (("first go forward 50 cm", "second turn right", "third go back 30 cm", "now do all three again"),
         "drive 0.5 m\nturn right 90 deg\ndrive 0.3 m back"),
        (("fahr 1 m vor", "und nach links", "alles nochmal"), "drive 1 m\nturn left 90 deg"),
        (("前进1米", "左转", "全部再来一遍"), "drive 1 m\nturn left 90 deg"),
        (("slow mode", "forward 1 m"), "drive 1 m at 0.15 m/s"),
        (("use 0.1 m/s", "turn left", "forward 50 cm"), "drive 0.5 m at 0.1 m/s"),
        (("fahr langsam 1 m", "wieder normal", "fahr 1 m"), "drive 1 m at 0.3 m/s"),
        (("forward 1 m", "undo", "redo"), "drive 1 m"),
        ((LEGS, "do the third step again", "now the first one again"), "drive 1 m"),
        ((BEINE, "mach den dritten Schritt noch mal", "und jetzt den ersten, aber rückwärts"), "drive 1 m back"),
        ((STEPS, "第三步再做一次", "第一步也再做一次给他看"), "drive 1 m"),
        (("reverse 35 cm", "Not far enough, is it. Same again but 15 cm more this time."), "drive 0.5 m back"),
        (("后面的测试线速度一律0.2 m/s", "前进1 m"), "drive 1 m at 0.2 m/s"),
        (("let's play: when I say banana turn left 90", "banana"), "turn left 90 deg"),
    ],
)  # fmt: skip
def test_everything_that_was_done_and_the_pace_are_kept_over_turns(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("fahr 80 cm vor, die Kinder warten schon", "drive 0.8 m"),  # and waits for nothing
        (
            "前进1米再后退1米算一个循环,连做2个循环,每个循环结束静置2秒",
            "\n".join(["drive 1 m\ndrive 1 m back\nwait 2 s"] * 2),
        ),
        ("前进1米再后退1米,连做2遍,每做完一遍停2秒", "\n".join(["drive 1 m\ndrive 1 m back\nwait 2 s"] * 2)),
    ],
)
def test_waits_are_where_they_are_told(text: str, plan: str) -> None:
    assert done(text) == plan
