"""The tutorial's own inputs do exactly what it says."""

from __future__ import annotations

from chatrobot.plan.steps import RawTwist, Repeat
from tests.language.dialogue_runner import Conversation

ROTATE = """Generate a ROS 2 Python program to control the car rotation. Specific requirements are:
1, the car needs to rotate at the angular speed of 0.5 for 6 seconds, after the rotation is finished,
the speed is changed to 0.0, so that the car stops moving. The
topic name should be "/cmd_vel"; Just the code."""
SQUARE = """Generate a ROS 2 Python program to control the car movement. Specific requirements are as follows:
1. The motion path is a square. The topic name should be "/cmd_vel";
2. Use geometry_msgs/msg/twist.hpp with a linear velocity of 0.2 and a movement time of 3 seconds. The angular
velocity is 1.0 and the rotation time is 2 seconds."""


def plan_of(text: str) -> tuple[object, ...]:
    plan = Conversation().say(text).plan
    assert plan is not None
    return plan.steps


def test_a_line_of_assignments_is_a_twist_of_one_second() -> None:
    line = "linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = -0.5"
    assert plan_of(line) == (RawTwist(1.0, 0.0, -0.5, 1.0),)


def test_the_form_does_not_count_inside_prose() -> None:
    said = "please remember that linear.x = 1,linear.y = 0 was said by the teacher"
    assert Conversation().say(said).plan is None


def test_the_two_program_requests_are_driven_exactly_as_told() -> None:
    assert plan_of(ROTATE) == (RawTwist(0.0, 0.0, 0.5, 6.0),)
    assert plan_of(SQUARE) == (Repeat(4, (RawTwist(0.2, 0.0, 0.0, 3.0), RawTwist(0.0, 0.0, 1.0, 2.0))),)


def test_a_program_that_is_not_told_in_full_is_not_half_executed() -> None:
    meant = Conversation().say("write a python program that makes the robot follow a ball")
    assert meant.plan is None
    assert meant.code == "program"


def test_several_lines_of_assignments_are_twists_one_after_the_other() -> None:
    ahead = "linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0"
    turning = "linear.x = 0,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0.5"
    assert plan_of(f"{ahead}\n{turning}") == (RawTwist(1.0, 0.0, 0.0, 1.0), RawTwist(0.0, 0.0, 0.5, 1.0))


def test_lines_that_may_be_the_axes_of_one_velocity_are_asked_about() -> None:
    assert Conversation().say("linear.x = 1\nlinear.y = 0\nangular.z = 0.5").outcome == "unclear"


def test_one_line_that_cannot_be_moves_nothing_of_the_others() -> None:
    assert Conversation().say("linear.x = 1\nlinear.x = 1,linear.z = 1").outcome == "refused"
    assert Conversation().say("linear.x = 1\nlinear.x = 2\nforward 1 m").outcome == "unclear"
