"""The tutorial's text demo with no ROS and no model: four processes on the real wire."""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Iterator

import pytest

from chatrobot.wire.messages import Flag, Text
from tests.nodes.node_rig import NodeRig, running

pytestmark = pytest.mark.realtime

FIRST_PROMPT = (
    "I have now connected your output to the ros node, I want you to control the car movement, so I need you to"
    " translate what I say into the car movement instructions, such as: “Go forward”, I need you to answer:"
    " “linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0”."
)
SLOW = "linear.x = 0.2,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0"


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes")) as made:
        yield made


def test_the_first_prompt_moves_nothing(rig: NodeRig) -> None:
    result = rig.do(FIRST_PROMPT)
    assert result["outcome"] != "completed"
    assert not any(any(twist) for _, twist in rig.velocities.all)


def test_forward_backward_left_right_end_where_they_should(rig: NodeRig) -> None:
    x0, y0, yaw0 = rig.pose()
    assert rig.do("forward")["outcome"] == "completed"
    x1, y1, _ = rig.pose()
    assert (x1 - x0, y1 - y0) == (pytest.approx(0.5, abs=0.02), pytest.approx(0.0, abs=0.02))
    assert rig.do("backward")["outcome"] == "completed"
    x2, y2, _ = rig.pose()
    assert (x2, y2) == (pytest.approx(x0, abs=0.02), pytest.approx(y0, abs=0.02))
    assert rig.do("left")["outcome"] == "completed"
    assert rig.pose()[2] - yaw0 == pytest.approx(math.pi / 2, abs=0.05)
    assert rig.do("right")["outcome"] == "completed"
    assert rig.pose()[2] == pytest.approx(yaw0, abs=0.05)


def speeds(rig: NodeRig, since_s: float) -> list[tuple[float, float]]:
    """When which forward velocity was heard."""
    return [(at_s, twist.vx_mps) for at_s, twist in tuple(rig.velocities.all) if at_s >= since_s]


def test_a_line_of_the_tutorials_form_from_a_stranger_moves_for_a_second_and_stops(rig: NodeRig) -> None:
    x0, y0, _ = rig.pose()
    said_s = rig.stranger_says("chatgpt_node", SLOW)
    began_s = rig.velocities.wait_for_motion(said_s)
    ended_s = began_s + rig.velocities.seconds_to_zero(began_s)
    moving = [at_s for at_s, speed in speeds(rig, began_s) if speed > 0.0]
    assert ended_s - began_s == pytest.approx(1.2, abs=0.15)  # one second, and the ramp down from 0.2 m/s
    gaps_s = [later - sooner for sooner, later in itertools.pairwise(moving)]
    assert statistics.median(gaps_s) < 0.05  # each of them: test_death.py, with nothing beside it
    assert max(speed for _, speed in speeds(rig, began_s)) == pytest.approx(0.2, abs=0.02)
    x1, y1, _ = rig.pose()
    assert math.hypot(x1 - x0, y1 - y0) == pytest.approx(0.2, abs=0.02)


def test_beyond_the_limits_it_is_scaled_and_said(rig: NodeRig) -> None:
    said_s = rig.stranger_says("chatgpt_node", SLOW.replace("0.2", "5"))
    limited = rig.event("limited", said_s)
    assert limited["rule"] == "speed"
    began_s = rig.velocities.wait_for_motion(said_s)
    rig.publish("chatrobot/stop", Flag(True))
    assert rig.velocities.seconds_to_zero(began_s) < 1.0
    assert max(speed for _, speed in speeds(rig, began_s)) <= 1.0 + 1e-6


def test_a_strangers_plan_of_more_than_ten_seconds_is_refused(rig: NodeRig) -> None:
    said_s = rig.stranger_says("chatgpt_node", "drive 9 m at 0.3 m/s")
    end = rig.event("finished", said_s)
    assert (end["outcome"], end["reason"]["code"]) == ("refused", "lasts_too_long")
    said_s = rig.stranger_says("chatgpt_node", "drive 0.1 m")
    assert rig.event("finished", said_s)["outcome"] == "completed"


@pytest.mark.parametrize(
    "text",
    [
        "Sure! I would answer: linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0",
        f"Never send this:\n{SLOW}",
        "{" * 1500,
        '{"word":"plan","source":"me"}',
    ],
)
def test_anything_else_is_ignored_with_a_notice(rig: NodeRig, text: str) -> None:
    said_s = rig.stranger_says("chatgpt_node", text)
    assert rig.event("notice", said_s)["reason"]["code"] == "foreign_ignored"


def test_a_stranger_never_interrupts_a_plan_of_ours(rig: NodeRig) -> None:
    said_s = rig.nodes["input"].say("forward 1 m")
    rig.velocities.wait_for_motion(said_s)
    rig.publish("chatgpt_node", Text(SLOW))
    assert rig.event("notice", said_s)["reason"]["code"] == "foreign_busy"
    assert rig.result(said_s)["outcome"] == "completed"


def test_a_stranger_gives_way_to_a_plan_of_ours(rig: NodeRig) -> None:
    said_s = rig.publish("chatgpt_node", Text("drive 2 m at 0.3 m/s"))
    rig.velocities.wait_for_motion(said_s)
    assert rig.do("turn left 20 degrees")["outcome"] == "completed"
    stopped = rig.event("finished", said_s)
    assert (stopped["turn"], stopped["outcome"], stopped["reason"]["code"]) == (0, "stopped", "replaced")


def test_a_typed_stop_stops_what_moves(rig: NodeRig) -> None:
    said_s = rig.nodes["input"].say("forward 5 m")
    rig.velocities.wait_for_motion(said_s)
    stopped_s = rig.nodes["input"].say("stop")
    assert rig.velocities.seconds_to_zero(stopped_s) < 0.25
    assert rig.event("finished", said_s)["outcome"] == "stopped"
    rig.replies.wait_for(lambda reply: "you said “stop”" in reply.data, stopped_s)
    rig.result(said_s, "Stopped.")
    told = [reply.data for at_s, reply in rig.replies.all if at_s > stopped_s]
    assert len([text for text in told if "top" in text]) == 1, "once, as it was typed"


def test_stop_needs_no_base(rig: NodeRig) -> None:
    said_s = rig.nodes["input"].say("forward 5 m")
    rig.velocities.wait_for_motion(said_s)
    stopped_s = rig.publish("chatrobot/stop", Flag(True))
    assert rig.velocities.seconds_to_zero(stopped_s) < 0.25
    assert rig.result(said_s)["outcome"] == "stopped"


def test_ten_texts_wait_and_the_eleventh_is_refused(rig: NodeRig) -> None:
    said_s = rig.nodes["input"].say("wait 100 s")
    rig.event("started", said_s)
    for _ in range(11):
        rig.nodes["input"].say("forward 10 cm")
    assert rig.result(said_s)["outcome"] == "refused"
    rig.nodes["input"].say("stop")
    rig.result(said_s, "Stopped.")
    assert not any(any(twist) for at_s, twist in rig.velocities.all if at_s > said_s)


def test_an_emergency_stop_is_not_released_over_the_wire_unless_that_is_switched_on(rig: NodeRig) -> None:
    said_s = rig.nodes["input"].say("emergency stop")
    rig.result(said_s, "Emergency stop")
    rig.do(
        "forward"
    )  # control hears the stop twice, from base and by itself: the second may still be on its way
    assert rig.do("forward")["outcome"] == "refused"
    rig.publish("chatgpt_node", Text('{"word":"release","source":"me","lease":"me","sequence":1}'))
    assert rig.do("forward")["outcome"] == "refused"


def test_a_second_base_is_noticed(rig: NodeRig) -> None:
    second = rig.start("node", "base", "--on", "dds", "-p", "generate_code:=True", "-p", "revChatGPT:=True")
    second.wait_for_line("generate_code is set")
    second.wait_for_line("no longer exists")
    second.wait_for_line("Another base")
    rig.nodes["base"].wait_for_line("Another base")
    second.end()
