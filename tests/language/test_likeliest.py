"""What is said beside an order is left out; where that is not sure, the likeliest plan is proposed, never driven."""

from __future__ import annotations

import pytest

from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation, conversation


def done(*turns: str) -> str:
    """The plan of the last turn, or its outcome and what is proposed."""
    meant = conversation(*turns[:-1]).say(turns[-1])
    if meant.plan is not None:
        return format_plan(meant.plan)
    return f"{meant.outcome}: {meant.proposal.plan_text}" if meant.proposal else meant.outcome


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("the curtain is open, so drive forward 2.5 m", "drive 2.5 m"),
        ("my shift is over so now you go forward one meter", "drive 1 m"),
        ("这边太窄了 你向左平移20厘米吧", "drive 0.2 m left"),
        ("Sorry to bother you again, but could you scoot forward about forty centimetres?", "drive 0.4 m"),
        ("I was thinking you could maybe turn right by forty five degrees", "turn right 45 deg"),
        ("lunch is ready so come forward one metre and turn right", "drive 1 m\nturn right 90 deg"),
        ("往前走一米，小心左边", "drive 1 m"),
        ("小心右边", "unclear"),
        ("能不能往后退半米 我椅子出不来", "drive 0.5 m back"),
        ("I'd love it if you turned left ninety degrees", "turn left 90 deg"),
        ("it would be great if you drove 1 m and then rolled back 50 cm", "drive 1 m\ndrive 0.5 m back"),
    ],
)
def test_talk_beside_an_order_is_passed_over(text: str, plan: str) -> None:
    assert done(text) == plan


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("go forward 3 m at 0.5 m/s yippeekayay", "drive 3 m at 0.5 m/s"),
        ("forward 1 m zorblaxing", "drive 1 m"),
        ("in that case turn left 90 degrees", "turn left 90 deg"),
        ("zorblaxing half a metre to the left, and do that twice", "drive 0.5 m left\ndrive 0.5 m left"),
        ("shift her bodily to starboard, 40 cm", "drive 0.4 m right"),
        ("turn right 30 degrees via the frobnicator", "turn right 30 deg"),
        ("turn lest 45 degrees", "turn left 45 deg"),
        ("Wusel dich einen halben Meter nach rechts", "drive 0.5 m right"),
    ],
)
def test_a_strange_word_beside_a_whole_order_is_asked_about_with_the_plan(text: str, plan: str) -> None:
    assert done(text) == f"unclear: {plan}"


def test_a_side_that_is_told_of_is_no_turn_before_an_order() -> None:
    assert done("左边太近了，往右平移二十厘米") == "drive 0.2 m right"


@pytest.mark.parametrize(
    "text",
    [
        "and zorblax forward",  # what is to be done is strange itself, and how far is not said
        "go to the zorblax",
        "if the zorblax opens, go forward 2 m",
        "go forward 2 m unless the zorblax rings",
        "the frobnicator went left 2 m",
        "grab the cup and go forward 2 m",
        "go forward 1 m past the fern and turn to the fern",  # a second order around what is strange
        "turn left 90 degrees around the fern",
        "turn the frobnicator 90 degrees to the left",  # something else
        "the frobnicator 2 m to the left",
        "zorblax three, forward 2 m and zorblax four",  # a number without a unit may be part of a name
        "go forward one and a half zorblax",
        "expanding square search: one metre ahead, right ninety degrees, one metre",
        "go 2 m astarboard",  # a way is part of the word
        "fahr 2 m halblinks",
        "把那把椅子往左挪半米",
        "前进一米然后阿巴阿巴",
    ],
)
def test_nothing_is_proposed_where_what_is_strange_may_be_the_order(text: str) -> None:
    assert conversation().say(text).proposal is None


def test_what_is_to_be_changed_is_not_left_out_of_a_proposal() -> None:
    talk = conversation("forward 1 m")
    meant = talk.say("again with zorblax doubled")
    assert meant.plan is None
    assert meant.proposal is None


@pytest.mark.parametrize(
    ("text", "quoted"),
    [
        ("往右转六十度，用阿巴阿巴", "用阿巴阿巴"),
        ("Einen halben Meter nach rechts, flubber das Mecanum", "flubber das Mecanum"),
    ],
)
def test_a_question_quotes_what_was_said(text: str, quoted: str) -> None:
    meant = conversation().say(text)
    assert meant.outcome == "unclear"
    assert quoted in meant.reply


def test_a_proposal_names_what_was_left_out() -> None:
    meant = Conversation().say("forward 1 m zorblaxing")
    assert meant.code == "did_you_mean"
    assert "zorblax" in meant.reply
    assert "drive forward 1 m" in meant.reply


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (["来回走三趟，每趟前进1米再后退1米"], "drive 1 m\ndrive 1 m back\n" * 3),
        (["原地向右转一个圈"], "turn right 360 deg"),
        (["slide right for to and a half seconds"], "drive 2.5 s right"),
        (["advance 20 cm and hold three seconds"], "drive 0.2 m\nwait 3 s"),
        (["turn 30 degrees left", "no wait, the other way"], "turn right 60 deg"),
        (
            ["figure eight, two loops of radius 0.5 m"],
            "arc left 360 deg radius 0.5 m\narc right 360 deg radius 0.5 m",
        ),
        (["前进两米,讲错,是一米"], "drive 1 m"),
        (["向右转弯走四分一个圆,半径一米"], "arc right 90 deg radius 1 m"),
    ],
)
def test_what_was_misread_once(turns: list[str], plan: str) -> None:
    assert done(*turns) == plan.strip()


@pytest.mark.parametrize(
    ("said", "plan"), [("往前走50", "drive 0.5 m"), ("后退30", "drive 0.3 m back"), ("往前走5", "drive 5 m")]
)
def test_a_number_without_a_unit_is_proposed_in_chinese_too(said: str, plan: str) -> None:
    meant = Conversation().say(said)
    assert meant.proposal is not None
    assert meant.proposal.plan_text.strip() == plan
