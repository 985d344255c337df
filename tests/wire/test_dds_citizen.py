"""On DDS we are what ROS 2 expects of a node, and know who else is there."""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip(
    "cyclonedds", reason="cyclonedds has no wheel for this machine or Python: DDS stays untested here"
)

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsParticipant, BuiltinTopicDcpsPublication
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from dds_rig import DOMAIN_ID, HERE, PATIENCE_S, Ends

from chatrobot.core.wiring import Wiring
from chatrobot.testing.wire_contract import Inbox
from chatrobot.wire.dds.fence import fence_in
from chatrobot.wire.dds.ros_types import RosTypes
from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.discovery import machine_addresses
from chatrobot.wire.messages import Flag, Number, Odometry, Text, TwistMessage

ZERO = TwistMessage(0.0, 0.0, 0.0)
CLEAN = {
    key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "CYCLONE", "CHATROBOT_"))
}


@pytest.fixture
def ends() -> Iterator[Ends]:
    made = Ends()
    yield made
    made.close()


@pytest.fixture
def participant(ends: Ends) -> DomainParticipant:
    """Somebody who is not ours, in this process."""
    ends.connect()  # configures the domain
    return DomainParticipant(DOMAIN_ID)


@contextlib.contextmanager
def stranger(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    """A process that is not ours, on Cyclone's own default configuration."""
    script = Path(__file__).parent / "ros_like.py"
    process = subprocess.Popen(
        [sys.executable, str(script), str(DOMAIN_ID), *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=CLEAN,
    )
    yield process
    process.communicate(
        timeout=PATIENCE_S
    )  # it says goodbye: others would see a killed one for ten seconds more


def until(condition: Callable[[], Any]) -> Any:
    """What `condition` gives once it gives something: the graph tells when asked, not when it changes."""
    for _ in range(round(PATIENCE_S / 0.02)):
        found = condition()
        if found:
            return found
        threading.Event().wait(0.02)
    raise AssertionError("it did not become so")


def userdata(qos: Qos) -> str:
    return next((bytes(policy.data).decode() for policy in qos if isinstance(policy, Policy.Userdata)), "")


def test_a_velocity_from_a_process_that_is_not_ours_is_heard(ends: Ends) -> None:
    heard: queue.Queue[TwistMessage] = queue.Queue()
    ends.connect().subscribe("cmd_vel", TwistMessage, heard.put)
    with stranger("drive", "cmd_vel", "0.25"):
        assert heard.get(timeout=PATIENCE_S) == TwistMessage(0.25, 0.0, 0.0)


def test_a_process_that_is_not_ours_hears_us(ends: Ends) -> None:
    wire = ends.connect()
    with stranger("hear", "user_input") as process:
        assert wire.wait_for_listener("user_input", Text, PATIENCE_S)
        wire.publish("user_input", Text("去厨房"))
        assert process.stdout is not None
        assert process.stdout.readline() == "去厨房\n"


@pytest.mark.realtime
def test_a_frozen_listener_holds_up_neither_the_publisher_nor_the_others(ends: Ends) -> None:
    wire = ends.connect()
    with stranger("hear", "chatter") as process:
        assert wire.wait_for_listener("chatter", Text, PATIENCE_S)
        process.send_signal(signal.SIGSTOP)
        longest_s = 0.0
        for i in range(2_000):
            began_s = time.monotonic()
            DdsWire.publish(wire, "chatter", Text(f"{i} " + "x" * 1000))
            longest_s = max(longest_s, time.monotonic() - began_s)
        process.send_signal(signal.SIGCONT)
    assert longest_s < 0.05


def test_who_listens_later_hears_it_too(ends: Ends) -> None:
    wire = ends.connect()
    heard: queue.Queue[Text] = queue.Queue()
    with stranger("say", "user_input", "hello"):
        until(lambda: wire.publishers_of("user_input"))
        ends.connect().subscribe("user_input", Text, heard.put)
        assert heard.get(timeout=PATIENCE_S) == Text("hello")


def test_a_second_publisher_is_named_and_our_own_guard_is_not(ends: Ends) -> None:
    wire, guard = ends.connect(), ends.connect()
    guard.publish("cmd_vel", ZERO)
    wire.publish("cmd_vel", ZERO)
    assert wire.publishers_of("cmd_vel") == []
    with stranger("drive", "cmd_vel", "0.1") as process:
        (name,) = until(lambda: wire.publishers_of("cmd_vel"))
        assert str(process.pid) in name


def test_another_control_of_ours_is_named_by_its_node(ends: Ends) -> None:
    wire = ends.connect()
    script = (
        "import sys\n"
        "from chatrobot.core.wiring import Wiring\n"
        "from chatrobot.wire.connect import connect_wire\n"
        "from chatrobot.wire.messages import TwistMessage\n"
        f"wire = connect_wire('dds://{DOMAIN_ID}', Wiring(), 'chatrobot_control')\n"
        "wire.advertise('cmd_vel', TwistMessage)\n"
        "sys.stdin.read()\n"
    )
    environment = {**CLEAN, "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen([sys.executable, "-c", script], stdin=subprocess.PIPE, env=environment) as process:
        until(lambda: wire.publishers_of("cmd_vel") == ["/chatrobot_control"])
        process.communicate()


def test_we_appear_in_ros2_node_list(ends: Ends, participant: DomainParticipant) -> None:
    types = RosTypes()
    name = "rmw_dds_common/msg/ParticipantEntitiesInfo"
    topic = Topic(participant, "ros_discovery_info", types.topic_type(name))
    qos = Qos(Policy.Reliability.Reliable(0), Policy.Durability.TransientLocal, Policy.History.KeepAll)
    reader = DataReader(participant, topic, qos)
    ends.connect().publish("cmd_vel", ZERO)
    introduced = BuiltinDataReader(participant, BuiltinTopicDcpsParticipant)
    publications = BuiltinDataReader(participant, BuiltinTopicDcpsPublication)
    writer = until(lambda: [p for p in publications.read(100) if p.topic_name == "rt/cmd_vel"])[0]

    def announced() -> Any:
        infos = [types.read(name, sample.cdr) for sample in reader.read(100) if hasattr(sample, "cdr")]
        nodes = [(info, node) for info in infos for node in info.node_entities_info_seq]
        return [(info, node) for info, node in nodes if node.node_name == "node_1" and node.writer_gid_seq]

    info, node = until(announced)[-1]
    assert node.node_namespace == "/"
    assert uuid.UUID(bytes=bytes(node.writer_gid_seq[0].data)) == writer.key
    assert uuid.UUID(bytes=bytes(info.gid.data)) == writer.participant_key
    assert userdata(writer.qos) == f"typehash={types.hash_of('geometry_msgs/msg/Twist')};"
    texts = {p.key: userdata(p.qos) for p in introduced.read(100)}
    assert texts[writer.participant_key].startswith("enclave=/;")


@pytest.mark.parametrize(("distribution", "length"), [("humble", 24), ("jazzy", 16), ("", 16)])
def test_identifiers_are_as_long_as_the_distribution_wants(
    monkeypatch: pytest.MonkeyPatch, distribution: str, length: int
) -> None:
    monkeypatch.setenv("ROS_DISTRO", distribution)
    wire = DdsWire(Wiring(), "node", discovery=HERE)
    gid = wire._types.message("rmw_dds_common/msg/Gid", {})
    wire.close()
    assert len(gid.data) == length


def test_the_type_hashes_are_ros_s() -> None:
    """As `ros2 topic info --verbose` prints them on Jazzy."""
    types = RosTypes()
    assert types.hash_of("std_msgs/msg/String") == (
        "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
    )
    assert types.hash_of("geometry_msgs/msg/Twist") == (
        "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"
    )


@pytest.mark.parametrize("reliability", [Policy.Reliability.BestEffort, Policy.Reliability.Reliable(0)])
def test_sensors_are_heard_whether_reliable_or_not(
    ends: Ends, participant: DomainParticipant, reliability: Any
) -> None:
    types, name = RosTypes(), "nav_msgs/msg/Odometry"
    heard: queue.Queue[Odometry] = queue.Queue()
    ends.wires[0].subscribe("odom", Odometry, heard.put)
    writer = DataWriter(participant, Topic(participant, "rt/odom", types.topic_type(name)), Qos(reliability))
    writer.write(types.sample(name, {"twist": {"twist": {"linear": {"x": 0.5}}}}))
    assert heard.get(timeout=PATIENCE_S).vx_mps == 0.5


def test_a_fixed_transform_reaches_a_listener_of_ros_s_that_comes_later(
    ends: Ends, participant: DomainParticipant
) -> None:
    types, name = RosTypes(), "tf2_msgs/msg/TFMessage"
    fixed = {"transforms": [{"header": {"frame_id": "base_link"}, "child_frame_id": "laser"}]}
    DdsWire.publish_fields(ends.wires[0], "/tf_static", name, fixed, is_kept=True)
    topic = Topic(participant, "rt/tf_static", types.topic_type(name))
    as_tf2_asks = Qos(
        Policy.Reliability.Reliable(0), Policy.Durability.TransientLocal, Policy.History.KeepLast(100)
    )
    reader: Any = DataReader(participant, topic, as_tf2_asks)
    (sample,) = until(lambda: [sample for sample in reader.read(10) if hasattr(sample, "cdr")])
    assert types.read(name, sample.cdr).transforms[0].child_frame_id == "laser"


def test_bytes_that_are_no_message_are_ignored(ends: Ends, participant: DomainParticipant) -> None:
    types, name = RosTypes(), "std_msgs/msg/String"
    inbox = Inbox(ends.wires[0], "words", Text)
    writer = DataWriter(
        participant,
        Topic(participant, "rt/words", types.topic_type(name)),
        Qos(Policy.Reliability.Reliable(0)),
    )
    bad = types.sample(name, {"data": "x"})
    bad.cdr = b"\0\1\0\0\5\0\0\0\xff\xfe\xfd\xfc\0\0\0\0"  # Cyclone itself refuses what is too short
    writer.write(bad)
    writer.write(types.sample(name, {"data": "fine"}))
    assert inbox.next() == Text("fine")


def test_two_robots_in_two_namespaces_are_driven_apart() -> None:
    left, right = Ends(namespace="left"), Ends(namespace="right")
    inbox = Inbox(right.connect(), "cmd_vel", TwistMessage)
    left.connect().publish("cmd_vel", TwistMessage(1.0, 0.0, 0.0))
    right.connect().publish("cmd_vel", TwistMessage(2.0, 0.0, 0.0))
    assert inbox.next() == TwistMessage(2.0, 0.0, 0.0)
    left.close()
    right.close()


@pytest.mark.parametrize(
    "wiring",
    [Wiring(cmd_vel_type="TwistStamped"), Wiring(odom_type="turtlesim/Pose", battery_topic="battery")],
)
def test_the_profile_s_types_travel_too(wiring: Wiring) -> None:
    ends = Ends(wiring)
    for topic, message in (
        ("cmd_vel", TwistMessage(0.5, 0.0, -0.25)),
        ("odom", Odometry(1.0, 0.5, 0.25, 1.0, 0.5, 0.0, 0.5)),
        ("battery", Number(50.0)),
    ):
        inbox = Inbox(ends.connect(), topic, type(message))
        ends.connect().publish(topic, message)
        assert tuple(inbox.next())[1:] == pytest.approx(tuple(message)[1:], rel=1e-6)
    ends.close()


def test_where_nobody_listens_waiting_ends(ends: Ends) -> None:
    assert not ends.connect().wait_for_listener("nobody", Flag, 0.01)


def test_in_localhost_range_the_kernel_drops_what_comes_from_elsewhere() -> None:
    addresses = machine_addresses()
    if not addresses:
        pytest.skip("this machine has no address but the loopback's: nothing comes from elsewhere")
    unused_domain = 232
    receiver, sender = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
    with receiver, sender:
        receiver.bind(("", 7400 + 250 * unused_domain + 100))
        receiver.settimeout(PATIENCE_S)
        port = receiver.getsockname()[1]
        sender.bind((addresses[0], 0))
        assert fence_in(unused_domain, addresses) >= 1
        sender.sendto(b"ours", (addresses[0], port))
        assert receiver.recv(100) == b"ours"
        fence_in(unused_domain, [])  # now that address is another machine's
        sender.sendto(b"elsewhere", (addresses[0], port))
        sender.close()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as loopback:
            loopback.sendto(b"loopback", ("127.0.0.1", port))
            assert receiver.recv(100) == b"loopback"
