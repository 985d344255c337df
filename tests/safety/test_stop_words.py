"""What decides between a stop and none, where one careless change would make a robot drive on."""

from __future__ import annotations

import pytest

from chatrobot.reflex import is_emergency_stop, is_release, is_stop, leads_with_stop


@pytest.mark.parametrize(
    "text",
    [
        "don’t move", "sttoop", "ｓｔｏｐ", "stop " * 60, "drive left, stop, never mind", "往前……再往左，算了",
        "drive left — drive right — never mind", "drive left, halt, halt, never mind",
    ],
)  # fmt: skip
def test_is_a_stop(text: str) -> None:
    assert is_stop(text) is True
    assert leads_with_stop(text) is True


@pytest.mark.parametrize(
    "text",
    [
        "stop " * 60 + "x", "", "...", "go on, never mind, go left", "drive left, drive right, never mind",
        "never mind, go left",
    ],
)  # fmt: skip
def test_is_no_stop_as_a_whole(text: str) -> None:
    assert is_stop(text) is False


@pytest.mark.parametrize(
    "text",
    [
        "hey robot stop turning left and go", "please right now stop and go left", "stop" + " " * 400,
        "stop for", "stop for now and turn left", "stop for a moment of peace", "stop for god's sake turn left",
        "stop for heaven's sake go back", "go left, don't go", "go left, turn right, don't go",
    ],
)  # fmt: skip
def test_halts_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text) is True


@pytest.mark.parametrize(
    "text",
    [
        "please", "please right now", "go on, don't stop", "no don't", "drive left, drive right",
        "go left, don't go, turn right", "stop for minutes", "stop for two seconds", "stop 2 s", "stop lights ahead",
        "go left, please do not stop", "一直走，别停",
    ],
)  # fmt: skip
def test_does_not_halt_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text) is False


def test_emergency_words_may_stand_among_stops_and_fillers_and_nothing_else() -> None:
    assert is_emergency_stop("halt! emergency stop!")
    assert is_emergency_stop("please, emergency stop now")
    assert is_emergency_stop("mayday " * 42)
    assert is_emergency_stop("emergency stop".ljust(300))
    for text in ("", "emergency stop, then go left", "halt", "mayday " * 43, "where is the emergency exit"):
        assert is_emergency_stop(text) is False


def test_a_release_is_nothing_but_a_release() -> None:
    assert is_release("release the emergency stop")
    assert is_release("") is False
    assert is_release("release the emergency stop and drive") is False
    assert is_release("release the hounds") is False
