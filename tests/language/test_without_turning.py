"""Going without turning: never along a curve. And wishes put as questions: never answered with a fact."""

from __future__ import annotations

import pytest

from chatrobot.plan.steps import Drive
from tests.language.dialogue_runner import Conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    "said",
    [
        "Nudge yourself 30 cm across to the right, no turning.",
        "Shift right by 30 cm while holding your heading.",
        "slide 30 cm right so that you never turn",
        "could you shuffle over to the right 30 cm? keep looking straight",
        "slide right 30 cm, doing 10 cm every second",
        "30 cm to starboard, sideways, no turning. Go.",
    ],
)
def test_it_slides(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert len(plan.steps) == 1
    only = plan.steps[0]
    assert isinstance(only, Drive)
    assert only.distance_m == pytest.approx(0.3)
    assert only.direction_rad < 0


def test_to_slide_while_turning_is_asked_about() -> None:
    assert Conversation().say("slide left 1 m while turning right 90 degrees").outcome == "unclear"


def test_a_favour_that_is_not_understood_is_asked_about_not_answered() -> None:
    assert Conversation().say("could you flurb over to the left facing me?").outcome == "unclear"
    assert Conversation().say("could you tell me where you are?").outcome == "answered"


@pytest.mark.parametrize(
    "said",
    ["turn right 30 degrees and then drive two metres that way", "turn to face left, then 2 m towards it"],
)
def test_that_way_is_where_it_looks_after_a_turn(said: str) -> None:
    assert Conversation().say(said).outcome == "plan"
    assert Conversation().say("drive two metres that way").outcome == "unclear"


def test_drawn_out_words_are_words() -> None:
    assert Conversation().say("let's gooo, straight aheaaad").outcome == "plan"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("slide one metre left, nose stays pointing where it is", "drive 1 m left"),
        ("half a metre to the left without any rotation of the chassis", "drive 0.5 m left"),
        ("go 1 m to the right looking at the same direction as now", "drive 1 m right"),
        ("Move 40 cm right and keep your nose straight ahead", "drive 0.4 m right"),
        ("einen Meter nach links, aber die Blickrichtung so lassen", "drive 1 m left"),
        ("50 cm nach rechts, aber so, dass du weiter nach vorn schaust", "drive 0.5 m right"),
        ("Einen Meter nach links rüber. Drehen brauchst dich dabei nicht", "drive 1 m left"),
        ("往右横着走1米，面朝的方向跟现在一样", "drive 1 m right"),
        ("One metre toward front-left, at exactly 45 degrees", "drive 1 m toward 45 deg"),
        ("one metre at 45 degrees toward the rear right, without rotating", "drive 1 m toward -135 deg"),
        ("schräg nach vorne links raus, 45 Grad, einen Meter weit", "drive 1 m toward 45 deg"),
        ("turn to the front left, 45 degrees", "turn left 45 deg"),
        ("end up 2 m ahead and 1 m left of where you are", "drive 2 m; drive 1 m left"),
    ],
)
def test_what_only_says_that_the_heading_stays_is_no_motion(said: str, plan: str) -> None:
    assert done(said) == plan


@pytest.mark.parametrize(
    "said",
    ["my nose stays pointing where it is", "Drehen brauchst du dich nicht"],
)
def test_a_heading_that_stays_orders_nothing(said: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is None
