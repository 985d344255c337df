"""The wire over rosbridge keeps the contract of wires, and outlives its connection."""

from __future__ import annotations

import base64
import contextlib
import math
import queue
import socket
import threading
import time
from collections.abc import Callable, Iterator

import pytest
from about import About

from chatrobot.core.errors import UsageError, WireError
from chatrobot.robots.profile import Wiring
from chatrobot.testing.wire_contract import CAMERA, PATIENCE_S, Inbox, WireContract
from chatrobot.wire.messages import (
    Flag,
    Imu,
    LaserScan,
    Message,
    Number,
    Odometry,
    Picture,
    Text,
    TwistMessage,
)

pytest.importorskip("websockets", reason="pip install 'chatrobot[rosbridge]'")
pytest.importorskip("cbor2", reason="pip install 'chatrobot[rosbridge]'")

import cbor2
from fake_rosbridge import FakeRosbridge
from websockets.utils import accept_key

from chatrobot.wire.rosbridge.wire import RosbridgeWire

Connect = Callable[..., RosbridgeWire]
ZERO = TwistMessage(0.0, 0.0, 0.0)


@pytest.fixture
def robot() -> Iterator[FakeRosbridge]:
    server = FakeRosbridge()
    yield server
    server.stop()


@pytest.fixture
def old_robot() -> Iterator[FakeRosbridge]:
    """Its rosbridge knows no CBOR."""
    server = FakeRosbridge(offers_cbor=False)
    yield server
    server.stop()


@pytest.fixture
def connect(robot: FakeRosbridge) -> Iterator[Connect]:
    wires: list[RosbridgeWire] = []

    def connect_one(wiring: Wiring = Wiring(), namespace: str = "", query: str = "") -> RosbridgeWire:  # noqa: B008
        wires.append(RosbridgeWire(robot.url + query, wiring, namespace=namespace))
        return wires[-1]

    yield connect_one
    for wire in wires:
        wire.close()


class TestRosbridgeWire(WireContract):
    @pytest.fixture
    def connect(self, connect: Connect) -> Callable[[], RosbridgeWire]:  # type: ignore[override]
        return lambda: connect(CAMERA)

    def as_it_arrives(self, message: Message) -> About:
        return About(message)


class TestRosbridgeWireOverJsonAlone(WireContract):
    """Infinity and NaN are both null on the wire, and come back as NaN: what was there cannot be known."""

    sees_open_space = False

    @pytest.fixture
    def connect(self, old_robot: FakeRosbridge) -> Iterator[Callable[[], RosbridgeWire]]:  # type: ignore[override]
        wires: list[RosbridgeWire] = []

        def connect_one() -> RosbridgeWire:
            wires.append(RosbridgeWire(old_robot.url, CAMERA))
            return wires[-1]

        yield connect_one
        for wire in wires:
            wire.close()

    def as_it_arrives(self, message: Message) -> About:
        if isinstance(message, LaserScan):
            ranges_m = [range_m if math.isfinite(range_m) else math.nan for range_m in message.ranges_m]
            message = message._replace(ranges_m=ranges_m)
        return About(message)


def test_without_a_connection_publishing_fails_at_once(robot: FakeRosbridge, connect: Connect) -> None:
    wire = connect()
    wire.publish("cmd_vel", ZERO)
    gone = _when_gone(wire, robot.stop)
    assert "is gone" in str(gone)
    robot.start()


def _when_gone(wire: RosbridgeWire, lose: Callable[[], None]) -> WireError:
    """What publishing raises once the connection is lost; data already on its way may pass till then."""
    lose()
    while wire.is_connected:
        threading.Event().wait(0.01)
    with pytest.raises(WireError) as caught:
        wire.publish("cmd_vel", ZERO)
    return caught.value


def test_after_a_cut_it_comes_back_and_still_listens(robot: FakeRosbridge, connect: Connect) -> None:
    wire = connect()
    inbox = Inbox(wire, "odom_text", Text)
    before = len(robot.of("subscribe"))
    robot.cut()
    assert robot.wait_for("subscribe", 2 * before, PATIENCE_S)
    robot.say("/odom_text", {"data": "back"})
    assert inbox.next() == Text("back")
    wire.publish("cmd_vel", ZERO)
    assert robot.wait_for("publish", 2, PATIENCE_S)
    assert robot.of("publish")[-1]["topic"] == "/cmd_vel"


def test_what_could_not_be_sent_is_not_sent_later(robot: FakeRosbridge, connect: Connect) -> None:
    wire = connect()
    wire.publish("cmd_vel", TwistMessage(0.1, 0.0, 0.0))
    assert robot.wait_for("publish", 1, PATIENCE_S)
    _when_gone(wire, robot.stop)
    for _ in range(20):
        with pytest.raises(WireError):
            wire.publish("cmd_vel", TwistMessage(0.9, 0.0, 0.0))
    robot.start()
    assert robot.wait_for("advertise", 2, PATIENCE_S)
    wire.publish("cmd_vel", ZERO)
    assert robot.wait_for("publish", 2, PATIENCE_S)
    assert [request["msg"]["linear"]["x"] for request in robot.of("publish")] == [0.1, 0.0]


@pytest.mark.realtime
def test_a_server_that_does_not_read_does_not_block_the_publisher() -> None:
    """It shakes hands, then freezes: its kernel takes what fits, and acknowledges."""
    listener = socket.create_server(("127.0.0.1", 0))
    port = listener.getsockname()[1]
    hands: list[socket.socket] = []

    def shake_hands() -> None:
        connection, _ = listener.accept()
        request = connection.recv(4096).decode()
        key = next(
            line.split(": ")[1] for line in request.split("\r\n") if line.startswith("Sec-WebSocket-Key")
        )
        connection.sendall(
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Accept: {accept_key(key)}\r\n\r\n".encode()
        )
        hands.append(connection)

    thread = threading.Thread(target=shake_hands)
    thread.start()
    wire = RosbridgeWire(f"ws://127.0.0.1:{port}", Wiring())
    thread.join()
    longest_s = 0.0
    for _ in range(8_000):
        began_s = time.monotonic()
        with contextlib.suppress(WireError):
            wire.publish("chatter", Text("x" * 1000))
        longest_s = max(longest_s, time.monotonic() - began_s)
    assert longest_s < 0.1
    for connection in hands:
        connection.close()
    listener.close()
    wire.close()


def test_where_no_rosbridge_answers_it_says_where(robot: FakeRosbridge) -> None:
    robot.stop()
    with pytest.raises(WireError, match=f"ws://127.0.0.1:{robot.port}"):
        RosbridgeWire(robot.url, Wiring())
    robot.start()


def test_a_secret_in_the_address_reaches_the_server_and_no_message(
    robot: FakeRosbridge, connect: Connect
) -> None:
    wire = connect(query="/?token=s3cret")
    wire.publish("cmd_vel", ZERO)
    assert robot.wait_for("publish", 1, PATIENCE_S)
    assert robot.paths == ["/?token=s3cret"]
    assert "s3cret" not in str(_when_gone(wire, robot.stop))
    robot.start()


@pytest.mark.parametrize("url", ["http://robot:9090", "robot:9090", "ws://", ""])
def test_what_is_no_websocket_is_refused(url: str) -> None:
    with pytest.raises(UsageError):
        RosbridgeWire(url, Wiring())


def test_two_robots_in_two_namespaces_are_driven_apart(robot: FakeRosbridge, connect: Connect) -> None:
    left, right = connect(namespace="left"), connect(namespace="/right/")
    inbox = Inbox(right, "cmd_vel", TwistMessage)
    left.publish("cmd_vel", TwistMessage(1.0, 0.0, 0.0))
    connect(namespace="right").publish("cmd_vel", TwistMessage(2.0, 0.0, 0.0))
    assert inbox.next() == TwistMessage(2.0, 0.0, 0.0)
    assert {request["topic"] for request in robot.of("publish")} >= {"/left/cmd_vel", "/right/cmd_vel"}


def test_the_profile_says_twist_or_twist_stamped(robot: FakeRosbridge, connect: Connect) -> None:
    wire = connect(Wiring(cmd_vel_type="TwistStamped"))
    wire.publish("cmd_vel", TwistMessage(0.3, 0.0, 0.1))
    assert robot.wait_for("publish", 1, PATIENCE_S)
    assert robot.of("advertise")[0]["type"] == "geometry_msgs/msg/TwistStamped"
    assert robot.of("publish")[0]["msg"]["twist"]["linear"]["x"] == 0.3


def test_a_type_the_robot_refuses_is_said_when_publishing(connect: Connect) -> None:
    Inbox(connect(Wiring(cmd_vel_type="TwistStamped")), "cmd_vel", TwistMessage)
    wire = connect()
    answered = Inbox(wire, "answered", Flag)
    wire.publish("cmd_vel", ZERO)
    wire.publish("answered", Flag(True))
    answered.next()
    with pytest.raises(WireError, match="TwistStamped"):
        wire.publish("cmd_vel", ZERO)


@pytest.mark.parametrize(
    "garbage",
    [
        b"",
        b"\x82\x01",
        b"\xa1\x62op\x67publish",
        cbor2.dumps({"op": "publish", "topic": "/scan", "msg": {"ranges": cbor2.CBORTag(85, b"abc")}}),
        cbor2.dumps({"op": "publish", "topic": "/scan", "msg": {"ranges": cbor2.CBORTag(85, "abc")}}),
        b"\x81" * 10_000,
        "{",
        "[]",
        "null",
        '{"op":"publish"}',
        '{"op":"publish","topic":"/odom","msg":5}',
        '{"op":"publish","topic":"/odom","msg":{"header":{}}}',
        '{"op":"publish","topic":"/text","msg":{"data":7}}',
        '{"op":"status","level":"error"}',
        "[" * 10_000,
    ],
)
def test_messages_that_make_no_sense_are_ignored(
    robot: FakeRosbridge, connect: Connect, garbage: str | bytes
) -> None:
    wire = connect()
    inbox = Inbox(wire, "text", Text)
    wire.subscribe("odom", Odometry, lambda _: None)
    wire.subscribe("scan", LaserScan, lambda _: None)
    robot.say_raw(garbage)
    robot.say("/text", {"data": "fine"})
    assert inbox.next() == Text("fine")


def scan_of(*ranges: float | None) -> dict[str, object]:
    fields = ("angle_min", "angle_increment", "range_min", "range_max")
    return {
        "header": {"stamp": {"sec": 0, "nanosec": 0}},
        **dict.fromkeys(fields, 1.0),
        "ranges": list(ranges),
    }


def test_infinity_and_nan_are_told_apart_where_the_server_offers_cbor(
    robot: FakeRosbridge, connect: Connect
) -> None:
    wire = connect()
    scans = Inbox(wire, "scan", LaserScan)
    robot.say("/scan", scan_of(1.0, math.inf, math.nan, -math.inf, 2.5))
    told = scans.next().ranges_m
    assert (told[0], told[1], told[3], told[4]) == (1.0, math.inf, -math.inf, 2.5)
    assert math.isnan(told[2])
    assert not wire.has_null_ranges


def test_over_json_alone_both_are_unknown_and_the_wire_knows_it(old_robot: FakeRosbridge) -> None:
    wire = RosbridgeWire(old_robot.url, Wiring())
    scans = Inbox(wire, "scan", LaserScan)
    old_robot.say("/scan", scan_of(1.0, 2.5))
    assert scans.next().ranges_m == [1.0, 2.5]
    assert not wire.has_null_ranges
    old_robot.say("/scan", scan_of(1.0, math.inf, math.nan, 2.5))
    told = scans.next().ranges_m
    assert (told[0], told[3]) == (1.0, 2.5)
    assert math.isnan(told[1])
    assert math.isnan(told[2])
    wire.close()
    assert wire.has_null_ranges


def test_messages_that_the_server_fails_to_write_as_cbor_are_asked_for_as_json(
    robot: FakeRosbridge, connect: Connect
) -> None:
    heard: queue.Queue[Imu] = queue.Queue()
    connect().subscribe("imu", Imu, heard.put)
    assert robot.wait_for("subscribe", 1, PATIENCE_S)
    robot.say("/imu", {"header": {"stamp": {"sec": 1, "nanosec": 0}}, "angular_velocity": {"z": 0.5}})
    assert heard.get(timeout=PATIENCE_S).wz_radps == 0.5


def test_late_odometry_keeps_its_age(robot: FakeRosbridge, connect: Connect) -> None:
    heard: queue.Queue[Imu] = queue.Queue()
    connect().subscribe("imu", Imu, heard.put)
    assert robot.wait_for("subscribe", 1, PATIENCE_S)
    for sec in (1_000, 998):
        stamp = {"sec": sec, "nanosec": 0}
        robot.say("/imu", {"header": {"stamp": stamp}, "angular_velocity": {"z": 0.5}})
    prompt, late = heard.get(timeout=PATIENCE_S), heard.get(timeout=PATIENCE_S)
    assert prompt.stamp_s - late.stamp_s == pytest.approx(2.0, abs=1e-3)


def test_a_battery_is_told_in_per_cent(robot: FakeRosbridge, connect: Connect) -> None:
    heard = Inbox(connect(Wiring(battery_topic="battery")), "battery", Number)
    robot.say("/battery", {"percentage": None})
    robot.say("/battery", {"percentage": 0.5})
    assert heard.next() == Number(50.0)


@pytest.mark.parametrize("offers_cbor", [True, False], ids=["as bytes", "as base64"])
def test_a_camera_s_pictures_are_asked_for_now_and_then(offers_cbor: bool) -> None:
    robot = FakeRosbridge(offers_cbor=offers_cbor)
    wire = RosbridgeWire(robot.url, Wiring())
    pictures = Inbox(wire, "camera", Picture)
    asked = next(request for request in robot.of("subscribe") if request["topic"] == "/camera")
    assert (asked["throttle_rate"], asked["queue_length"]) == (200, 1)
    size = {"height": 480, "width": 640, "step": 1920}
    data = base64.b64encode(bytes(640 * 480 * 3)).decode()
    robot.say(
        "/camera", {"header": {"stamp": {"sec": 0, "nanosec": 0}}, "encoding": "rgb8", **size, "data": data}
    )
    assert len(pictures.next().data) == 640 * 480 * 3
    wire.close()
    robot.stop()


def _rosapi(robot: FakeRosbridge) -> None:
    """What the robot's rosapi would say of a robot that is driven by somebody else, too."""
    topics = {"/cmd_vel": "geometry_msgs/msg/TwistStamped", "/odom_combined": "nav_msgs/msg/Odometry"}
    robot.services["/rosapi/topics", ""] = {"topics": list(topics), "types": list(topics.values())}
    publishers = {"/cmd_vel": ["/teleop", "/rosbridge_websocket"], "/odom_combined": ["/base"]}
    subscribers = {"/cmd_vel": ["/base"], "/odom_combined": ["/rosbridge_websocket"]}
    for topic in topics:
        robot.services["/rosapi/publishers", topic] = {"publishers": publishers[topic]}
        robot.services["/rosapi/subscribers", topic] = {"subscribers": subscribers[topic]}


def test_where_rosapi_runs_the_others_are_known(robot: FakeRosbridge, connect: Connect) -> None:
    _rosapi(robot)
    wire = connect()
    assert wire.publishers_of("cmd_vel") == ["/teleop"]
    assert sorted(wire.survey()) == [
        ("/cmd_vel", "geometry_msgs/msg/TwistStamped", "listens"),
        ("/cmd_vel", "geometry_msgs/msg/TwistStamped", "publishes"),
        ("/odom_combined", "nav_msgs/msg/Odometry", "publishes"),
    ]


def test_the_guard_is_told_the_topics_with_their_namespace(robot: FakeRosbridge) -> None:
    from chatrobot.motion.safety import connection_monitor as link
    from chatrobot.wire.connect import connect_wire

    reached = link.reach(connect_wire, f"rosbridge:{robot.url}", Wiring(namespace="robot1"), "test")
    assert reached.wire.resolve("cmd_vel") == "/robot1/cmd_vel"
    reached.wire.close()


def test_where_no_rosapi_runs_nobody_is_known(connect: Connect) -> None:
    wire = connect()
    assert (wire.survey(), wire.publishers_of("cmd_vel")) == ([], [])


def test_velocities_of_the_type_that_the_robot_takes_are_sent(
    robot: FakeRosbridge, monkeypatch: pytest.MonkeyPatch
) -> None:
    from chatrobot.motion.safety import connection_monitor as link
    from chatrobot.wire.connect import connect_wire

    monkeypatch.setattr(link, "SURVEY_S", 0.1)
    _rosapi(robot)
    reached = link.reach(connect_wire, f"rosbridge:{robot.url}", Wiring(), "test")
    assert (reached.wiring.cmd_vel_type, reached.wiring.odom_topic) == ("TwistStamped", "/odom_combined")
    assert [reason.code for reason in reached.said] == ["cmd_vel_type_found", "sensor_found"]
    reached.wire.publish("cmd_vel", ZERO)
    assert robot.wait_for("publish", 1, PATIENCE_S)
    assert robot.of("publish")[0]["msg"]["twist"]["linear"]["x"] == 0.0
    reached.wire.close()
