"""What people say turn by turn, in their own order and with reasons beside it, is done as meant, or asked about."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation, conversation

LEGS = "forward 20 cm, right 45, forward 60 cm"
HOPS = ["drive 0.2 m", "wait 1 s"]
THREE_QUARTERS = "arc left 270 deg radius 1 m"
BACK_TO_SECOND = "drive 0.5 m back\nturn right 90 deg"
ARC_RIGHT = "arc right 180 deg radius 1 m"
THERE = "go 60 cm back, wait five seconds, come forward 60 cm"


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        # of what was done before, and of the first of it
        (("back 90 cm", "forward 20 cm", "now forward twice as far as the first time"), "drive 1.8 m"),
        (("fahr 90 cm zurück", "20 cm vor", "doppelt so weit wie beim ersten Mal, nach vorn"), "drive 1.8 m"),
        (("后退90厘米", "前进20厘米", "再往前走第一次那么远"), "drive 0.9 m"),
        (("drive 4 s at 0.5 m/s", "same time backwards, at .25 m/s"), "drive 4 s back at 0.25 m/s"),
        (("drive 3 s at 0.1 m/s", "twice as fast now, same time"), "drive 3 s at 0.2 m/s"),
        (("drive 1 m at 0.2 m/s", "the same distance again, twice as fast"), "drive 1 m at 0.4 m/s"),
        (("three hops of 20 cm, wait 1 s after each", "two more of those hops"), "\n".join(HOPS * 2)),
        (("arc left 90 deg radius 1 m", "keep going till the circle is complete"), THREE_QUARTERS),
        (("arc left 90 deg radius 1 m", "weiter bis der Kreis voll ist"), THREE_QUARTERS),
        (("arc left 90 deg radius 1 m", "继续走直到圆闭合"), THREE_QUARTERS),
        (("forward 1 m", "left", "forward 50 cm", "undo everything but the first"), BACK_TO_SECOND),
        (
            (LEGS, "turn left, forward 1 m", "undo the last 3 steps"),
            "drive 1 m back\nturn right 90 deg\ndrive 0.6 m back",
        ),
        (
            ("forward 20 cm, right 45", "once more, but with left instead of right"),
            "drive 0.2 m\nturn left 45 deg",
        ),
        (("20 cm vor", "noch ein letztes Mal"), "drive 0.2 m"),
        (
            ("drive 1 m at 0.1 m/s", "keep to that speed from here on", "back 30 cm"),
            "drive 0.3 m back at 0.1 m/s",
        ),
        (("以0.1米每秒前进1米", "以后就保持这个速度", "后退半米"), "drive 0.5 m back at 0.1 m/s"),
        (("Leo says you should slide sideways by 50 cm", "to the left"), "drive 0.5 m left"),
        (("my son would like you to slide half a metre", "right"), "drive 0.5 m right"),
        ((LEGS, "again everything except the turn"), "drive 0.2 m\ndrive 0.6 m"),
        # parts of what was done
        ((LEGS, "repeat step 3", "now step 2 but the other way"), "turn left 45 deg"),
        ((LEGS, "the third step but twice as fast"), "drive 0.6 m at 0.6 m/s"),
        ((LEGS, "undo everything but the first step"), "drive 0.6 m back\nturn left 45 deg"),
        (
            ("20 cm vor, 45 Grad rechts", "mach alles rückgängig bis auf den ersten Schritt"),
            "turn left 45 deg",
        ),
        ((LEGS, "those three steps in reverse order"), "drive 0.6 m\nturn right 45 deg\ndrive 0.2 m"),
        (
            ("左转45度，走40厘米", "把这两个动作的先后顺序颠倒过来做一遍，动作本身不变"),
            "drive 0.4 m\nturn left 45 deg",
        ),
        (("turn left 20, forward 30 cm, wait 1 s", "repeat the last two steps"), "drive 0.3 m\nwait 1 s"),
        (("turn left 20 degrees, forward 90 cm", "take 25 cm of that off again"), "drive 0.25 m back"),
        ((LEGS, "take it all back"), "drive 0.6 m back\nturn left 45 deg\ndrive 0.2 m back"),
        (("turn left 60, drive 1 m", "undo both of those"), "drive 1 m back\nturn right 60 deg"),
        (("arc left 120 deg radius 1 m", "drive the rest of the full circle"), "arc left 240 deg radius 1 m"),
        # as far as before, and not in the same breath
        (
            ("turn around", "forward 1.2 m", "and again turn around and just as far again"),
            "turn left 180 deg\ndrive 1.2 m",
        ),
        (("forward 1.5 m", "now left, and the same distance again"), "turn left 90 deg\ndrive 1.5 m"),
        (
            ("往左平移四十公分", "哎呀我左右搞反了，先挪回来，再往右挪同样多"),
            "drive 0.4 m right\ndrive 0.4 m right",
        ),
        (("往前走七十公分", "我的意思是总共要一米五，不够的给补上"), "drive 0.8 m"),
        (("往右转30度", "再30", "凑够90度吧"), "turn right 30 deg"),
        (("沿着半径半米的弧线往左开半圈", "一样的半径，往右来一整圈"), "arc right 360 deg radius 0.5 m"),
        (("drive 4 s at 0.25 m/s", "same duration, 0.3 m/s"), "drive 4 s at 0.3 m/s"),
        (
            ("Seitlich nach rechts, 30 Zentimeter.", "Nein, nach links meinte ich, Verzeihung."),
            "drive 0.6 m left",
        ),
        # a total that was announced, and the rest of it
        (("You need to get 3 metres forward in total. Do 1 for now.", "ok now the rest"), "drive 2 m"),
        (("一共要往前3米，先走1米", "接着走80厘米", "剩下的走完"), "drive 1.2 m"),
        (
            ("Du sollst insgesamt 3 Meter vorfahren. Fang mit 1,2 Metern an.", "Jetzt den Rest."),
            "drive 1.8 m",
        ),
        # how much, how fast and which way are as before, or as they are said
        (("forward 0.5 m at 0.1 m/s", "another 50 cm at normal speed"), "drive 0.5 m"),
        (("forward half a metre", "a bit slower next time", "again"), "drive 0.5 m at 0.15 m/s"),
        (("forward half a metre at 0.4 m/s", "from now on 0.1 m/s", "again"), "drive 0.5 m at 0.4 m/s"),
        (
            ("go diagonally forward left for 1 m", "and now forward right, same length"),
            "drive 1 m toward -45 deg",
        ),
        (
            ("circle to the left with radius 50 cm", "Lovely! And one the other way round."),
            "arc right 360 deg radius 0.5 m",
        ),
        (("前进3秒", "现在后退，时间一样"), "drive 3 s back"),
        (("右转45度", "再转30"), "turn right 30 deg"),
        (("以后速度用0.5米每秒", "就这一次用0.2，后退1米"), "drive 1 m back at 0.2 m/s"),
        (
            (
                "50 cm vor, rechts drehen, 20 cm vor",
                "mach die drei Schritte jetzt in umgekehrter Reihenfolge",
            ),
            "drive 0.2 m\nturn right 90 deg\ndrive 0.5 m",
        ),
        (("dreh dich 90 Grad rechts", "zu viel, es sollten nur 60 sein"), "turn left 30 deg"),
        (
            ('"Runde" heißt: 1 m vorfahren, dann rechts drehen.', "Mach zweimal Runde."),
            "drive 1 m\nturn right 90 deg\ndrive 1 m\nturn right 90 deg",
        ),
        (("forward 1 m", "turn left 90", "look straight ahead again like at the beginning"), "face 0 deg"),
        # a measure of before, beside a motion of its own
        (("half a circle to the left, radius 1 m", "now half a circle to the right, same size"), ARC_RIGHT),
        (("往左走半个圆，半径一米", "往右走半个圆，大小一样"), ARC_RIGHT),
        (
            ("drive 60 cm diagonally to the front left", "now the front right, same distance"),
            "drive 0.6 m toward -45 deg",
        ),
        (
            ("往左前方斜着走60厘米", "原路返回", "再往右前方45度来一次，距离一样"),
            "drive 0.6 m toward -45 deg",
        ),
        (("forward 50 cm", "turn right 30", "walk the same distance again"), "drive 0.5 m"),
        (("slide right 40 cm", "now slide left"), "drive 0.4 m left"),
        (("往右平移40厘米", "再往左平移"), "drive 0.4 m left"),
        (("drive 2 m at 0.2 m/s", "again, but with 0.4"), "drive 2 m at 0.4 m/s"),
        (("turn right 30", "15 degrees more to the same side"), "turn right 15 deg"),
        (("turn left 60", "I meant 90, not 60"), "turn left 30 deg"),
        (("turn left 90, then 50 cm forward", "undo the second step"), "drive 0.5 m back"),
        (("forward 1 m, turn around, forward 50 cm", "could you do the last step again?"), "drive 0.5 m"),
        (("circle to the left", "cute. now a bigger one, 1 m radius"), "arc left 360 deg radius 1 m"),
        (("drive 2 m at 0.2 m/s", "do it again, but with the double speed"), "drive 2 m at 0.4 m/s"),
        (("back 40 cm", "and now forwards"), "drive 0.4 m"),
        (("turn right 90", "turn back 45 degrees"), "turn left 45 deg"),
        (
            ("forward 40 cm, left", "once more and then back to the start"),
            "drive 0.4 m\nturn left 90 deg\ngo to 0 0",
        ),
        (("先往前走40厘米，再往左平移30厘米", "第二步请你再做一遍哈", "第一步也再做一遍嘛"), "drive 0.4 m"),
        (
            ("30 cm nach rechts, ohne zu drehen", "Das reicht noch nicht, nochmal 10 cm weiter"),
            "drive 0.1 m right",
        ),
        (
            (
                "1 m vor und 90 Grad links",
                "Den ersten Schritt nochmal",
                "Und den zweiten auch nochmal, aber andersrum",
            ),
            "turn right 90 deg",
        ),
        # praise before an order tells nothing, and calls nobody
        (("forward 1 m", "awesome, turn right"), "turn right 90 deg"),
        (("forward 1 m", "Well done! Now left"), "turn left 90 deg"),
        (("draw a circle with radius 30 cm", "lovely circle! Now forward 1 m"), "drive 1 m"),
        (("linksherum 60 Grad", "Genau so. Jetzt einen Meter geradeaus."), "drive 1 m"),
    ],
)
def test_a_turn_means_what_it_says_of_those_before(turns: tuple[str, ...], plan: str) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan) == plan


@pytest.mark.parametrize(
    ("turns", "proposed"),
    [
        (("forward 1 m", "step 2 but the other way"), "drive 1 m back"),
        (("draw a circle", "do it again smaller"), "arc left 360 deg radius 0.25 m"),
        (("draw a circle", "once more, this time bigger"), "arc left 360 deg radius 1 m"),
        (("fahr einen Kreis", "nochmal, aber kleiner"), "arc left 360 deg radius 0.25 m"),
        (("forward 50 cm", "again, only shorter"), "drive 0.25 m"),
        (("roll 1 m toward the chaise longue",), "drive 1 m"),
        (("zweieinhalb Meter bis zum Kopierer",), "drive 2.5 m"),
        (("up the aisle 4 m, then turn left 30 degrees",), "drive 4 m\nturn left 30 deg"),
        (("forward 30 turn left 90 forward 30",), "drive 0.3 m\nturn left 90 deg\ndrive 0.3 m"),
        (("forward 1 m", "double the speed"), "drive 1 m at 0.6 m/s"),
        (("draw a circle", "face where you faced before the circle"), ""),
        (("ein Quadrat mit 40 cm", "nochmal kleiner"), "\n".join(["drive 0.2 m\nturn left 90 deg"] * 4)),
        (("forward 1 m", "halb so schnell"), "drive 1 m at 0.15 m/s"),
        (("前进一米", "速度加倍"), "drive 1 m at 0.6 m/s"),
        ((THERE, "the whole thing twice, but only wait 2 seconds"), ""),
        ((LEGS, "the same but begin with a right turn"), ""),
        (("I meant back, no forward",), ""),
        (("You are in my way, could you move over a bit?",), ""),
    ],
)
def test_what_may_be_meant_otherwise_is_asked_about(turns: tuple[str, ...], proposed: str) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is None
    assert (meant.proposal.plan_text if meant.proposal is not None else "") == proposed


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("forward one metre fifty turn left", "drive 1.5 m\nturn left 90 deg"),
        ("drive 1.4 m, 45 degrees to the left of straight ahead", "drive 1.4 m toward 45 deg"),
        ("drive 1 m, 45 degrees to the left, without turning", "drive 1 m toward 45 deg"),
        ("3 steps pls: drive 20cm, turn right 45", "drive 0.2 m\nturn right 45 deg"),
        ("for 7b please draw a triangle, 50 cm sides", "\n".join(["drive 0.5 m\nturn left 120 deg"] * 3)),
        ("für die 7b bitte ein Dreieck, Seitenlänge 50 cm", "\n".join(["drive 0.5 m\nturn left 120 deg"] * 3)),
        ("a square of 1 m, turning left 90 degrees at each corner", "\n".join(["drive 1 m\nturn left 90 deg"] * 4)),
        ("forward 4 m, left, 2 more", "drive 4 m\nturn left 90 deg\ndrive 2 m"),
        ("the lamp is 1.2 m to your right. Drive one full circle round it", "arc right 360 deg radius 1.2 m"),
        ("make a small figure eight", "arc left 360 deg radius 0.25 m\narc right 360 deg radius 0.25 m"),
        ("走个大8字", "arc left 360 deg radius 1 m\narc right 360 deg radius 1 m"),
        ("左转一下", "turn left 90 deg"),
        ("0.5 m/s 直行 3 m，然后 0.2 m/s 直线倒回原位", "drive 3 m at 0.5 m/s\ndrive 3 m back at 0.2 m/s"),
        ("I want to see if the rug is flat. Slide left 20 cm", "drive 0.2 m left"),
    ],
)  # fmt: skip
def test_a_whole_order_is_read_as_it_was_said(text: str, plan: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan) == plan


@pytest.mark.parametrize(
    "text",
    [
        "Ja grüß dich, du kleiner Flitzer, na, gut geschlafen?",
        "Na, gut geschlafen?",
        "Excuse me sir, would you step back two metres from the painting, thank you.",
        "it's 2 m to the copier",
        "is it 2 m to the copier?",
        "the ball rolls 2 m down the ramp",
    ],
)
def test_a_greeting_or_a_remark_moves_nothing(text: str) -> None:
    assert Conversation().say(text).plan is None


@pytest.mark.parametrize(
    ("taught", "word", "plan"),
    [
        ("I teach you a dance called jig: forward 20 cm, turn left", "jig", "drive 0.2 m\nturn left 90 deg"),
        ("Our class dance is called jig: forward 20 cm, turn left", "jig", "drive 0.2 m\nturn left 90 deg"),
        ("My routine: forward 20 cm, turn left. Call it jig.", "jig", "drive 0.2 m\nturn left 90 deg"),
        ('When I say "bow" go 15 cm forward. Just remember it, don\'t do it now.', "bow", "drive 0.15 m"),
        ("Ich bringe dir einen Tanz namens Polka bei: 20 cm vor", "Polka", "drive 0.2 m"),
        (
            "我教你个动作叫点头，就是往前十公分再退十公分，先别做，记着就行",
            "点头",
            "drive 0.1 m\ndrive 0.1 m back",
        ),
        ("摇摆的意思是左转20度", "摇摆", "turn left 20 deg"),
    ],
)
def test_what_is_taught_is_kept_and_not_done(taught: str, word: str, plan: str) -> None:
    said = Conversation()
    assert said.say(taught).plan is None
    meant = said.say(word)
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan) == plan


def test_the_last_motion_gets_a_name() -> None:
    said = conversation("forward 20 cm, turn left", "call the last move bop")
    meant = said.say("bop")
    assert meant.plan is not None
    assert format_plan(meant.plan) == "drive 0.2 m\nturn left 90 deg"


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("From now on drive at 0.2 m/s, then forward 1 m", "drive 1 m at 0.2 m/s"),
        ("ok he's up. Half speed from now on. Reverse 1 m", "drive 1 m back at 0.15 m/s"),
        ("从现在起速度0.2米每秒。前进1米", "drive 1 m at 0.2 m/s"),
        ("Ab jetzt 0,2 m/s. Einen Meter vor", "drive 1 m at 0.2 m/s"),
    ],
)
def test_what_is_set_and_what_is_ordered_in_one_breath_are_both_heard(text: str, plan: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan) == plan
    assert meant.usual.speed_mps == pytest.approx(0.15 if "Half" in text else 0.2)


@pytest.mark.parametrize(
    "text",
    [
        "From now on you drive at 0.15 metres per second, Mr Pettifer has his bad foot out.",
        "仓库这边地滑，从现在起速度统统用0.15米每秒",
        "Set default linear speed to 0.15 m/s for all following commands.",
    ],
)
def test_a_reason_beside_a_setting_hides_it_not(text: str) -> None:
    assert Conversation().say(text).usual.speed_mps == pytest.approx(0.15)


@pytest.mark.parametrize("text", ["forward 20 cm", "20 cm vor", "前进20厘米"])
def test_an_order_of_its_own_is_no_length_of_a_step(text: str) -> None:
    asked = {"forward 20 cm": "3 steps forward", "20 cm vor": "drei Schritte vor", "前进20厘米": "走三步"}[
        text
    ]
    meant = conversation(asked).say(text)
    assert meant.plan is not None
    assert format_plan(meant.plan) == "drive 0.2 m"


@pytest.mark.parametrize(
    "turns",
    [
        ("turn 40 degrees, Leo says", "left"),  # the side of what was not understood, and no quarter turn
        ("please slide 30 cm for Leo", "left"),
        ("forward 1 m, left, forward 1 m", "again apart from the last metre"),
        ("forward 1.2 m, left 90, forward 80 cm", "turn left, forward 1 m", "undo the last 2 steps"),
        ("back 90 cm", "forward 20 cm", "twice as far as the first time my dear"),
        ("forward 1 m, left, forward 50 cm", "again up to the turn"),
        ("skip it",),
    ],
)
def test_what_points_at_several_things_or_at_none_is_asked_back(turns: tuple[str, ...]) -> None:
    assert conversation(*turns[:-1]).say(turns[-1]).plan is None


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("before you drive 1 m turn right 90, and wait 4 s", "turn right 90 deg\nwait 4 s\ndrive 1 m"),
        (
            "before you go forward 1 m, turn right, and first of all wait 4 s",
            "wait 4 s\nturn right 90 deg\ndrive 1 m",
        ),
        ("before you turn left and drive 1 m, wait 2 s", "wait 2 s\nturn left 90 deg\ndrive 1 m"),
        ("can u roll forward 1.2m, pallet jack needs thru", "drive 1.2 m"),
        ("从现在起按每秒15厘米走，听到没？", ""),
    ],
)
def test_the_order_of_the_words_is_not_the_order_of_doing(text: str, plan: str) -> None:
    found = Conversation().say(text).plan
    assert (format_plan(found).strip() if found is not None else "") == plan
