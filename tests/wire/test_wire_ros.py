"""The wire over rclpy keeps the contract of wires, and is a node as ROS expects it. rclpy is a fake here: tests/ros
has the real one.
"""

from __future__ import annotations

import itertools
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

import fake_rclpy
import pytest
from about import About

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.testing.wire_contract import CAMERA, Inbox, WireContract
from chatrobot.wire.connect import connect_wire, is_on_this_machine
from chatrobot.wire.discovery import ros_reaches_this_machine_alone
from chatrobot.wire.messages import Message, Number, Odometry, Text, TwistMessage
from chatrobot.wire.ros import connect_ros, require_ros

ZERO = TwistMessage(0.0, 0.0, 0.0)
STANDING = Odometry(1.5, 0.5, 0.25, 1.0, 0.5, 0.0, 0.5)


class Ends:
    """Nodes of one test, closed with it."""

    def __init__(self) -> None:
        self._count = itertools.count()
        self._wires: list[Any] = []

    def __call__(self, *ros_args: str, address: str = "ros:", name: str = "", wiring: Any = None) -> Any:
        name = name or f"node_{next(self._count)}"
        self._wires.append(connect_ros(address, wiring or Wiring(), name, ros_args))
        return self._wires[-1]

    def close(self) -> None:
        for wire in self._wires:
            wire.close()


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> fake_rclpy.Ros:
    return fake_rclpy.install(monkeypatch)


@pytest.fixture
def connect(ros: fake_rclpy.Ros) -> Iterator[Callable[..., Any]]:  # noqa: ARG001
    ends = Ends()
    yield ends
    ends.close()


class TestRosWire(WireContract):
    @pytest.fixture
    def connect(self, ros: fake_rclpy.Ros) -> Iterator[Callable[[], Any]]:  # type: ignore[override]  # noqa: ARG002
        ends = Ends()
        yield lambda: ends(wiring=CAMERA)
        ends.close()

    def as_it_arrives(self, message: Message) -> About:
        return About(message)


def test_a_zero_goes_out_while_a_callback_holds_up_the_executor(connect: Callable[..., Any]) -> None:
    wire, robot = connect(), connect()
    inbox = Inbox(robot, "cmd_vel", TwistMessage)
    is_held, may_go_on = threading.Event(), threading.Event()
    wire.subscribe("scan_like", Number, lambda _: (is_held.set(), may_go_on.wait(10.0)))
    connect().publish("scan_like", Number(1.0))
    assert is_held.wait(10.0)
    wire.publish("cmd_vel", ZERO)
    assert inbox.next() == ZERO
    may_go_on.set()


def test_namespaces_and_remappings_hold_and_the_guard_is_told_the_real_name(
    connect: Callable[..., Any],
) -> None:
    wire = connect("-r", "__ns:=/robot1", "-r", "cmd_vel:=/base/go")
    assert wire.resolve("odom") == "/robot1/odom"
    assert wire.resolve("cmd_vel") == "/base/go"
    inbox = Inbox(connect(), wire.resolve("cmd_vel"), TwistMessage)
    wire.publish("cmd_vel", ZERO)
    assert inbox.next() == ZERO


def test_the_address_names_a_namespace(connect: Callable[..., Any]) -> None:
    assert connect(address="ros://42/robot1").resolve("cmd_vel") == "/robot1/cmd_vel"


@pytest.mark.parametrize(
    ("ros_args", "name"), [(("-r", "nonsense"), "node"), (("-x",), "node"), ((), "no-name"), ((), "1st")]
)
def test_what_ros_cannot_use_is_a_wrong_option(
    connect: Callable[..., Any], ros_args: tuple[str, ...], name: str
) -> None:
    with pytest.raises(UsageError):
        connect(*ros_args, name=name)


def test_a_name_that_is_no_topic_is_an_error_of_the_wire(connect: Callable[..., Any]) -> None:
    wire = connect()
    for use in (lambda: wire.publish("no topic", ZERO), lambda: wire.subscribe("1st", Text, print)):
        with pytest.raises(WireError):
            use()


def test_others_are_named_and_ourselves_not_even_where_they_have_our_name(
    connect: Callable[..., Any],
) -> None:
    wire = connect(name="chatrobot_control")
    wire.advertise("cmd_vel", TwistMessage)
    assert wire.publishers_of("cmd_vel") == []
    connect(name="teleop").advertise("cmd_vel", TwistMessage)
    connect(name="chatrobot_control").advertise("cmd_vel", TwistMessage)
    assert wire.publishers_of("cmd_vel") == ["/chatrobot_control", "/teleop"]


def test_where_nobody_listens_waiting_ends(connect: Callable[..., Any]) -> None:
    assert not connect().wait_for_listener("nobody", Text, 0.01)


@pytest.mark.parametrize(
    "wiring", [Wiring(cmd_vel_type="TwistStamped"), Wiring(odom_topic="pose", battery_topic="battery")]
)
def test_the_profile_s_types_travel_too(connect: Callable[..., Any], wiring: Wiring) -> None:
    for topic, message in (
        (wiring.cmd_vel_topic, TwistMessage(0.5, 0.0, -0.25)),
        (wiring.odom_topic, STANDING),
        ("battery", Number(50.0)),
    ):
        inbox = Inbox(connect(wiring=wiring), topic, type(message))
        connect(wiring=wiring).publish(topic, message)
        assert tuple(inbox.next())[1:] == pytest.approx(tuple(message)[1:])


def test_what_has_no_planar_form_is_published_by_its_fields(connect: Callable[..., Any]) -> None:
    heard: list[Any] = []
    listener = connect()
    from chatrobot.wire.ros.convert import message_class

    qos = fake_rclpy.SimpleNamespace(reliability=fake_rclpy.Option.RELIABLE)
    listener.node.handle.create_subscription(
        message_class("tf2_msgs/msg/TFMessage"), "/tf", heard.append, qos
    )
    wire = connect()
    wire.publish_fields(
        "/tf", "tf2_msgs/msg/TFMessage", {"transforms": [{"child_frame_id": "base_link", "transform": {}}]}
    )
    Inbox(listener, "settled", Text)
    assert [transform.child_frame_id for transform in heard[0].transforms] == ["base_link"]


def test_what_is_kept_reaches_who_listens_later(connect: Callable[..., Any]) -> None:
    from chatrobot.wire.ros.convert import message_class

    wire, heard = connect(), []
    for child in ("camera", "laser"):
        wire.publish_fields(
            "/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": [{"child_frame_id": child}]}, is_kept=True
        )
    listener = connect()
    qos = fake_rclpy.SimpleNamespace(
        reliability=fake_rclpy.Option.RELIABLE, durability=fake_rclpy.Option.TRANSIENT_LOCAL
    )
    listener.node.handle.create_subscription(
        message_class("tf2_msgs/msg/TFMessage"), "/tf_static", heard.append, qos
    )
    Inbox(listener, "settled", Text)
    assert [message.transforms[0].child_frame_id for message in heard] == ["laser"]


def test_closing_twice_and_after_its_context_is_gone_breaks_nothing(connect: Callable[..., Any]) -> None:
    wire = connect()
    wire.node.context.is_valid = False
    wire.node._thread.join(10.0)
    wire.close()
    wire.close()
    assert wire.node.is_closed


def test_a_type_that_is_not_installed_says_how_to_get_it(
    connect: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "turtlesim.msg", None)  # it is there where ROS is
    with pytest.raises(UsageError, match="turtlesim"):
        connect(wiring=Wiring(odom_type="turtlesim/Pose")).publish("odom", STANDING)


def test_a_whole_number_where_ros_wants_a_float_is_one(connect: Callable[..., Any]) -> None:
    inbox = Inbox(connect(), "cmd_vel", TwistMessage)
    connect().publish("cmd_vel", TwistMessage(1, 0, 0))
    assert inbox.next() == TwistMessage(1.0, 0.0, 0.0)


def test_with_use_sim_time_the_clock_and_the_stamps_are_the_simulation_s(
    connect: Callable[..., Any], ros: fake_rclpy.Ros
) -> None:
    wire = connect("-p", "use_sim_time:=true")
    ros.clock_s = 12.5
    assert wire.clock.now_s() == 12.5
    inbox = Inbox(wire, "odom", Odometry)
    connect("-p", "use_sim_time:=true").publish("odom", STANDING)
    assert inbox.next().stamp_s == pytest.approx(1.5)


def test_when_its_context_is_gone_publishing_fails_and_does_not_hang(connect: Callable[..., Any]) -> None:
    wire = connect()
    wire.publish("cmd_vel", ZERO)
    wire.node.context.is_valid = False
    with pytest.raises(WireError):
        wire.publish("cmd_vel", ZERO)


def test_it_tells_who_else_is_there_and_as_what(connect: Ends) -> None:
    robot, wire = connect(name="robot"), connect(name="ours")
    robot.subscribe("cmd_vel", TwistMessage, lambda _: None)
    robot.publish("odom", STANDING)
    wire.publish("cmd_vel", ZERO)
    wanted = {
        ("/cmd_vel", "geometry_msgs/msg/Twist", "listens"),
        ("/odom", "nav_msgs/msg/Odometry", "publishes"),
    }
    assert {end for end in wire.survey() if end.topic in ("/cmd_vel", "/odom")} == wanted


def test_without_ros_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", None)
    monkeypatch.delitem(sys.modules, "chatrobot.wire.ros.node", raising=False)
    for use in (require_ros, lambda: connect_wire("ros:", Wiring(), "node")):
        with pytest.raises(UsageError, match="source /opt/ros"):
            use()


@pytest.mark.parametrize(
    ("environ", "alone"),
    [
        ({}, False),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, True),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, False),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_STATIC_PEERS": "robot"}, False),
        ({"ROS_LOCALHOST_ONLY": "0"}, False),
        ({"ROS_LOCALHOST_ONLY": "1"}, True),
        ({"ROS_DISTRO": "humble"}, False),
        ({"ROS_DISTRO": "humble", "ROS_LOCALHOST_ONLY": "1"}, True),
    ],
)
def test_how_far_we_reach_is_ros_s_to_say(environ: dict[str, str], alone: bool) -> None:
    assert ros_reaches_this_machine_alone(environ) is alone


def test_beats_are_quick_where_all_are_on_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    assert is_on_this_machine("ros:")
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    assert not is_on_this_machine("ros:")
