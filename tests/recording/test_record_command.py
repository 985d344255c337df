"""`chatrobot record` beside a robot that others drive: real processes on a real wire, ended by Ctrl-C."""

from __future__ import annotations

import io
import math
import os
import time
from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader

from chatrobot.recording.reader import Recording, read
from chatrobot.recording.repair import copy_whole, is_whole
from chatrobot.robots.load import load_profile
from chatrobot.sim.robot import TRUTH_TOPIC
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import LaserScan, Message, Odometry, Text, TwistMessage
from chatrobot.wire.ros_messages import ros_form
from tests.nodes.node_rig import Node, NodeRig
from tests.processes import Heard

pytestmark = pytest.mark.realtime
ENDED_BY_CTRL_C = 5


def end(node: Node, path: Path) -> Recording:
    """Press Ctrl-C; what was recorded is whole, and rosbags reads each message."""
    node.strike("SIGINT")
    assert node.process.wait(10.0) == ENDED_BY_CTRL_C
    recording = read(path)
    assert is_whole(path)
    with AnyReader([path]) as bag:
        count = sum(1 for one, _, data in bag.messages() if bag.deserialize(data, one.msgtype))
    node.wait_for_line(f"s, {count} messages, ")
    return recording


def same_way(recorded: list[tuple[float, Odometry]], heard: Heard) -> bool:
    """Each pose that was heard is recorded, from the first recorded one on."""
    way = [(sample.x_m, sample.y_m) for _, sample in recorded]
    poses = [(sample.x_m, sample.y_m) for _, sample in heard.all]
    return (
        max(min(math.dist(pose, one) for one in way) for pose in poses[:: max(1, len(poses) // 50)]) < 0.005
    )


def test_on_a_local_wire_it_has_each_velocity_and_the_way_and_says_when_nothing_comes(tmp_path: Path) -> None:
    socket, path = tmp_path / "robot.wire", tmp_path / "a.mcap"
    environment = {**os.environ, "PYTHONUNBUFFERED": "1", "XDG_RUNTIME_DIR": str(tmp_path)}
    robot = Node(["-m", "chatrobot", "sim", "--socket", str(socket), "--world", "home"], environment)
    try:
        robot.wait_for_line("answers on")
        wire = LocalWire(socket)
        record = Node(["-m", "chatrobot", "record", str(path), "--on", f"local:{socket}"], environment)
        try:
            record.wait_for_line("Ctrl-C ends it")
            truth = Heard()
            wire.subscribe(TRUTH_TOPIC, Odometry, truth)
            sent = [TwistMessage(0.2, 0.01 * number, 0.0) for number in range(20)]
            for twist in (*sent, TwistMessage(0.0, 0.0, 0.0)):
                wire.publish("cmd_vel", twist)
                time.sleep(0.03)
            truth.wait_for(lambda sample: sample.x_m > 0.05 and sample.vx_mps == 0.0)
            wire.close()
            robot.end()
            record.wait_for_line("nothing has come for 3 s")
            recording = end(record, path)
        finally:
            record.end()
    finally:
        robot.end()
    assert [twist for _, twist in recording.commands] == [
        pytest.approx(one, abs=1e-6) for one in (*sent, (0, 0, 0))
    ]
    assert same_way(recording.truth, truth)
    assert len(recording.scans) > 3


def test_on_dds_it_has_the_words_the_plan_the_way_and_the_result_of_nodes(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    rig = NodeRig(tmp_path, "control", "base")
    try:
        record = rig.start("record", str(path), "--on", rig.on)
        record.wait_for_line("Ctrl-C ends it")
        assert rig.ear.wait_for_listener("user_input", Text, 10.0, 3)
        rig.ear.publish("user_input", Text("forward 0.3 m"))
        rig.events.wait_for(lambda event: event["event"] == "result")
        recording = end(record, path)
        at = rig.truth.all[-1][1]
    finally:
        rig.close()
    assert [text for _, text in recording.words] == ["forward 0.3 m"]
    told = [event for _, event in recording.events]
    assert "drive 0.3 m" in [event["plan_text"] for event in told if event["event"] == "interpreted"]
    (result,) = (event for event in told if event["event"] == "result")
    assert result["outcome"] == "completed"
    assert recording.odometry[-1][1].x_m == pytest.approx(result["pose"]["x_m"], abs=0.01)
    assert any(event["event"] == "telemetry" for event in told)
    assert max(twist.vx_mps for _, twist in recording.commands) > 0.1
    assert recording.commands[-1][1] == (0.0, 0.0, 0.0)
    assert math.dist((at.x_m, at.y_m), (recording.truth[-1][1].x_m, recording.truth[-1][1].y_m)) < 0.01


def test_over_rosbridge_it_has_what_the_robot_is_told_what_it_says_and_words(tmp_path: Path) -> None:
    pytest.importorskip("websockets", reason="pip install 'chatrobot[rosbridge]'")
    from tests.wire.fake_rosbridge import FakeRosbridge

    path, wiring, bridge = tmp_path / "a.mcap", load_profile("wheeltec_mini_mec").wiring, FakeRosbridge()
    now_s = time.time()
    told: list[tuple[str, Message]] = [("user_input", Text("forward, 向前"))]
    for tick in range(20):
        told.append((wiring.cmd_vel_topic, TwistMessage(0.2, 0.0, 0.01 * tick)))
        told.append(("odom", Odometry(now_s + 0.02 * tick, 0.004 * tick, 0.0, 0.1, 0.2, 0.0, 0.0)))
    told.append(("scan", LaserScan(now_s, 0.0, 0.1, 0.1, 12.0, [1.5, math.inf, 2.5])))
    try:
        record = Node(["-m", "chatrobot", "record", str(path), "--on", f"rosbridge:{bridge.url}"], os.environ)
        try:
            record.wait_for_line("Ctrl-C ends it")
            assert bridge.wait_for("subscribe", 8, 10.0), (
                "velocities, odometry, scans, truth and four of text"
            )
            for topic, message in told:
                bridge.say(f"/{topic}", ros_form(topic, type(message), wiring).to_ros(message))
            ends_s = time.monotonic() + 10.0
            while path.stat().st_size == 0 or copy_whole(path, io.BytesIO()) < len(told):
                assert time.monotonic() < ends_s
                time.sleep(0.05)
            recording = end(record, path)
        finally:
            record.end()
    finally:
        bridge.stop()
    assert [text for _, text in recording.words] == ["forward, 向前"]
    sent = [message for _, message in told if isinstance(message, TwistMessage)]
    assert [twist for _, twist in recording.commands] == [pytest.approx(one) for one in sent]
    assert [at.x_m for _, at in recording.odometry] == pytest.approx([0.004 * tick for tick in range(20)])
    assert [scan.ranges_m for _, scan in recording.scans] == [[1.5, math.inf, 2.5]]
