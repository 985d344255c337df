"""What is said beside a motion, or without one: questions, stops among lines, greetings and thanks."""

from __future__ import annotations

import time

import pytest

from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    "said",
    [
        "where are you?\nforward 1 m",
        "forward 1 m\nwhere are you",
        "where are you?\nforward",
        "forward 1 m, where are you?",
        "how fast are you? drive 1 m",
        "你在哪？前进一米",
        "前进一米\n你在哪",
    ],
)
def test_neither_a_question_nor_the_motion_beside_it_is_passed_over(said: str) -> None:
    meant = Conversation().say(said)
    assert (meant.outcome, meant.code) == ("unclear", "question_beside")


@pytest.mark.parametrize(
    "said", ["can you go forward? 1 m", "ready? forward 1 m", "what about going forward 1 m?"]
)
def test_what_is_asked_as_a_favour_is_done(said: str) -> None:
    assert Conversation().say(said).outcome == "plan"


@pytest.mark.parametrize(
    "said", ["forward 1 m\nstop\nturn left", "stop\nforward 1 m", "forward 1 m\nstop!", "前进一米\n停\n左转"]
)
def test_a_stop_on_a_line_of_its_own_is_a_stop(said: str) -> None:
    meant = Conversation().say(said)
    assert meant.outcome == "stop"
    assert meant.plan is None


@pytest.mark.parametrize(
    "said",
    [
        "do this:\n1. forward 1 m\n2. stop\n3. turn left",
        "- forward 1 m\n- stop\n- turn left",
        "forward 1 m\nthen stop\nthen turn left",
        "forward 1 m, stop, turn left",
        "forward 1 m\nstop for 2 seconds\nturn left",
        "前进一米\n然后停\n左转",
    ],
)
def test_a_stop_that_has_its_place_in_a_sequence_comes_in_its_turn(said: str) -> None:
    assert Conversation().say(said).outcome == "plan"


@pytest.mark.parametrize(
    "said", ["hello", "Hi there, robot!", "good morning", "thanks", "thank you so much", "bye"]
)
def test_a_greeting_is_answered_and_nothing_moves(said: str) -> None:
    meant = Conversation().say(said)
    assert (meant.outcome, meant.plan, meant.language) == ("answered", None, "en")


@pytest.mark.parametrize("said", ["你好", "你好啊，小车", "谢谢", "太谢谢你了", "辛苦了", "再见"])
def test_a_greeting_is_answered_in_its_own_language(said: str) -> None:
    meant = Conversation().say(said)
    assert (meant.outcome, meant.plan, meant.language) == ("answered", None, "zh")


def test_a_greeting_does_not_complete_what_was_asked_back_about() -> None:
    talk = Conversation()
    talk.say("go forward some")
    assert talk.say("hello").plan is None


def test_a_greeting_before_a_motion_changes_nothing() -> None:
    assert Conversation().say("hello, go forward 1 m").plan == Conversation().say("go forward 1 m").plan
    assert Conversation().say("thanks, stop").outcome == "stop"


@pytest.mark.parametrize(
    "said", ["拜" * 59 + "x", "谢" * 59 + "x", "thank you " * 5 + "x", "bye " * 14 + "x"]
)
def test_endless_thanks_take_no_time(said: str) -> None:
    Conversation().say("hello")
    began = time.process_time()
    Conversation().say(said)
    assert time.process_time() - began < 1.0
