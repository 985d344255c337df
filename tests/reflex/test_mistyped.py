"""While the robot moves, a stop with one mistake in it counts; an ordinary word does not."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.reflex import is_stop, leads_with_stop, words_en, words_zh
from chatrobot.reflex.mistyped import is_one_edit
from chatrobot.reflex.phrases import units_of
from chatrobot.reflex.real_words_en import WORDS

MISTYPED = [
    "pleas stopp", "That'll do, knock it off", "stp", "stpp", "dtop", "hatl", "wiat", "freze", "hodl on", "holdon",
    "stopmoving", "st op", "sto pit", "plese stpo now", "nevr mind", "enogh", "kil the motors", "pleasee haltt thnaks",
    "sstop, go back", "Robot, plaese hlat!", "don't mvoe", "emergancy stop", "stay thhere", "qiut", "st0p",
    "停直", "赞停", "布动", "请站主", "别冻了", "等灯", "沾住别动",
]  # fmt: skip
NOT_MISTYPED = [
    "step", "shop", "stoop", "slop", "hold", "gold", "fold", "want", "bait", "atop", "spot", "quiet", "quite", "half",
    "salt", "pasta", "about", "cancer", "freezer", "still", "small", "go to the kichten", "turn lfet",
    "don't stpo", "dno't stop", "never stpo", "not stpp", "hold the door", "the shop", "please step",
    "挺直", "不懂", "我不懂", "听一听", "助手", "步行", "写着", "快艇", "中指", "停车场", "不停", "停电", "定位",
]  # fmt: skip
STOP_WORDS = {
    "en": {"arrest", "cancel", "emergency", "enough", "freeze", "pause", "quit"},
    "zh": {
        "定",
        "别",
        "停",
        "休",
        "不要",
        "停止",
        "停下",
        "停车",
        "放弃",
        "取消",
        "等等",
        "站住",
        "站着",
        "中断",
        "中止",
        "终止",
        "止步",
        "停顿",
        "不行",
        "不动",
        "刹车",
        "暂停",
    },
}


@pytest.mark.parametrize("text", MISTYPED)
def test_a_mistyped_stop_halts_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text)


@pytest.mark.parametrize("text", NOT_MISTYPED)
def test_a_word_of_its_own_is_no_mistyped_stop(text: str) -> None:
    assert not leads_with_stop(text)


def test_a_standing_robot_takes_no_mistyped_stop() -> None:
    assert not is_stop("stpp")
    assert not is_stop("停直")


@pytest.mark.parametrize("language", ["en", "zh"])
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


_LONG = [
    phrase
    for phrase in (" ".join(units_of(phrase)) for phrase in words_en.STOP)
    if sum(letter.isalpha() for letter in phrase) >= 4
]


@given(st.sampled_from(_LONG), st.integers(0, 60), st.sampled_from("jqxz"), st.sampled_from(["", "please "]))
def test_a_letter_too_many_hides_no_stop(phrase: str, at: int, letter: str, before: str) -> None:
    """No English word is made of a stop phrase by one of these letters, but for those that are known."""
    at = at % (len(phrase) + 1)
    typed = phrase[:at] + letter + phrase[at:]
    if not set(typed.split()) <= {*WORDS.split()}:
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


def test_every_listed_word_is_there_once() -> None:
    assert len(WORDS.split()) == len({*WORDS.split()})
    for table in (words_en.PAUSE, words_zh.PAUSE):
        assert len(table) == len({*table})
