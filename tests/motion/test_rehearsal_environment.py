"""Where a program is rehearsed: a velocity is held as its robot would hold it, and governed as it would be."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.motion.programs.rehearsal_environment import RehearsalEnvironment
from chatrobot.robots.load import load_profile

AHEAD = Twist(0.1, 0.0, 0.0)


@pytest.mark.parametrize("asked_at_s", [0.0, 0.02, 0.013, 0.5])
@pytest.mark.parametrize(("robot", "holds_s"), [("turtlebot4", 0.5), ("turtlesim", 1.0)])
def test_a_base_with_a_timeout_stops_after_it(robot: str, holds_s: float, asked_at_s: float) -> None:
    environment = RehearsalEnvironment(load_profile(robot))
    environment.advance(asked_at_s)
    environment.ask(AHEAD)
    environment.advance(3.0)
    assert environment.path[-1][1] == pytest.approx(0.1 * holds_s, abs=0.01)


@pytest.mark.parametrize("robot", ["turtlebot4", "originbot", "turtlesim"])
def test_a_base_with_a_timeout_drives_on_while_it_is_told_again(robot: str) -> None:
    """As the control loop tells it, whose clock does not skip what stays the same."""
    environment = RehearsalEnvironment(load_profile(robot))
    for tenth in range(50):
        environment.advance(tenth / 10)
        environment.ask(AHEAD)
    environment.advance(5.0)
    assert environment.path[-1][1] == pytest.approx(0.5, abs=0.02)


def test_a_base_without_one_holds_on() -> None:
    environment = RehearsalEnvironment(load_profile("wheeltec_mini_mec"))
    environment.ask(AHEAD)
    environment.advance(10.0)
    assert environment.robot.true_pose.x_m == pytest.approx(1.0, abs=0.02)


def test_long_strides_lead_to_the_same_place_as_short_ones() -> None:
    """Where somebody listens, it goes tick by tick."""
    ways = []
    for sensor in ("", "odom"):
        environment = RehearsalEnvironment(load_profile("wheeltec_mini_mec"), start=Pose(1.0, 2.0, 0.5))
        if sensor:
            environment.sensors.listen(sensor, 10)
        for t_s, twist in ((0.0, Twist(0.3, 0.0, 0.4)), (2.51, Twist(0.0, 0.2, -0.4)), (4.007, ZERO_TWIST)):
            environment.advance(t_s)
            environment.ask(twist)
        environment.finish()
        ways.append(list(environment.robot.true_pose))
    assert ways[0] == pytest.approx(ways[1], abs=2e-3)


def test_messages_come_as_often_as_the_control_loop_and_only_what_was_asked_for() -> None:
    environment = RehearsalEnvironment(load_profile("wheeltec_mini_mec"))
    environment.sensors.listen("odom", 100)
    environment.advance(1.0)
    messages = environment.sensors.take()
    assert {message[0] for message in messages} == {"odom"}
    assert len(messages) == pytest.approx(50, abs=1)
    assert environment.sensors.take() == []


def test_the_newest_message_of_a_tick_comes_with_the_programs_own_time() -> None:
    environment = RehearsalEnvironment(load_profile("wheeltec_mini_mec"))
    environment.sensors.listen("scan", 10)
    environment.advance(0.09)
    assert not environment.sensors.take()
    environment.advance(0.1)
    assert [message[:2] for message in environment.sensors.take()] == [["scan", pytest.approx(0.1)]]


def test_a_velocity_that_is_none_moves_nothing_and_is_noted() -> None:
    environment = RehearsalEnvironment(load_profile("wheeltec_mini_mec"))
    environment.ask(Twist(math.nan, 0.0, 0.0))
    environment.advance(1.0)
    assert environment.robot.true_pose.x_m == 0.0
    assert "not_finite" in environment.limited
