"""Remarks are passed over; an unknown word in the place of a verb, an object or a condition is asked about."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.language.context import Context
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.plan.steps import Plan
from tests.language.dialogue_runner import Conversation
from tests.language.profiles import MECANUM

COMMANDS = (
    "go forward 1 m", "turn left 90 degrees", "drive back 50 cm slowly", "slide to the right 30 cm",
    "curve left, radius 1 m, 90 degrees", "go forward 1 m, then turn right 45 degrees",
    "drive a square with 50 cm sides", "forward for 3 seconds",
)  # fmt: skip
NOUNS = (
    "giraffe", "lantern", "teapot", "violin", "harvest", "lorry", "umbrella", "senate", "pebble", "walnut",
    "barks", "loft", "leapt", "sprinkling", "crushing", "labs", "camp", "deer", "lent", "freight", "fright",
    "anvil", "turnip", "tuft", "gopher", "gobbles", "droves", "riven", "ditch",
)  # fmt: skip
DOINGS = ("frobnicate", "yodel", "polka", "juggle", "meditate upon", "defrost", "interview", "marinate")
CONDITIONS = (
    "until the {noun} leaves", "if the {noun} is near", "unless you see the {noun}", "except near the {noun}",
    "towards the {noun}", "around the {noun}", "without touching the {noun}", "to the {noun}", "past the {noun}",
    "as far as the {noun}", "when the {noun} comes", "but not over the {noun}", "avoiding the {noun}",
    "and {doing} the {noun}", "then {doing}", "and {doing}",
)  # fmt: skip
REMARKS = (
    "my sister is watching", "the baby is asleep", "because the neighbours are listening", "it's my birthday",
    "the kids love you", "there's a lot of space", "everyone is waiting", "we have guests", "you look great",
    "so that my friends can see you", "if it isnt too much trouble", "you look so clever",
)  # fmt: skip


def plan_of(text: str) -> Plan | None:
    return OfflineInterpreter(MECANUM).interpret(text, Context()).plan


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(COMMANDS), st.sampled_from(NOUNS), st.integers(0, 12))
def test_a_stray_word_never_changes_a_motion(command: str, noun: str, at: int) -> None:
    words = command.split()
    words.insert(min(at, len(words)), noun)
    assert plan_of(" ".join(words)) in (None, plan_of(command))


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(COMMANDS), st.sampled_from(CONDITIONS), st.sampled_from(NOUNS), st.sampled_from(DOINGS)
)
def test_a_condition_or_a_deed_it_cannot_judge_is_asked_about(
    command: str, condition: str, noun: str, doing: str
) -> None:
    assert plan_of(f"{command} {condition.format(noun=noun, doing=doing)}") is None


@pytest.mark.parametrize("remark", REMARKS)
@pytest.mark.parametrize("frame", ["{command}, {remark}", "{command}. {remark}!", "{remark}. {command}"])
def test_a_remark_changes_nothing(frame: str, remark: str) -> None:
    for command in COMMANDS:
        said = frame.format(command=command, remark=remark)
        assert plan_of(said) == plan_of(command), said


@pytest.mark.parametrize(
    "courtesy",
    [
        "Zorblax, {}",
        "hey robbie, {} please",
        "{}, would you?",
        "majestically, {}",
        "{} if you don't mind",
        "um, {}, ok?",
    ],
)
def test_names_and_courtesies_change_nothing(courtesy: str) -> None:
    for command in COMMANDS:
        assert plan_of(courtesy.format(command)) == plan_of(command), courtesy.format(command)


@pytest.mark.parametrize(
    "text",
    [
        "drive forward a distance of",
        "turn left and",
        "go forward until",
        "turn to the",
        "go 1 m if you",
        "drive to my",
    ],
)
def test_a_sentence_that_breaks_off_moves_nothing(text: str) -> None:
    talk = Conversation()
    assert talk.say(text).outcome == "unclear"


@pytest.mark.parametrize(
    "text", ["go to it", "drive over there", "go clockwise", "dance, go forward 1 m", "push it"]
)
def test_a_pronoun_without_a_referent_or_a_half_understood_motion_moves_nothing(text: str) -> None:
    assert plan_of(text) is None
