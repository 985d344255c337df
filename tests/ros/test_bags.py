"""Recordings under rosbag2: `chatrobot record --on ros`, `ros2 bag info` and `ros2 bag play`, as a person does it."""

from __future__ import annotations

import math
import re
import sys
import time
from pathlib import Path

import pytest
from mcap.reader import make_reader
from ros_rig import Rig, Workspace, rig_of

from chatrobot.recording.reader import read
from chatrobot.recording.repair import repair
from chatrobot.wire.messages import Odometry, TwistMessage

pytestmark = pytest.mark.realtime
ENDED_BY_CTRL_C = 5
SENT = [TwistMessage(0.2, 0.01 * number, 0.0) for number in range(20)] + [TwistMessage(0.0, 0.0, 0.0)]


def drive_recorded(rig: Rig, path: Path) -> None:
    """Record a robot over rclpy that is told `SENT`, until Ctrl-C."""
    at = ("--on", f"ros://{rig.domain}", "--world", "empty")
    robot = rig.start(sys.executable, "-m", "chatrobot", "sim", *at)
    robot.wait_for_line("it ends with Ctrl-C")
    record = rig.start(sys.executable, "-m", "chatrobot", "record", str(path), *at)
    record.wait_for_line("Ctrl-C ends it")
    rig.ear.advertise("cmd_vel", TwistMessage)
    assert rig.ear.wait_for_listener("cmd_vel", TwistMessage, 20.0, 2)
    for twist in SENT:
        rig.ear.publish("cmd_vel", twist)
        time.sleep(0.03)
    time.sleep(0.5)
    assert record.end() == ENDED_BY_CTRL_C
    robot.end()


def told_count(rig: Rig, path: Path) -> int:
    found = re.search(r"Messages: +(\d+)", rig.ask("bag", "info", str(path)))
    assert found is not None
    return int(found[1])


def test_ros2_bag_tells_and_plays_what_was_recorded(workspace: Workspace, tmp_path: Path) -> None:
    path, cut = tmp_path / "drive.mcap", tmp_path / "cut.mcap"
    with rig_of(workspace, tmp_path) as rig:
        drive_recorded(rig, path)
        recording = read(path)
        assert [twist for _, twist in recording.commands] == [pytest.approx(one, abs=1e-9) for one in SENT]
        with path.open("rb") as file:
            summary = make_reader(file).get_summary()
        assert told_count(rig, path) == summary.statistics.message_count
        cut.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])  # as after kill -9
        count = repair(cut)
        assert told_count(rig, cut) == count

        played, poses = rig.hear("cmd_vel", TwistMessage), rig.hear("odom", Odometry)
        play = rig.start("ros2", "bag", "play", str(path), "--delay", "2", "--disable-keyboard-controls")
        assert play.process.wait(30.0) == 0
        last = recording.odometry[-1][1]
        poses.wait_for(lambda pose: math.dist(pose[1:4], last[1:4]) < 1e-9, timeout_s=5.0)
    assert [twist for _, twist in played.all] == [pytest.approx(one, abs=1e-9) for one in SENT]
    assert len(poses.all) == len(recording.odometry)
