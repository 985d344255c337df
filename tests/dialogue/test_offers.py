"""What is offered instead of a refused plan is what a yes drives: rehearsed, within the limit, whoever wrote it."""

from __future__ import annotations

import pytest
from tests.dialogue.scripted_model import ModelTalk, Options
from tests.dialogue.talk import Talk

from chatrobot.core.events import Result
from chatrobot.robots.profile import MotionBudget


def test_what_is_offered_is_within_the_limit_and_says_so() -> None:
    talk = Talk(world="home", budget=MotionBudget(1.0))
    asked = talk.session.do("forward 5 m")
    assert asked.proposal is not None
    assert asked.proposal.plan_text == "drive 1 m"
    assert asked.reply.endswith(
        "2.65 m are free. 1 m may still be driven (/limit). Shall I drive forward 1 m?"
    )
    done = talk.session.do("yes")
    assert (done.outcome, done.path_m) == ("completed", pytest.approx(1.0, abs=0.01))


@pytest.mark.parametrize(
    ("budget", "text", "offered"),
    [
        (MotionBudget(0.7), "forward 50 cm, then forward 5 m", "drive 0.5 m\ndrive 0.2 m"),
        (MotionBudget(0.45), "forward 50 cm, then forward 5 m", "drive 0.45 m"),
        (MotionBudget(None, 3.0), "forward 5 m", "drive 0.8 m"),
        (MotionBudget(0.05), "forward 5 m", None),
        (MotionBudget(), "forward 5 m", "drive 2.65 m"),
    ],
)
def test_each_limit_bounds_the_whole_of_what_is_offered(
    budget: MotionBudget, text: str, offered: str | None
) -> None:
    talk = Talk(world="home", budget=budget)
    asked = talk.session.do(text)
    assert asked.outcome == "refused"
    assert (asked.proposal.plan_text if asked.proposal else None) == offered
    if offered:
        assert talk.session.do("yes").outcome == "completed"


def test_the_way_to_the_nearest_free_point_is_within_the_limit_too() -> None:
    talk = Talk(world="home", budget=MotionBudget(0.5))
    turn = talk.session.say_plan("go to 4.5 0.7")
    talk.pump_until(lambda: turn in talk.results())
    asked = talk.results()[turn]
    assert asked.outcome == "refused"
    if asked.proposal is not None:
        done = talk.session.do("yes")
        assert (done.outcome, done.path_m <= 0.51) == ("completed", True)


def test_the_way_that_is_told_is_what_can_be_driven_before_it_is_too_near() -> None:
    asked = Talk(world="home").session.do("forward 5 m")
    assert asked.reply.startswith("That would come within 0.04 m of the kitchen wall after 2.66 m")
    assert asked.reason is not None
    assert asked.proposal is not None
    driven_m = float(asked.proposal.plan_text.split()[1])
    total_m = float(asked.reason.values["total_m"])
    assert driven_m <= total_m <= driven_m + 0.06


# --- plans of models ---


def refused(*replies: str, **setup: object) -> tuple[ModelTalk, Result]:
    talk = ModelTalk(*replies, world="home", **setup)
    return talk, talk.do("please do something nice")


@pytest.mark.parametrize("options", [Options(), Options(approve_models=True)])
def test_a_models_plan_that_is_refused_offers_what_is_free(options: Options) -> None:
    talk, asked = refused("drive 5 m\n", options=options)
    assert asked.outcome == "refused"
    assert asked.proposal is not None
    assert asked.proposal.plan_text == "drive 2.65 m"
    assert asked.reply.endswith("2.65 m are free. Shall I drive forward 2.65 m?")
    done = talk.do("yes")
    assert (done.outcome, done.path_m) == ("completed", pytest.approx(2.65, abs=0.01))


def test_after_the_steps_that_were_done_the_free_part_of_the_next_is_offered() -> None:
    talk, asked = refused("drive 1 m\ndrive 5 m\n", "drive 5 m\n")
    assert asked.outcome == "refused"
    assert asked.path_m == pytest.approx(1.0, abs=0.01)
    assert asked.proposal is not None
    assert asked.proposal.plan_text == "drive 1.65 m"
    assert talk.do("yes").pose.x_m == pytest.approx(2.65, abs=0.02)


def test_a_models_plan_beyond_the_limit_offers_nothing() -> None:
    _, asked = refused("drive 2 m\n", budget=MotionBudget(1.0))
    assert asked.outcome == "refused"
    assert asked.proposal is None


@pytest.mark.parametrize("said", ["go on", "weiter", "continue", "继续"])
def test_go_on_after_an_offer_asks_again_and_drives_nothing_of_before(said: str) -> None:
    talk = Talk(world="home")
    talk.do("30 cm back")
    offer = talk.do("forward 9 m").proposal
    again = talk.do(said)
    assert again.outcome == "unclear"
    assert again.proposal == offer
    assert talk.do("yes").outcome == "completed"
