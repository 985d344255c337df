"""The sentence at the end of a turn is a sentence."""

from __future__ import annotations

import re

import pytest

from chatrobot.core.events import Finished, Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import describe_end
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.context import Context, RobotState
from chatrobot.language.data_files import load_table
from chatrobot.language.phrases import say
from chatrobot.language.questions import answer
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.sim.load import load_world

BLOCKED = Reason("does_not_move", {"asked_m": "0.50", "asked_deg": "0", "seen_m": "0.00", "seen_deg": "0"})


def ended(outcome: Outcome, reason: Reason | None, turned_rad: float = 0.0) -> Finished:
    return Finished(1, outcome, reason, ORIGIN, ORIGIN, turned_rad, 0.5, 2.0, 0.0, 1.0, 0.1)


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_reason_that_asks_is_not_ended_twice(language: str) -> None:
    reply = describe_end(ended("failed", BLOCKED), language)
    assert "?." not in reply
    assert "？。" not in reply
    assert "?" in reply or "？" in reply


@pytest.mark.parametrize("language", ["en", "zh"])
def test_nothing_is_said_to_be_less_than_nothing(language: str) -> None:
    context = Context(state=RobotState(pose=Pose(-0.001, -0.004, -0.001)))
    profile = load_profile(DEFAULT_PROFILE)
    assert "-0" not in answer("position", language, context, profile)
    assert "-0" not in describe_end(ended("completed", None, turned_rad=-0.0001), language)


def test_what_is_less_than_nothing_keeps_its_sign() -> None:
    assert say("en", "turned", turned_deg="-0.5") == "turned -0.5°"


@pytest.mark.parametrize(
    ("pose", "en", "zh"),
    [
        (
            Pose(-1.36, 0.0, 0.0),
            "I am 1.36 m behind where I started, not turned.",
            "我在出发点后方 1.36 米，没有转向。",
        ),
        (
            Pose(1.0, 0.0, 1.5708),
            "I am 1.00 m ahead of where I started, turned 90° to the left.",
            "我在出发点前方 1.00 米，向左转了 90°。",
        ),
        (
            Pose(-0.001, -0.5, -0.5),
            "I am 0.50 m to the right of where I started, turned 29° to the right.",
            "我在出发点右边 0.50 米，向右转了 29°。",
        ),
        (
            Pose(-1.0, 0.25, 0.0),
            "I am 1.00 m behind and 0.25 m to the left of where I started, not turned.",
            "我在出发点后方 1.00 米、左边 0.25 米，没有转向。",
        ),
        (
            Pose(2.0, -0.25, 0.0),
            "I am 2.00 m ahead and 0.25 m to the right of where I started, not turned.",
            "我在出发点前方 2.00 米、右边 0.25 米，没有转向。",
        ),
        (ORIGIN, "I am right where I started, not turned.", "我在出发点，没有转向。"),
    ],
)
def test_where_it_is_is_told_by_sides_and_not_by_signs(pose: Pose, en: str, zh: str) -> None:
    context, profile = Context(state=RobotState(pose=pose)), load_profile(DEFAULT_PROFILE)
    assert answer("position", "en", context, profile) == en
    assert answer("position", "zh", context, profile) == zh
    for language in ("en", "zh"):
        assert "-" not in answer("heading", language, context, profile)


def test_a_turn_is_told_by_its_side() -> None:
    assert describe_end(ended("completed", None, -1.5708), "en").endswith("turned 90.0° right.")
    assert describe_end(ended("completed", None, 1.5708), "en").endswith("turned 90.0° left.")
    assert describe_end(ended("completed", None, -1.5708), "zh").endswith("向右转了 90.0°。")


@pytest.mark.parametrize("value", [1.9000000000000001, 29.773198144942803, -9.8e-07, 2.6609999999999996])
@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_sentence_has_float_noise_in_it(language: str, value: float) -> None:
    """Every phrase, with every value it takes set to a number as floats leave it."""
    for table in ("phrases", "outcomes"):
        for code, template in load_table(language, table).items():
            names = re.findall(r"\{(\w+)", template)
            sentence = say(language, code, **dict.fromkeys(names, value))
            assert not re.search(r"\d\.\d{4,}|\de-\d", sentence), f"{code}: {sentence}"


@pytest.mark.parametrize(
    ("language", "doubt"),
    [("en", "may still be moving"), ("de", "fährt vielleicht noch"), ("zh", "可能还在动")],
)
def test_a_stop_that_cannot_reach_the_robot_is_not_told_as_one(language: str, doubt: str) -> None:
    """A base that holds its last command drives on while the connection is gone."""
    understanding = Understanding(load_profile(DEFAULT_PROFILE), load_world("empty"), None)
    understanding.note_notice("wire_gone")
    for code in ("stopped_now", "emergency_stopped"):
        assert doubt in say(language, understanding.stop_code(code))
    assert doubt in describe_end(ended("failed", Reason("wire_gone")), language)
    understanding.note_notice("wire_back")
    assert understanding.stop_code() == "stopped_now"
