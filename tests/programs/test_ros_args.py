"""A program gets a command line, and `rclpy` reads the ROS arguments on it, as `ros2 run` would have it."""

from __future__ import annotations

import contextlib
from textwrap import dedent
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.link.envelope import MAX_CODE_CHARS, Envelope
from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.programs.events import Ended, Raised
from chatrobot.programs.ros_args import (
    MOST_ARGS,
    MOST_CHARS,
    RosArgumentsError,
    check_args,
    parameter_value,
    read_ros_args,
)
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer

MEC = load_profile("wheeltec_mini_mec")
DRIVER = """
    import sys, time
    import rclpy
    from geometry_msgs.msg import Twist
    from rclpy.node import Node
    from rclpy.utilities import remove_ros_args

    class Driver(Node):
        def __init__(self):
            super().__init__("driver")
            speed = self.declare_parameter("speed", 0.2).value
            names = self.declare_parameter("names", ["a"]).value
            self.pub = self.create_publisher(Twist, "velocity", 10)
            print(self.get_fully_qualified_name(), self.pub.topic_name, speed, names)
            print(self.resolve_topic_name("scan"), self.resolve_service_name("scan"))
            twist = Twist()
            twist.linear.x = speed
            self.pub.publish(twist)
            time.sleep(1.0)
            self.pub.publish(Twist())

    print(remove_ros_args(sys.argv)[1:])
    rclpy.init()
    node = Driver()
    node.get_logger().debug("fine detail")
    rclpy.shutdown()
"""


def run(server: WarmServer, *args: str, source: str = DRIVER) -> ProgramRehearsal:
    return rehearse_program(server, dedent(source), MEC, args=args)


def printed(rehearsal: ProgramRehearsal) -> list[str]:
    return "\n".join(entry.text for entry in rehearsal.log).splitlines()


def test_arguments_reach_the_program_as_ros2_run_hands_them_on(server: WarmServer) -> None:
    rehearsal = run(
        server, "fast", "--ros-args", "-p", "speed:=0.35", "-r", "velocity:=/cmd_vel", "-r", "__node:=x",
        "--", "twice",
    )  # fmt: skip
    assert isinstance(rehearsal.end, Ended)
    assert printed(rehearsal)[:2] == ["['fast', 'twice']", "/x /cmd_vel 0.35 ['a']"]
    assert rehearsal.cmd_vel[0][1].vx_mps == pytest.approx(0.35)
    assert not rehearsal.findings


def test_without_arguments_everything_is_as_written(server: WarmServer) -> None:
    rehearsal = run(server)
    assert printed(rehearsal)[:3] == ["[]", "/driver /velocity 0.2 ['a']", "/scan /scan"]
    assert not rehearsal.cmd_vel
    assert "program_other_topic" in [finding.reason.code for finding in rehearsal.findings]


@pytest.mark.parametrize(
    ("args", "line"),
    [
        (["-r", "__ns:=/robot1"], "/robot1/driver /robot1/velocity 0.2 ['a']"),
        (["-r", "__ns:=/robot1", "-r", "velocity:=cmd_vel"], "/robot1/driver /robot1/cmd_vel 0.2 ['a']"),
        (["-r", "driver:__node:=x", "-p", "x:speed:=0.1"], "/x /velocity 0.1 ['a']"),
        (["-r", "other:__node:=x", "-p", "other:speed:=0.1"], "/driver /velocity 0.2 ['a']"),
        (["-p", "speed:=0.1", "-p", "speed:=0.4"], "/driver /velocity 0.4 ['a']"),
        (["-r", "velocity:=one", "-r", "velocity:=two"], "/driver /one 0.2 ['a']"),
        (["--param", "names:=[b, 'c, d']"], "/driver /velocity 0.2 ['b', 'c, d']"),
        (["--remap", "/velocity:=/a/b", "--disable-rosout-logs"], "/driver /a/b 0.2 ['a']"),
    ],
)
def test_names_and_values_follow_their_rules(server: WarmServer, args: list[str], line: str) -> None:
    assert printed(run(server, "--ros-args", *args))[1] == line


def test_a_rule_may_be_about_topics_or_services_alone(server: WarmServer) -> None:
    assert printed(run(server, "--ros-args", "-r", "rostopic://scan:=s"))[2] == "/s /scan"
    assert printed(run(server, "--ros-args", "-r", "rosservice://scan:=s"))[2] == "/scan /s"
    assert printed(run(server, "--ros-args", "-r", "scan:=s"))[2] == "/s /s"


def test_a_level_of_the_log_is_set(server: WarmServer) -> None:
    assert not any("fine detail" in line for line in printed(run(server)))
    assert any("fine detail" in line for line in printed(run(server, "--ros-args", "--log-level", "debug")))


@pytest.mark.parametrize(
    ("args", "error", "text"),
    [
        (["-p", "speed:=1"], "InvalidParameterTypeException", "of type 'INTEGER', expecting type 'DOUBLE'"),
        (["-p", "speed"], "RCLInvalidROSArgsError", "Failed to parse ROS arguments"),
        (["--nonsense"], "UnknownROSArgsError", "['--nonsense']"),
        (["--params-file", "x.yaml"], "RCLInvalidROSArgsError", "a program cannot read files"),
        (["-r", "__node:=1x"], "InvalidNodeNameException", "must not start with a number"),
    ],
)
def test_what_ros_does_not_take_fails_as_there(
    server: WarmServer, args: list[str], error: str, text: str
) -> None:
    end = run(server, "--ros-args", *args).end
    assert isinstance(end, Raised), end
    assert end.type_name.endswith(error)
    assert text in end.message


def test_a_node_has_arguments_of_its_own_and_may_leave_out_those_of_the_process(server: WarmServer) -> None:
    source = """
        import rclpy
        rclpy.init()
        def show(*args, **more):
            node = rclpy.create_node(*args, **more)
            print(node.get_name(), node.resolve_topic_name("a"))
        show("n")
        show("n", use_global_arguments=False)
        show("n", cli_args=["--ros-args", "-r", "__node:=own", "-r", "a:=c"])
        context = rclpy.Context()
        rclpy.init(args=[], context=context)
        show("n", context=context)
    """
    rehearsal = run(server, "--ros-args", "-r", "__node:=all", "-r", "a:=b", source=source)
    assert printed(rehearsal) == ["all /b", "n /a", "own /c", "n /a"]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1), ("-7", -7), ("0x10", 16), ("1.5", 1.5), (".5", 0.5), ("1e3", 1000.0), ("-.inf", float("-inf")),
        ("true", True), ("off", False), ("Yes", True), ("'true'", "true"), ('"1"', "1"), ("it''s", "it''s"),
        ("'it''s'", "it's"), ("", ""), ("a b", "a b"), ("[]", []), ("[1, 2]", [1, 2]), ("[1.0,2.0]", [1.0, 2.0]),
        ("[true, no]", [True, False]), ("['a, b', c]", ["a, b", "c"]),
    ],
)  # fmt: skip
def test_a_value_is_what_yaml_makes_of_it(text: str, value: Any) -> None:
    found = parameter_value(text)
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize("text", ["[1, 2", "[1, 2.5]", "[1, a]", "[[1], [2]]", "[a, , b]"])
def test_a_list_that_is_none_is_said(text: str) -> None:
    with pytest.raises(RosArgumentsError):
        parameter_value(text)


@given(
    st.lists(
        st.one_of(st.sampled_from(["--ros-args", "--", "-p", "-r", "--log-level"]), st.text()), max_size=8
    )
)
def test_any_command_line_is_read_or_refused(args: list[str]) -> None:
    with contextlib.suppress(RosArgumentsError):
        read_ros_args(args)


@pytest.mark.parametrize(
    "args",
    [["x"] * (MOST_ARGS + 1), ["x" * (MOST_CHARS + 1)], ["--ros-args", "--what"], ["--ros-args", "-p"]],
)
def test_a_command_line_has_bounds(args: list[str]) -> None:
    with pytest.raises(RosArgumentsError):
        check_args(args)


@pytest.mark.parametrize(
    ("args", "is_allowed"),
    [
        (["--ros-args", "-p", "a:=1"], True),
        ([], True),
        (["x"] * (MOST_ARGS + 1), False),
        (["x" * (MOST_CHARS + 1)], False),
        ([1], False),
        ("text", False),
        (None, False),
    ],
)
def test_an_envelope_carries_no_more(args: object, is_allowed: bool) -> None:
    packet = Envelope("program", "console", "lease", 1, 1, {"code": "pass", "args": args}).to_bytes()
    assert (Envelope.from_bytes(packet) is not None) is is_allowed


def test_the_longest_program_with_the_longest_arguments_fits_into_one_packet() -> None:
    payload = {"code": "\n" * MAX_CODE_CHARS, "args": ["x" * MOST_CHARS]}
    assert len(Envelope("program", "console", "lease", 1, 1, payload).to_bytes()) < 200_000
