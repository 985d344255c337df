"""A pause is a stop that keeps what was under way; where it is not sure, it is a stop like any other."""

from __future__ import annotations

import pytest

from chatrobot.reflex import is_emergency_stop, is_pause, is_stop, leads_with_stop
from chatrobot.reflex.words import ALL


@pytest.mark.parametrize("phrase", ALL.pause)
def test_every_pause_word_stops_as_well(phrase: str) -> None:
    assert is_pause(phrase)
    assert is_stop(phrase)
    assert leads_with_stop(phrase)
    assert not is_emergency_stop(phrase)


@pytest.mark.parametrize(
    "text",
    ["Please pause now", "hold on a second", "wait, please", "PAUSE!!", "puase", "hodl on", "wait for a moment",
     "请等一下", "等等等一下", "赞停", "pause " * 50],
)  # fmt: skip
def test_a_pause_may_be_polite_or_mistyped(text: str) -> None:
    assert is_pause(text)
    assert leads_with_stop(text)


@pytest.mark.parametrize(
    "text",
    ["stop", "wait, stop", "hold on, there's a cat", "no, wait", "halt", "enough", "wait, go back", "cancel", "停",
     "等等，停下", "别动", "emergency stop", "", "go on", "want", "pause" * 80, "pause " * 51],
)  # fmt: skip
def test_what_may_mean_more_is_no_pause(text: str) -> None:
    assert not is_pause(text)


@pytest.mark.parametrize("text", ["停车场", "不停", "停电", "别的", "定位"])
def test_a_longer_word_is_no_stop(text: str) -> None:
    assert not is_stop(text)
    assert not leads_with_stop(text)


@pytest.mark.parametrize(
    "text",
    [
        "stop for now",
        "halt for now and turn left later",
        "stop for a second, then left",
        "stop it for god's sake",
    ],
)
def test_for_does_not_make_a_pause_of_every_stop(text: str) -> None:
    assert leads_with_stop(text)
    assert not leads_with_stop("stop for three seconds")
