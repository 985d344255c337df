"""What is not understood in full does not move the robot, and the reply says which part."""

from __future__ import annotations

import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.language.context import Context
from chatrobot.language.interpreter import OfflineInterpreter
from tests.language.dialogue_runner import Conversation
from tests.language.profiles import MECANUM

STILL = [
    "go five", "drive over there", "go to the kitchen", "turn by 20 metres", "rotate to the left by 3 metres",
    "go forward or backward", "go forward backward 1 m", "go 1e309 metres", "turn NaN degrees",
    "go forward -1 m",
    "forward until the um until the", "do that again, only bigger", "asdf qwer", "go forward 1 m 2 m",
    "🙂", "\x00",
    "turn left and mow the lawn", "drive 1 m and grab the cup", "if the door is open go forward 1 m",
    "follow the wall",
    "don't go forward", "go forward 1 m unless there is someone", "north 2 m", "走20", "去那边",
    "前进后退一米",
    "跟着墙走一米", "如果前面有人就前进一米", "前进一米然后唱首歌", "别往前走", "左转无限度",
    "前进负一米", "你跑多快",
]  # fmt: skip


@pytest.mark.parametrize("text", STILL)
def test_does_not_move(text: str) -> None:
    talk = Conversation()
    meant = talk.say(text)
    assert meant.plan is None
    assert meant.outcome in ("unclear", "refused", "answered", "stop")
    assert meant.reply


def test_names_the_part_it_cannot_account_for_in_the_language_of_the_question() -> None:
    english = Conversation().say("go forward 1 m and blorp the frobnicator")
    assert "blorp" in english.unaccounted
    assert "blorp" in english.reply
    chinese = Conversation().say("前进一米然后阿巴阿巴")
    assert chinese.outcome == "unclear"
    assert chinese.language == "zh"
    assert "没听懂" in chinese.reply


def test_a_hundred_kilobytes_are_answered_at_once() -> None:
    interpreter = OfflineInterpreter(MECANUM)
    began = time.perf_counter()
    meant = interpreter.interpret("go forward " * 10_000, Context())
    assert meant.outcome == "unclear"
    assert time.perf_counter() - began < 0.05


@settings(max_examples=150, deadline=None)
@given(st.text(max_size=200))
def test_no_text_raises(text: str) -> None:
    assert OfflineInterpreter(MECANUM).interpret(text, Context()).reply


WORDS = [
    "go",
    "turn",
    "left",
    "right",
    "forward",
    "1",
    "m",
    "90",
    "degrees",
    "then",
    "and",
    ",",
    ".",
    "twice",
    "no",
    "sorry",
    "back",
    "again",
    "half",
    "of",
    "a",
    "square",
    "until",
    "前进",
    "一",
    "米",
    "左转",
    "再",
    "两",
    "次",
    "不",
    "停",
    "秒",
]


@settings(max_examples=100, deadline=None)
@given(st.lists(st.sampled_from(WORDS), max_size=14))
def test_no_salad_of_known_words_raises(words: list[str]) -> None:
    assert OfflineInterpreter(MECANUM).interpret(" ".join(words), Context()).reply
