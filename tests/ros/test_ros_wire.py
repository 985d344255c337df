"""The wire over real rclpy keeps the contract of wires: the fakes of tests/wire know no more than this."""

from __future__ import annotations

import io
import os
import statistics
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import PIL.Image
import pytest
from ros_rig import next_domain

sys.path.insert(0, str(Path(__file__).parents[1] / "wire"))
from about import About

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.dialogue.llm.camera import wire_camera
from chatrobot.testing.wire_contract import CAMERA, Inbox, WireContract
from chatrobot.wire.messages import LaserScan, Message, Number, Odometry, Text, TwistMessage
from chatrobot.wire.ros import connect_ros
from chatrobot.wire.ros.convert import message_class
from chatrobot.wire.ros.node import RosNode
from chatrobot.wire.ros.wire import RosWire

pytestmark = pytest.mark.realtime
PATIENCE_S = 10.0
ZERO = TwistMessage(0.0, 0.0, 0.0)


class Ends:
    """Nodes of one test that know one another before they speak: the contract is about what comes after discovery."""

    def __init__(self) -> None:
        self.domain_id = int(next_domain())
        self.wires: list[AcquaintedWire] = []

    def __call__(self, *ros_args: str, name: str = "", wiring: Wiring = Wiring()) -> AcquaintedWire:  # noqa: B008
        node = RosNode(name or f"node_{len(self.wires)}", domain_id=self.domain_id, ros_args=ros_args)
        self.wires.append(AcquaintedWire(self, wiring, node))
        return self.wires[-1]

    def close(self) -> None:
        for wire in self.wires:
            wire.close()


class AcquaintedWire(RosWire):
    def __init__(self, ends: Ends, wiring: Wiring, node: RosNode) -> None:
        super().__init__(wiring, node)
        self._ends = ends

    def publish(self, topic: str, message: Message) -> None:
        key = (topic, type(message))
        count = sum(key in wire._subscriptions and not wire.node.is_closed for wire in self._ends.wires)
        if not self.node.is_closed:
            assert self.wait_for_listener(topic, type(message), PATIENCE_S, count)
        super().publish(topic, message)


@pytest.fixture
def connect(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Any]]:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    ends = Ends()
    yield ends
    ends.close()


class TestRealRosWire(WireContract):
    @pytest.fixture
    def connect(self, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[], Any]]:  # type: ignore[override]
        monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        ends = Ends()
        yield lambda: ends(wiring=CAMERA)
        ends.close()

    def as_it_arrives(self, message: Message) -> About:
        return About(message)


def test_a_zero_goes_out_while_a_callback_holds_up_the_executor(connect: Callable[..., Any]) -> None:
    wire, robot, other = connect(), connect(), connect()
    inbox = Inbox(robot, "cmd_vel", TwistMessage)
    is_held, may_go_on = threading.Event(), threading.Event()
    wire.subscribe("held", Number, lambda _: (is_held.set(), may_go_on.wait(PATIENCE_S)))
    other.publish("held", Number(1.0))
    assert is_held.wait(PATIENCE_S)
    began_s = time.monotonic()
    RosWire.publish(wire, "cmd_vel", ZERO)
    assert time.monotonic() - began_s < 0.05
    assert inbox.next() == ZERO
    may_go_on.set()


def test_namespaces_and_remappings_hold(connect: Callable[..., Any]) -> None:
    wire = connect("-r", "__ns:=/robot1", "-r", "cmd_vel:=/base/go", "-r", "__node:=driver")
    assert wire.resolve("odom") == "/robot1/odom"
    assert wire.resolve("cmd_vel") == "/base/go"
    inbox = Inbox(connect(), "/base/go", TwistMessage)
    assert wire.wait_for_listener("cmd_vel", TwistMessage, PATIENCE_S)
    RosWire.publish(wire, "cmd_vel", ZERO)
    assert inbox.next() == ZERO


@pytest.mark.parametrize(("ros_args", "name"), [(("-r", "nonsense"), "node"), ((), "no-name"), ((), "1st")])
def test_what_ros_cannot_use_is_a_wrong_option(ros_args: tuple[str, ...], name: str) -> None:
    with pytest.raises(UsageError):
        connect_ros("ros:", Wiring(), name, ros_args)


def test_a_name_that_is_no_topic_is_an_error_of_the_wire(connect: Callable[..., Any]) -> None:
    wire = connect()
    for use in (lambda: RosWire.publish(wire, "no topic", ZERO), lambda: wire.subscribe("1st", Text, print)):
        with pytest.raises(WireError):
            use()


def test_others_are_named_and_ourselves_not_even_where_they_have_our_name(
    connect: Callable[..., Any],
) -> None:
    wire = connect(name="chatrobot_control")
    wire.advertise("cmd_vel", TwistMessage)
    connect(name="teleop").advertise("cmd_vel", TwistMessage)
    connect(name="chatrobot_control").advertise("cmd_vel", TwistMessage)
    ends_s = time.monotonic() + PATIENCE_S
    while wire.publishers_of("cmd_vel") != ["/chatrobot_control", "/teleop"]:
        assert time.monotonic() < ends_s, wire.publishers_of("cmd_vel")
        time.sleep(0.02)


@pytest.mark.parametrize(
    "wiring", [Wiring(cmd_vel_type="TwistStamped"), Wiring(odom_topic="pose", battery_topic="battery")]
)
def test_the_profile_s_types_travel_too(connect: Callable[..., Any], wiring: Wiring) -> None:
    for topic, message in (
        (wiring.cmd_vel_topic, TwistMessage(0.5, 0.0, -0.25)),
        (wiring.odom_topic, Odometry(1.5, 0.5, 0.25, 1.0, 0.5, 0.0, 0.5)),
        ("battery", Number(50.0)),
    ):
        inbox = Inbox(connect(wiring=wiring), topic, type(message))
        connect(wiring=wiring).publish(topic, message)
        assert tuple(inbox.next())[1:] == pytest.approx(tuple(message)[1:], rel=1e-6)


def test_when_its_context_is_gone_publishing_fails_and_does_not_hang(connect: Callable[..., Any]) -> None:
    import rclpy

    wire = connect()
    RosWire.publish(wire, "cmd_vel", ZERO)
    rclpy.shutdown(context=wire.node.context)
    with pytest.raises(WireError):
        RosWire.publish(wire, "cmd_vel", ZERO)


def test_what_it_costs(connect: Callable[..., Any], record_property: Callable[[str, object], None]) -> None:
    """One way between two nodes of one process at 50 Hz; printed with `-s`."""
    wire, sender = connect(), connect()
    ages_s: list[float] = []
    wire.subscribe("cmd_vel", TwistMessage, lambda twist: ages_s.append(time.monotonic() - twist.vx_mps))
    wire.subscribe("scan", LaserScan, lambda _: None)
    sender.publish("cmd_vel", TwistMessage(time.monotonic(), 0.0, 0.0))
    for _ in range(150):
        RosWire.publish(sender, "cmd_vel", TwistMessage(time.monotonic(), 0.0, 0.0))
        time.sleep(0.02)
    median_s = statistics.median(ages_s)
    print(f"Twist over rclpy: median {1e3 * median_s:.2f} ms, longest {1e3 * max(ages_s):.1f} ms")
    record_property("median_ms", 1e3 * median_s)
    assert median_s < 0.005
    assert os.environ["ROS_DISTRO"]


@pytest.mark.parametrize("kind", ["Image", "CompressedImage"])
def test_a_camera_that_publishes_as_ros_s_sensors_do_is_looked_through(
    monkeypatch: pytest.MonkeyPatch, connect: Callable[..., Any], kind: Any
) -> None:
    from array import array

    from rclpy.qos import qos_profile_sensor_data

    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    robot = connect()
    message = message_class(f"sensor_msgs/msg/{kind}")()
    if kind == "Image":
        message.width, message.height, message.step, message.encoding = 640, 480, 1920, "bgr8"
        message.data = array("B", bytes((200, 0, 0)) * 640 * 480)
    else:
        file = io.BytesIO()
        PIL.Image.new("RGB", (640, 480), (0, 0, 200)).save(file, "JPEG")
        message.format, message.data = "jpeg", array("B", file.getvalue())
    publisher = robot.node.handle.create_publisher(type(message), "eye", qos_profile_sensor_data)
    domain_id = robot.node.context.get_domain_id()
    camera = wire_camera(f"ros://{domain_id}", Wiring(camera_topic="eye", camera_type=kind))
    assert camera is not None
    time.sleep(0.3)
    assert publisher.get_subscription_count() == 0
    began_s = time.monotonic()
    camera.begin()
    while not camera.has_picture and time.monotonic() < began_s + PATIENCE_S:
        publisher.publish(message)
        time.sleep(1.0 / 30.0)
    print(f"the first picture after {time.monotonic() - began_s:.2f} s")
    picture = camera.take()
    assert picture is not None
    assert PIL.Image.open(io.BytesIO(picture)).getpixel((320, 240)) == pytest.approx((0, 0, 200), abs=12)
    camera.end()
    ends_s = time.monotonic() + PATIENCE_S
    while publisher.get_subscription_count() and time.monotonic() < ends_s:
        time.sleep(0.05)
    assert publisher.get_subscription_count() == 0
