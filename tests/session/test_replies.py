"""The sentence at the end of a turn is a sentence."""

from __future__ import annotations

import pytest

from chatrobot.core.events import Finished, Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.language.context import Context, RobotState
from chatrobot.language.phrases import say
from chatrobot.language.questions import answer
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.session.replies import describe_end

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
    context = Context(state=RobotState(pose=Pose(-0.05, 0.0, 0.0)))
    assert "-0.05 m" in answer("position", "en", context, load_profile(DEFAULT_PROFILE))
    assert say("en", "turned", turned_deg="-0.5") == "turned -0.5°"
