"""A way that is denied is not driven."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Turn
from tests.language.dialogue_runner import Conversation


@pytest.mark.parametrize(
    "said",
    [
        "left, not right, 90 degrees",
        "turn left instead of right 90 degrees",
        "turn left as opposed to right, 90 degrees",
        "turn left 90 degrees rather than right",
        "turn left, and not right, 90 degrees",
        "左转90度，对，就是左转，可不是右转啊",
        "左转90度，可不是右转",
        "左转90度，并不是右转",
        "左转90度，而非右转",
        "向左转90度，可别右转",
    ],
)
def test_the_way_that_is_denied_is_not_driven(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    (step,) = plan.steps
    assert isinstance(step, Turn)
    assert step.left
    assert step.angle_rad == pytest.approx(math.pi / 2)


@pytest.mark.parametrize("said", ["左转，不是右转，90度", "往左，不是往右，转90度", "左转90度，不是右转"])
def test_a_way_that_may_be_denied_or_put_right_is_asked_about(said: str) -> None:
    assert Conversation().say(said).outcome == "unclear"


def test_a_question_that_denies_forbids_nothing() -> None:
    assert Conversation().say("don't you turn left?").code == "nothing_to_do"
    assert Conversation().say("don't turn left").code == "only_forbidden"
