"""A way that is denied is not driven."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Turn
from chatrobot.plan.text import parse_plan
from tests.language.dialogue_runner import Conversation, conversation


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


@pytest.mark.parametrize(
    "said",
    [
        "前进一米，不对，别走", "前进一米，算了别走", "前进一米，等等，别走", "前进一米，哦不，不走了",
        "前进一米，停，别走",
        "往前走一米，千万别走", "前进一米，不，停", "往前走一米，不是，我不是让你走", "向左平移，啊不，停下",
        "go forward 1 m, no wait, don't go", "go forward 1 m, never mind, don't move",
    ],
)  # fmt: skip
def test_an_order_that_is_taken_back_at_once_is_neither_driven_nor_proposed(said: str) -> None:
    meant = Conversation().say(said)
    assert meant.plan is None
    assert meant.proposal is None


@pytest.mark.parametrize(
    "said", ["前进一米，别走太快", "别走，后退一米", "往左平移半米，别转", "前进一米，然后别动"]
)
def test_what_only_bounds_an_order_takes_nothing_back(said: str) -> None:
    assert Conversation().say(said).plan is not None


@pytest.mark.parametrize(
    "denial", ["don't move", "do not move", "please don't move", "unit four, do not move"]
)
@pytest.mark.parametrize(
    "way", ["forward", "left", "back", "to the right", "a metre ahead", "1 m", "in a circle"]
)
def test_to_stand_still_with_a_way_behind_it_denies_the_motion(denial: str, way: str) -> None:
    assert Conversation().say(f"{denial} {way}").plan is None


@pytest.mark.parametrize("text", ["别动往前", "别动一米", "不要动往左", "nicht bewegen vorwärts"])
def test_a_denied_way_moves_nothing_in_other_languages(text: str) -> None:
    assert Conversation().say(text).plan is None


def test_to_stand_still_for_a_time_is_still_a_wait() -> None:
    assert Conversation().say("don't move for 5 s, then forward 1 m").plan == parse_plan(
        "wait 5 s\ndrive 1 m"
    )


@pytest.mark.parametrize(
    ("denied", "order", "plan"),
    [
        ("don't turn left", "forward 1 m", "drive 1 m"),
        ("do not go back", "90 degrees to the left", "turn left 90 deg"),
        ("别往左转", "前进一米", "drive 1 m"),
        ("nicht nach links drehen", "1 m vorwärts", "drive 1 m"),
    ],
)
def test_what_is_ordered_instead_has_nothing_of_what_was_denied(denied: str, order: str, plan: str) -> None:
    assert conversation(denied).say(order).plan == parse_plan(plan)


@pytest.mark.parametrize(
    "said",
    [
        "oh no, don't turn left", "no no no, don't back up", "no don't turn left", "nope, don't go forward",
        "no no no, don't you go backing up, there's a hole behind you",
        "ach nein, nicht nach links drehen", "哎呀不对，不要左转",
    ],
)  # fmt: skip
def test_what_is_said_before_a_denial_makes_no_order_of_it(said: str) -> None:
    assert Conversation().say(said).plan is None


@pytest.mark.parametrize(
    "said",
    ["oh no, don't turn left, turn right", "go left, no, not left, right", "turn left, no not left, right"],
)
def test_what_follows_a_denial_is_done_alone(said: str) -> None:
    assert Conversation().say(said).plan == parse_plan("turn right 90 deg")
