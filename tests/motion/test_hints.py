"""A robot that is on the wire under other names is named, with what a person can type."""

from __future__ import annotations

import pytest

from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.language.phrases import render_reason
from chatrobot.language.typed import as_ros_args
from chatrobot.motion.topic_discovery import ODOMETRY, TURTLE_POSE, fit, hints, why_unheard
from chatrobot.robots.load import load_profile
from chatrobot.wire.wire import Endpoint

TWIST = "geometry_msgs/msg/Twist"
POSE = Endpoint("/turtle1/pose", TURTLE_POSE, "publishes")
TURTLES_OWN = Endpoint("/turtle1/cmd_vel", TWIST, "listens")
CMD_VEL = Endpoint("/cmd_vel", TWIST, "listens")


def full_name(topic: str) -> str:
    return topic if topic.startswith("/") else f"/{topic}"


def told(*seen: Endpoint, wiring: Wiring = Wiring()) -> list[Reason]:  # noqa: B008
    return hints(wiring, seen, full_name)


def args_of(reason: Reason) -> object:
    return reason.values["ros_args"]


def test_a_turtlesim_is_recognised() -> None:
    (reason,) = told(POSE, TURTLES_OWN)
    assert (reason.code, args_of(reason)) == ("turtlesim_found", "-p robot:=turtlesim")
    assert render_reason(reason, "en") == "/turtle1/pose is a turtlesim: start with --robot turtlesim."


def test_a_turtlesim_that_was_remapped_is_reached_where_it_listens() -> None:
    """The tutorial's lines: its nodes publish cmd_vel."""
    (reason,) = told(POSE, CMD_VEL)
    assert args_of(reason) == "-p robot:=turtlesim -r turtle1/cmd_vel:=/cmd_vel"
    assert "without that remapping" in render_reason(reason, "en")


def test_a_second_turtle_and_one_in_a_namespace_are_named_with_their_topics() -> None:
    second = told(
        Endpoint("/turtle2/pose", TURTLE_POSE, "publishes"), Endpoint("/turtle2/cmd_vel", TWIST, "listens")
    )
    assert args_of(second[0]) == (
        "-p robot:=turtlesim -r turtle1/pose:=/turtle2/pose -r turtle1/cmd_vel:=/turtle2/cmd_vel"
    )
    (inside,) = told(
        Endpoint("/lab/turtle1/pose", TURTLE_POSE, "publishes"),
        Endpoint("/lab/turtle1/cmd_vel", TWIST, "listens"),
    )
    assert args_of(inside) == "-p robot:=turtlesim -r __ns:=/lab"
    assert "--on dds:///lab" in render_reason(inside, "en")


def test_who_drives_it_as_a_turtlesim_is_told_nothing() -> None:
    assert told(POSE, TURTLES_OWN, wiring=load_profile("turtlesim").wiring) == []


def test_a_robot_without_odometry_that_is_a_turtlesim_could_be_measured() -> None:
    assert [reason.code for reason in told(POSE, CMD_VEL, wiring=Wiring(odom_topic=""))] == [
        "turtlesim_remapped"
    ]


def test_a_robot_in_a_namespace_is_named_with_it() -> None:
    (reason,) = told(Endpoint("/robot1/cmd_vel", TWIST, "listens"))
    assert (reason.code, args_of(reason)) == ("cmd_vel_elsewhere", "-r __ns:=/robot1")
    assert "--on dds:///robot1" in render_reason(reason, "en")


def test_velocities_taken_under_another_name_are_remapped() -> None:
    (reason,) = told(Endpoint("/base_controller/cmd", TWIST, "listens"))
    assert args_of(reason) == "-r cmd_vel:=/base_controller/cmd"


def test_of_two_odometries_the_first_is_what_can_be_typed() -> None:
    seen = [
        CMD_VEL,
        *(Endpoint(f"/{name}", ODOMETRY, "publishes") for name in ("wheel/odometry", "odometry/filtered")),
    ]
    reason = why_unheard(Wiring(), seen, full_name)
    assert reason is not None
    assert args_of(reason) == "-r odom:=/odometry/filtered"
    assert reason == fit(Wiring(), seen, full_name)[1][-1], "at the start the same is said"


def test_a_robot_that_tells_nothing_may_be_driven_open_loop() -> None:
    reason = why_unheard(Wiring(), [CMD_VEL], full_name)
    assert reason is not None
    assert "--open-loop" in render_reason(reason, "en")
    assert why_unheard(Wiring(), [], full_name) is None, "nobody is there: it may be switched off"


def test_a_robot_without_odometry_gets_none_from_elsewhere() -> None:
    wiring = Wiring(odom_topic="")
    fitted, said = fit(wiring, [CMD_VEL, Endpoint("/wheel/odometry", ODOMETRY, "publishes")], full_name)
    assert (fitted, said) == (wiring, [])


@pytest.mark.parametrize(
    ("text", "typed"),
    [
        ("start with --open-loop.", "start with --ros-args -p open_loop:=True."),
        ("run control --on-robot on it", "run control --ros-args -p on_robot:=True on it"),
        ("with --robot turtlesim.", "with --ros-args -p robot:=turtlesim."),
        ("allow more: --max-time, or", "allow more: --ros-args -p max_time_s:=SECONDS, or"),
        ("--model openai-responses:NAME, whose", "--ros-args -p model:=openai-responses:NAME, whose"),
        ("--rounds allows more", "--ros-args -p rounds:=N allows more"),
        ("--accept-others。", "--ros-args -p accept_others:=True。"),
        ("--keep-going and --on dds", "--keep-going and --on dds"),
    ],
)
def test_options_are_shown_as_they_are_typed_under_ros2_run(text: str, typed: str) -> None:
    assert as_ros_args(text) == typed
