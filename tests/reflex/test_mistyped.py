"""While the robot moves, a stop with one mistake in it counts; an ordinary word does not."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.reflex import is_stop, leads_with_stop
from chatrobot.reflex.stop import MOST_UNITS, Mistyped, is_one_edit, phrases, units_of
from chatrobot.reflex.words import ALL, BY_LANGUAGE

MISTYPED = [
    "pleas stopp", "That'll do, knock it off", "stp", "stpp", "dtop", "hatl", "wiat", "freze", "hodl on", "holdon",
    "stopmoving", "st op", "sto pit", "plese stpo now", "nevr mind", "enogh", "kil the motors", "pleasee haltt thnaks",
    "sstop, go back", "Robot, plaese hlat!", "don't mvoe", "emergancy stop", "stay thhere", "qiut", "st0p",
    "stpp, the cat is there", "stpp, turn left, then right",
    "停直", "赞停", "布动", "请站主", "别冻了", "等灯", "沾住别动",
]  # fmt: skip
NOT_MISTYPED = [
    "step", "shop", "stoop", "slop", "hold", "gold", "fold", "want", "bait", "atop", "spot", "quiet", "quite", "half",
    "salt", "pasta", "about", "cancer", "freezer", "still", "small", "go to the kichten", "turn lfet",
    "don't stpo", "dno't stop", "never stpo", "not stpp", "hold the door", "the shop", "please step",
    "挺直", "不懂", "我不懂", "听一听", "助手", "步行", "写着", "快艇", "中指", "停车场", "不停", "停电", "定位",
]  # fmt: skip
STOP_WORDS = {
    "en": {
        "arrest", "cancel", "emergency", "enough", "freeze", "moment", "pause", "quit",
    },
    "de": {
        "aufhören", "aus", "genug", "halt", "moment", "pause", "reicht", "schluss", "warte", "warten",
        "wo",
    },
    "zh": {
        "不动", "不行", "不要", "中断", "中止", "休", "停", "停下", "停止", "停车", "停顿", "别", "刹车",
        "取消", "定", "放弃", "暂停", "止步", "站住", "站着", "等等", "终止",
    },
}  # fmt: skip
"""Of the common words, those that stop. German "wo" (where) is an English "whoa": only as a whole utterance."""


@pytest.mark.parametrize("text", MISTYPED)
def test_a_mistyped_stop_halts_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text)


@pytest.mark.parametrize("text", NOT_MISTYPED)
def test_a_word_of_its_own_is_no_mistyped_stop(text: str) -> None:
    assert not leads_with_stop(text)


def test_a_standing_robot_takes_no_mistyped_stop() -> None:
    assert not is_stop("stpp")
    assert not is_stop("停直")


@pytest.mark.parametrize("language", ["en", "zh", "de"])
def test_no_common_word_stops_but_for_stop_words(language: str) -> None:
    path = Path(__file__).parent / "data" / f"common_words_{language}.txt"
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    words = {word for line in lines for word in line.split()}
    assert len(words) > 2000
    assert {word for word in words if leads_with_stop(word)} == STOP_WORDS[language]


def test_no_instruction_of_the_corpora_looks_like_a_mistyped_stop() -> None:
    for path in (Path(__file__).parent.parent / "corpus").glob("*.yaml"):
        for item in yaml.safe_load(path.read_text(encoding="utf-8")):
            if item["category"] in ("move", "turn", "arc", "shape", "twist", "sequence"):
                for text in item.get("turns") or [item["say"]]:
                    assert not leads_with_stop(text), text


def made_anew(text: str) -> bool:
    """Whether `text` is a mistyped stop to who knows a few phrases only."""
    stops = phrases(("halt now", "quit", "off", "站住", "停", "龘住"))
    fillers = phrases(("please", "谢谢"))
    return Mistyped(stops, fillers, phrases(("hqlt",))).covers(units_of(text))


@pytest.mark.parametrize(
    "text",
    ["quit", "qiut", "qu it", "halt nwo", "ha lt now", "plese quit", "qiut plese", "plese qiut, plese halt nwo",
     "沾住", "谢谢，沾住", "沾住 qiut", "停", "quit " * MOST_UNITS],
)  # fmt: skip
def test_phrases_are_learned_with_what_may_stand_beside_them(text: str) -> None:
    assert made_anew(text) is True


@pytest.mark.parametrize(
    "text",
    ["", "please", "plese", "plese plese", "谢谢", "写写", "听", "齉住", "占住", "of", "offf it", "hqlt now",
     "halo nwo", "quit the", "the quit", "qiut the", "qiutt", "q u it", "quit " * (MOST_UNITS + 1)],
)  # fmt: skip
def test_nothing_else_is_learned(text: str) -> None:
    assert made_anew(text) is False


_LONG = [
    phrase
    for phrase in (
        " ".join(units_of(phrase)) for phrase in (*BY_LANGUAGE["en"].stop, *BY_LANGUAGE["en"].pause)
    )
    if sum(letter.isalpha() for letter in phrase) >= 4
]


@given(st.sampled_from(_LONG), st.integers(0, 60), st.sampled_from("jqxz"), st.sampled_from(["", "please "]))
def test_a_letter_too_many_hides_no_stop(phrase: str, at: int, letter: str, before: str) -> None:
    """No English word is made of a stop phrase by one of these letters, but for those that are known."""
    at = at % (len(phrase) + 1)
    typed = phrase[:at] + letter + phrase[at:]
    if not set(typed.split()) <= {*ALL.real_words}:
        assert leads_with_stop(before + typed) or "not" in typed or "n't" in typed


@given(st.text(alphabet="abc", max_size=6), st.integers(0, 6), st.sampled_from("abc"))
def test_one_edit_is_an_insertion_a_deletion_a_substitution_or_a_swap(
    text: str, at: int, letter: str
) -> None:
    at = at % (len(text) + 1)
    edits = {text[:at] + letter + text[at:], text[:at] + text[at + 1 :], text[:at] + letter + text[at + 1 :]}
    edits.add(text[:at] + text[at : at + 2][::-1] + text[at + 2 :])
    for edited in edits - {text}:
        assert is_one_edit(edited, text)
        assert is_one_edit(text, edited)
    assert not is_one_edit(text, text)
    assert not is_one_edit(text, text + "xx")


@pytest.mark.parametrize(
    "text", ["pleasf " * 40, "wall. boy; now, " * 18, "停直" * 150, "kichten " * 37, "定 " * 150]
)
def test_a_long_text_is_judged_at_once(text: str) -> None:
    leads_with_stop("warm")
    began_s = time.perf_counter()
    leads_with_stop(text)
    assert time.perf_counter() - began_s < 0.05
