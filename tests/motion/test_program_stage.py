"""The stage of a rehearsal: a velocity is held as its robot would hold it, and governed as it would be."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.motion.programs.program_stage import ProgramStage
from chatrobot.robots.load import load_profile

AHEAD = Twist(0.1, 0.0, 0.0)


@pytest.mark.parametrize("asked_at_s", [0.0, 0.02, 0.013, 0.5])
@pytest.mark.parametrize(("robot", "holds_s"), [("turtlebot4", 0.5), ("turtlesim", 1.0)])
def test_a_base_with_a_timeout_stops_after_it(robot: str, holds_s: float, asked_at_s: float) -> None:
    stage = ProgramStage(load_profile(robot))
    stage.advance(asked_at_s)
    stage.ask(AHEAD)
    stage.advance(3.0)
    assert stage.path[-1][1] == pytest.approx(0.1 * holds_s, abs=0.01)


def test_a_base_without_one_holds_on() -> None:
    stage = ProgramStage(load_profile("wheeltec_mini_mec"))
    stage.ask(AHEAD)
    stage.advance(10.0)
    assert stage.robot.true_pose.x_m == pytest.approx(1.0, abs=0.02)


def test_long_strides_lead_to_the_same_place_as_short_ones() -> None:
    """Where somebody listens, the stage goes tick by tick."""
    ways = []
    for sensor in ("", "odom"):
        stage = ProgramStage(load_profile("wheeltec_mini_mec"), start=Pose(1.0, 2.0, 0.5))
        if sensor:
            stage.listen(sensor, 10)
        for t_s, twist in ((0.0, Twist(0.3, 0.0, 0.4)), (2.51, Twist(0.0, 0.2, -0.4)), (4.007, ZERO_TWIST)):
            stage.advance(t_s)
            stage.ask(twist)
        stage.finish()
        ways.append(list(stage.robot.true_pose))
    assert ways[0] == pytest.approx(ways[1], abs=2e-3)


def test_messages_come_as_often_as_the_control_loop_and_only_what_was_asked_for() -> None:
    stage = ProgramStage(load_profile("wheeltec_mini_mec"))
    stage.listen("odom", 100)
    stage.advance(1.0)
    messages = stage.take_messages()
    assert {message[0] for message in messages} == {"odom"}
    assert len(messages) == pytest.approx(50, abs=1)
    assert stage.take_messages() == []


def test_waiting_with_waking_ends_at_the_first_message() -> None:
    stage = ProgramStage(load_profile("wheeltec_mini_mec"))
    stage.listen("scan", 10)
    stage.advance(5.0, wakes=True)
    assert stage.now_s == pytest.approx(0.1)
    assert [message[0] for message in stage.take_messages()] == ["scan"]


def test_a_velocity_that_is_none_moves_nothing_and_is_noted() -> None:
    stage = ProgramStage(load_profile("wheeltec_mini_mec"))
    stage.ask(Twist(math.nan, 0.0, 0.0))
    stage.advance(1.0)
    assert stage.robot.true_pose.x_m == 0.0
    assert "not_finite" in stage.limited
