"""A conversation, on simulated time: what is said is done, in order, and stops at a word."""

from __future__ import annotations

import pytest
from tests.dialogue.talk import Talk, said_while_moving

from chatrobot.core.events import Interpreted, Rehearsed, TruePose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.options import Options
from chatrobot.link.envelope import QUEUE_LIMIT
from chatrobot.link.in_process import InProcessLink


def test_two_instructions_in_a_row_are_both_done_in_order() -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    talk.session.say("turn left 90 degrees")
    talk.pump_until(lambda: len(talk.results()) == 2)
    assert [talk.results()[turn].outcome for turn in (1, 2)] == ["completed", "completed"]
    assert talk.results()[2].pose.x_m == pytest.approx(1.0, abs=0.01)
    assert talk.results()[2].pose.yaw_rad == pytest.approx(1.571, abs=0.01)


def test_the_reply_says_what_was_measured() -> None:
    assert Talk().session.do("forward 1 m").reply == "Done: drove 1.00 m of 1.00 m."
    assert "1.00 米" in Talk().session.do("前进一米").reply


@pytest.mark.parametrize("word", ["stop", "HALT!", "stop right there please", "停", "别动"])
def test_a_stop_word_stops_what_moves_and_drops_what_waits(word: str) -> None:
    talk = Talk()
    talk.session.say("forward 5 m")
    talk.session.say("forward 1 m")
    talk.pump_until_moving()
    talk.session.say(word)
    talk.pump_until(lambda: len(talk.results()) == 3)
    assert [talk.results()[turn].outcome for turn in (1, 2, 3)] == ["stopped", "stopped", "stopped"]
    assert talk.results()[1].path_m < 1.0
    assert [e.by for e in talk.events if isinstance(e, Interpreted) and e.turn == 3] == ["reflex"]


@pytest.mark.parametrize("source", ["chatrobot stop", "chatrobot/stop"])
def test_a_stop_that_nobody_says_here_drops_what_waits_as_one_that_is_said(source: str) -> None:
    talk = Talk()
    for text in ("forward 5 m", "forward 1 m"):
        talk.session.say(text)
    talk.pump_until_moving()
    assert isinstance(talk.session._link, InProcessLink)
    talk.session._link._motion.halt(Reason("stopped_by", {"source": source, "why": ""}))
    talk.pump_until(lambda: len(talk.results()) == 2)
    assert [result.outcome for result in talk.results().values()] == ["stopped", "stopped"]
    assert talk.results()[2].reply == "“forward 1 m” was waiting, and the stop dropped it."
    assert talk.do("forward 10 cm").outcome == "completed"


@pytest.mark.parametrize(
    "text", ["stop-sign shape, each edge a foot long", "forward 20 cm, stop for one second, forward 20 cm"]
)
def test_sentences_that_only_contain_a_stop_word_run(text: str) -> None:
    assert Talk().session.do(text).outcome == "completed"


def test_more_than_ten_waiting_instructions_are_refused_and_named() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    talk.pump_until_moving()
    for count in range(QUEUE_LIMIT + 1):
        talk.session.say(f"forward {count + 1} cm")
    talk.pump_until(lambda: len(talk.results()) == QUEUE_LIMIT + 2)
    refused = talk.results()[QUEUE_LIMIT + 2]
    assert refused.outcome == "refused"
    assert "forward 11 cm" in refused.reply
    assert talk.results()[QUEUE_LIMIT + 1].outcome == "completed"


def test_at_the_keyboard_new_motion_replaces_the_old() -> None:
    talk = said_while_moving("forward 5 m", "turn left 90 degrees")
    assert talk.results()[1].outcome == "stopped"
    assert talk.results()[2].outcome == "completed"


def test_at_the_keyboard_then_appends() -> None:
    talk = said_while_moving("forward 1 m", "then turn left 90 degrees")
    assert talk.results()[1].outcome == "completed"
    assert talk.results()[2].pose.x_m == pytest.approx(1.0, abs=0.01)


def test_an_emergency_stop_holds_until_it_is_released() -> None:
    talk = Talk()
    assert talk.session.do("emergency stop!").outcome == "stopped"
    assert talk.session.do("forward 1 m").outcome == "refused"
    talk.session.release()
    assert talk.session.do("forward 1 m").outcome == "completed"


def test_a_speed_beyond_the_limit_is_refused_with_the_possible_one() -> None:
    result = Talk().session.do("drive forward at 50 m/s")
    assert result.outcome == "refused"
    assert "1.00 m/s" in result.reply
    assert result.path_m == 0.0


def test_a_wall_in_the_way_is_refused_by_name_before_anything_moves() -> None:
    result = Talk(world="home").session.do("forward 10 m")
    assert result.outcome == "refused"
    assert result.path_m == 0.0


def test_the_kitchen_is_reached_through_the_door() -> None:
    talk = Talk(world="home")
    result = talk.session.do("go to the kitchen")
    assert result.outcome == "completed"
    kitchen = talk.connection.world.places["kitchen"]
    assert result.pose.distance_to(kitchen) < 0.05


@pytest.mark.parametrize(
    "text",
    [
        "",
        "   ",
        "\0",
        "🤖🤖",
        "asdf qwer",
        "x" * 100_000,
        "go 1e309 metres",
        "turn NaN degrees",
        "forward -0 m",
        "前进无穷米",
    ],
    ids=lambda text: repr(text[:12]),
)
def test_nonsense_gets_an_answer_and_no_motion(text: str) -> None:
    talk = Talk()
    result = talk.session.do(text)
    assert result.outcome in ("unclear", "refused")
    assert result.reply
    assert not any(isinstance(e, TruePose) and (e.vx_mps or e.wz_radps) for e in talk.events)


def test_a_differential_base_asked_to_go_sideways_says_why_not_and_what_instead() -> None:
    result = Talk(robot="turtlebot3_burger").session.do("slide left 1 m")
    assert result.outcome == "refused"
    assert "sideways" in result.reply
    assert "turn" in result.reply


@pytest.mark.parametrize(
    "text", ["where are you?", "which way are you facing?", "how far have you driven?", "你在哪里？"]
)
def test_where_a_robot_is_that_never_said_so_is_not_known(text: str) -> None:
    result = Talk(sim="odom_silent_after_s=0").session.do(text)
    assert result.outcome == "answered"
    assert result.reply.startswith(("I don't know: nothing has been heard", "不知道：还没有收到"))
    assert not any(digit in result.reply for digit in "0123456789")


def test_where_a_robot_is_that_has_just_been_started_is_known() -> None:
    assert Talk().session.do("where are you?").reply == "I am right where I started, not turned."


def test_no_place_is_remembered_where_nobody_knows_which() -> None:
    session = Talk(sim="odom_silent_after_s=0").session
    assert session.do("remember this place as base").outcome == "refused"
    assert session.understanding.usable_places == {}


@pytest.mark.parametrize(
    ("text", "lie", "outcome", "said"),
    [
        ("forward 1 m", "stuck_after_m=0.3", "completed", "drove 1.00 m"),
        ("turn left 90 degrees", "stuck_after_m=0", "failed", "the wheels turn and the robot does not"),
        ("forward 1 m", "stuck_after_m=0.3,blocked=stall", "failed", "the robot does not follow"),
    ],
)
def test_wheels_that_spin_are_noticed_as_far_as_the_docs_say(
    text: str, lie: str, outcome: str, said: str
) -> None:
    """The first is no promise, only the truth about odometry: who mends it rewrites docs/simulation.md."""
    result = Talk(sim=lie).session.do(text)
    assert (result.outcome, said in result.reply) == (outcome, True)


def test_what_is_not_understood_while_the_robot_drives_says_that_it_goes_on() -> None:
    talk = said_while_moving("forward 5 m", "my cat is called Tom")
    assert talk.results()[2].reply.endswith("“forward 5 m” goes on.")
    assert talk.results()[1].outcome == "completed"
    assert "goes on" not in talk.session.do("my cat is called Tom").reply


@pytest.mark.parametrize("word", ["no", "不"])
def test_a_no_to_a_plan_that_waits_declines_it_and_stops_nothing(word: str) -> None:
    talk = Talk(options=Options(approve=True))
    talk.session.say("forward 1 m")
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    talk.session.say(word)
    talk.pump_until(lambda: len(talk.results()) == 2)
    assert talk.results()[2].outcome == "answered"
    assert (talk.results()[1].path_m or 0.0) == 0.0


def test_a_no_while_a_plan_that_was_agreed_to_is_driven_stops_it() -> None:
    talk = Talk(options=Options(approve=True))
    talk.session.say("forward 5 m")
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    talk.session.say("yes")
    talk.pump_until_moving()
    talk.session.say("no")
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].outcome == "stopped"


def test_no_remark_teaches_a_place_to_mean_a_motion() -> None:
    talk = Talk(world="home")
    for said in ("the kitchen is to the left", "the kitchen is to your left", "kitchen means turn left"):
        assert talk.session.do(said).outcome == "unclear"
    assert talk.session.do("the zorb is to turn left").outcome == "answered"
