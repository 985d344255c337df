"""Questions about the robot and about what it did are answered by what is known, and move nothing."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from chatrobot.core.wiring import Wiring
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.ledger import TurnRecord
from chatrobot.plan.text import parse_plan
from chatrobot.robots.load import load_profile
from tests.language.dialogue_runner import conversation
from tests.language.profiles import MECANUM

DROVE = TurnRecord(
    "forward 1 m", "completed", parse_plan("drive 1 m"), duration_s=3.5, told="Done: drove 1.00 m of 1.00 m."
)
REFUSED = TurnRecord("forward 90 m", "refused", told="The wall is in the way.")
ANSWERED = TurnRecord("how big are you?", "answered", told="I am 0.27 m long.")


def told(text: str, *turns: TurnRecord, profile: str = "wheeltec_mini_mec") -> str:
    context = Context(Dialogue(turns=turns), RobotState(obstacle_m=1.3, path_m=7.0))
    meant = OfflineInterpreter(load_profile(profile)).interpret(text, context)
    assert meant.plan is None
    assert meant.outcome == "answered", meant.reply
    return meant.reply


@pytest.mark.parametrize("text", ["can you drive sideways?", "kannst du seitwärts fahren?", "你会横着走吗"])
def test_whether_it_drives_sideways_depends_on_the_robot(text: str) -> None:
    assert re.match("Yes|Ja|能", told(text))
    assert re.match("No|Nein|不能", told(text, profile="turtlebot3_burger"))


@pytest.mark.parametrize("text", ["can you turn on the spot?", "你能原地转吗"])
def test_what_steers_like_a_car_does_not_turn_on_the_spot(text: str) -> None:
    assert re.match("Yes|能", told(text))
    assert re.match("No|不能", told(text, profile="wheeltec_mini_akm"))


@pytest.mark.parametrize(
    "text", ["can you drive backwards?", "can you also reverse?", "你能后退吗", "kannst du rückwärts fahren?"]
)
def test_whether_it_can_reverse_is_asked_and_not_ordered(text: str) -> None:
    assert re.match("Yes|Ja|能", told(text))


@pytest.mark.parametrize("text", ["how big are you?", "how wide are you?", "你多大", "wie groß bist du?"])
def test_its_size_is_that_of_its_footprint(text: str) -> None:
    size = told(text).replace(",", ".")  # as German writes it
    assert "0.27" in size
    assert "0.22" in size


def test_it_has_a_camera_where_its_profile_names_one() -> None:
    assert told("do you have a camera?").startswith("No")
    seeing = replace(MECANUM, wiring=Wiring(camera_topic="/image"))
    meant = OfflineInterpreter(seeing).interpret("do you have a camera?", Context())
    assert meant.reply.startswith("Yes")


def test_how_far_it_sees_and_may_go_are_its_lidar_and_its_budget() -> None:
    assert "8 m" in told("how far can you see?")
    assert "no lidar" in told("how far can you see?", profile="no_odometry")
    assert "100 m" in told("how far can you go?")


@pytest.mark.parametrize(
    "text", ["did you hit anything?", "have you bumped into something?", "你撞到什么了吗"]
)
def test_a_contact_that_nothing_reports_is_not_known(text: str) -> None:
    assert "1.30" in told(text)


@pytest.mark.parametrize(
    "text",
    [
        "did you arrive?",
        "are you there yet?",
        "how far was that?",
        "how much did you turn?",
        "bist du schon da?",
    ],
)
def test_what_the_last_motion_did_is_what_was_measured(text: str) -> None:
    assert DROVE.told in told(text, DROVE, ANSWERED)


@pytest.mark.parametrize(
    "text", ["why did you not move?", "why did you stop?", "为什么没走", "warum hast du angehalten?"]
)
def test_why_it_stands_is_how_the_last_order_ended(text: str) -> None:
    assert REFUSED.told in told(text, DROVE, REFUSED, ANSWERED)


def test_what_was_understood_is_the_plan() -> None:
    assert "drive forward 1 m" in told("what did you understand?", DROVE, ANSWERED)
    assert REFUSED.told in told("what did you understand?", REFUSED)


def test_a_question_that_nobody_can_answer_gets_no_answer_to_another() -> None:
    meant = OfflineInterpreter(MECANUM).interpret("why is the sky blue?", Context())
    assert meant.outcome == "unclear"


def test_how_long_it_took_is_the_time_that_was_measured() -> None:
    assert "3.5 s" in told("how long was that?", DROVE)


@pytest.mark.parametrize(
    ("turns", "reply"),
    [
        (("forward 1 m at 0.15 m/s", "how fast was that?"), "At most 0.15 m/s."),
        (("forward 1 m", "how fast did you go?"), "At most 0.3 m/s."),
        (("turn left at 20 degrees per second", "how fast was that?"), "At most 20° a second."),
        (("以每秒0.2米前进一米", "刚才多快？"), "最快 0.2 米/秒。"),
        (("1 m vor mit 0,2 m/s", "wie schnell war das?"), "Höchstens 0,2 m/s."),
    ],
)
def test_how_fast_it_went_is_told_of_the_motion_before(turns: tuple[str, str], reply: str) -> None:
    assert conversation(turns[0]).say(turns[1]).reply == reply
