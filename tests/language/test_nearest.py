"""The nearest order to a text that is not understood is asked about, and done where nothing that matters is lost."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.nearest import MOST_BASES, MOST_READS, READS_OF_BASE, candidates
from chatrobot.language.omissions import omissions
from chatrobot.language.reading import Reading
from chatrobot.language.unclear import Unclear
from chatrobot.plan.text import parse_plan
from tests.language.dialogue_runner import Conversation
from tests.language.profiles import MECANUM

WORDS = st.sampled_from(
    ["go", "forward", "1", "2.5", "m", "left", "90", "degrees", "then", "the", "zorblax", "of", "not", "if", "it",
     "was,", "wait", "3", "s.", "once", "again,", "0,5", "to"]
)  # fmt: skip
TEXTS = st.lists(WORDS, min_size=2, max_size=14).map(" ".join)
STUMBLED = Unclear("unknown_part", "zorblax")


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("just testing the encoders, so take me a metre and a half back", "drive 1.5 m back"),
        ("for the grading I need one turn to the left of 40 degrees", "turn left 40 deg"),
        ("Der Beamer spinnt, fahr mal 60 cm zurück", "drive 0.6 m back"),
        ("für mein Video bräuchte ich 2 Meter geradeaus", "drive 2 m"),
    ],
)
def test_a_yes_does_what_a_text_with_unknown_words_most_likely_orders(text: str, plan: str) -> None:
    meant = Conversation().say(text)
    assert meant.plan is None
    assert meant.proposal is not None
    assert parse_plan(meant.proposal.plan_text) == parse_plan(plan)


@pytest.mark.parametrize(
    "text",
    [
        "forward 50 cm, then greet me",
        "go forward one metre, just messing with you",
        "curve left, radius 1 m, 90 degrees to the giraffe",
        "could you please pirouettify us five metres, slowly at 0.2 m/s?",
        "go forward one metre and frobnicate the giraffe",
        "先前进一米三号桌，再左转九十度",
        "上节课的内容：前进一米",
        "前进一米，要我说就太远了",
        "先转一圈，再往前走半米，然后反着转一圈",
    ],
)
def test_what_may_matter_is_never_passed_over_without_a_yes(text: str) -> None:
    assert Conversation().say(text).plan is None


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        (
            "Nimm jetzt bitte eine Linkskurve über 90 Grad, der Radius soll ein Meter sein.",
            "arc left 90 deg radius 1 m",
        ),
        ("back up 2 m zorblaxing", "drive 2 m back"),
        ("再往前开一米，测个速", "drive 1 m"),
    ],
)
def test_a_word_within_an_order_that_is_very_likely_meant_without_it_is_passed_over(
    text: str, plan: str
) -> None:
    assert Conversation().say(text).plan == parse_plan(plan)


@pytest.mark.parametrize(
    "text",
    [
        "HEADS! Nobody move, bar's coming in.",
        "the last robot went two metres and then its battery died",
        "Ich hab nie gesagt, dass du 'n Meter zurücksetzen sollst.",
        "那破电梯又在往上走 气死我了",
    ],
)
def test_a_remark_moves_nothing(text: str) -> None:
    assert Conversation().say(text).plan is None


def test_how_fast_is_no_yes_to_what_was_proposed() -> None:
    talk = Conversation()
    assert talk.say("2 metres on").proposal is not None
    said = talk.say("blimey the hens are going mental, drop your speed to 0.1 metres a second")
    assert said.plan is None
    assert said.proposal is not None


@given(TEXTS)
def test_what_is_left_out_and_the_rest_are_the_whole_text(text: str) -> None:
    for one in omissions(text, STUMBLED, {}):
        assert one.said in text
        assert sorted(_letters(one.rest) + _letters(text[one.start : one.stop])) == sorted(_letters(text))


@given(TEXTS)
def test_no_number_is_cut_in_two(text: str) -> None:
    numbers = [word.strip(".,") for word in text.split() if word[0].isdigit()]
    for one in omissions(text, STUMBLED, {}):
        left = [word.strip(".,") for word in one.rest.split() if word[0].isdigit()]
        assert all(number in numbers for number in left)


@given(TEXTS)
def test_so_many_texts_are_read_and_no_more(text: str) -> None:
    read: list[str] = []

    def stumble(rest: str) -> Interpretation:
        read.append(rest)
        raise Unclear("unknown_part", "zorblax")

    reading = Reading("en", Context(Dialogue(), RobotState(None, 0.0, None)), MECANUM)
    candidates(text, STUMBLED, reading, stumble)
    assert len(read) <= MOST_READS + MOST_BASES * READS_OF_BASE


def _letters(text: str) -> str:
    return "".join(letter for letter in text if letter.isalnum())
