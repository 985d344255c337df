"""Stop words are found as words and phrases, not as substrings."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from chatrobot.reflex import is_emergency_stop, is_pause, is_release, is_stop, leads_with_stop, stop
from chatrobot.reflex.stop import phrases

STOPS = [
    "stop", "STOP!!", "stpo", "sotp", "stoooop", "halt!!", "please stop now", "freeze", "whoa",
    "that's enough",
    "hold it right there", "don't move", "never mind, stop", "cut the motors", "停", "停下来", "停知",
    "婷", "别动", "快停下！",
    "停車", "刹车刹车", "往前……算了算了，别走了", "往前走两米，算了", "go forward... never mind",
]  # fmt: skip
NO_STOPS = [
    "stop-sign shape", "停一秒", "don't stop", "non-stop", "drive to the bus stop",
    "stop for two seconds then go on",
    "别停", "不要停", "停一秒再走", "drive forward 1 m. Stop.", "go 2 m and stop",
    "don't turn left. turn right.", "",
    "往前走一米然后停下", "unstoppable", "cancel my subscription",
]  # fmt: skip


@pytest.mark.parametrize("text", STOPS)
def test_is_a_stop(text: str) -> None:
    assert is_stop(text)
    assert leads_with_stop(text)


@pytest.mark.parametrize("text", NO_STOPS)
def test_is_no_stop(text: str) -> None:
    assert not is_stop(text)


@pytest.mark.parametrize(
    "text", ["stop, go back", "stop turning left", "halt and wait there", "停，后退一米"]
)
def test_a_leading_stop_halts_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text)
    assert not is_stop(text) or text == "halt and wait there"


@pytest.mark.parametrize("text", ["stop-sign shape", "停一秒", "stop for two seconds", "don't stop", "别停"])
def test_a_pause_or_a_noun_does_not_lead(text: str) -> None:
    assert not leads_with_stop(text)


def test_an_emergency_stop_is_a_stop_too_but_not_the_other_way_round() -> None:
    for text in ("emergency stop!", "E-STOP", "急停！", "紧急停止", "緊急停車"):
        assert is_emergency_stop(text)
        assert is_stop(text)
    assert not is_emergency_stop("stop")
    assert not is_emergency_stop("停")


def test_a_stop_may_stand_beside_an_emergency_stop() -> None:
    assert is_emergency_stop("stop stop emergency stop")
    assert not is_emergency_stop("emergency stop and turn left")


@pytest.mark.parametrize(
    "text",
    [
        "go forward. turn left. never mind. forget it",
        "go forward. turn left. go back. never mind. forget it",
        "go forward. turn left. never mind. stop. forget it",
    ],
)
def test_one_command_may_be_taken_back_and_no_more(text: str) -> None:
    """Which of several is meant, nobody can say."""
    assert not is_stop(text)
    assert is_stop("go forward. never mind. forget it")


def test_phrases_are_found_by_their_first_word() -> None:
    assert phrases(("stop", "stop it"), ("停下",)) == {
        "stop": {("stop",), ("stop", "it")},
        "停": {("停", "下")},
    }


def test_release_has_its_own_words() -> None:
    assert is_release("release the emergency stop")
    assert is_release("解除急停")
    assert not is_release("stop")


@pytest.mark.parametrize(
    "text", ["please release the estop now, thank you", "麻烦把急停解除一下吧", "Unlock!"]
)
def test_a_release_may_be_polite(text: str) -> None:
    assert is_release(text)


@pytest.mark.parametrize(
    "text",
    [
        "release the emergency stop 不", "解除急停 不", "no, release the emergency stop", "不解除急停", "解除急停吗",
        "release the emergency stop, wait", "release the emergency stop, there's a child", "release me",
        "don't release the emergency stop", "别解除急停", "release the emergency stop? danger!",
        "release" + " please" * 41 + "       " + "is what I would never ever say to it",
    ],
)  # fmt: skip
def test_what_may_mean_the_opposite_releases_nothing(text: str) -> None:
    assert not is_release(text)


def test_in_the_corpora_exactly_the_stop_items_are_stops() -> None:
    for path in (Path(__file__).parent.parent / "corpus").glob("*.yaml"):
        for item in yaml.safe_load(path.read_text(encoding="utf-8")):
            for text in item.get("turns") or [item["say"]]:
                assert is_stop(text) == (item["category"] == "stop"), item["id"]


def test_a_release_is_short() -> None:
    just = "release" + " please" * 41 + "      "
    assert len(just) == 300
    assert is_release(just)
    assert not is_release(just + " ")


@pytest.mark.parametrize("text", ["stop", "please stop", "halt", "STOP!!", "停", "快停下", "stopp"])
def test_a_plain_stop_waits_for_no_table_of_mistyped_words(
    text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They take 30 ms to make, once: the first stop of a process would be that much later."""

    def too_early() -> None:
        raise AssertionError("made before the stop is out")

    monkeypatch.setattr(stop, "_mistyped_stop", too_early)
    monkeypatch.setattr(stop, "_mistyped_pause", too_early)
    assert (is_stop(text), leads_with_stop(text), is_pause(text)) == (True, True, False)
