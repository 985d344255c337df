"""On the graph our nodes are what ROS users expect: logs, namespaces, quiet topics, transforms, exit codes."""

from __future__ import annotations

import json
import re
import threading
import time
from pathlib import Path

import pytest
from ros_rig import PATIENCE_S, Process, Rig, Workspace, rig_of, wait_for_end

from chatrobot.wire.messages import Text, TwistMessage

pytestmark = pytest.mark.realtime
IDLE_S = 3.0
WARN = 30
"""rcl_interfaces/Log's number for it, which is an int or a byte by distribution."""


def launched(rig: Rig, namespace: str) -> Process:
    launch = rig.start(
        *("ros2", "launch", "chatrobot", "simulated_robot.launch.py"),
        *("world:=empty", f"namespace:={namespace}"),
    )
    for line in ("control drives", "base understands"):
        launch.wait_for_line(line) if line not in "\n".join(launch.lines) else None
    assert rig.ear.wait_for_listener(f"/{namespace}/user_input", Text, 20.0, count=2)
    return launch


def test_two_robots_each_have_a_guard_of_their_own_in_their_namespace(
    workspace: Workspace, tmp_path: Path
) -> None:
    with rig_of(workspace, tmp_path) as rig:
        others = rig.hear("/robot2/cmd_vel", TwistMessage)
        one, two = launched(rig, "robot1"), launched(rig, "robot2")
        nodes = rig.ask("node", "list", "--no-daemon", "--spin-time", "3").split()
        for robot in ("robot1", "robot2"):
            for name in ("base", "control", "guard", "sim"):
                assert nodes.count(f"/{robot}/chatrobot_{name}") == 1
        assert "/robot1/user_input → /robot1/chatgpt_node" in "\n".join(one.lines)
        assert "/robot1/chatgpt_node → /robot1/cmd_vel" in "\n".join(one.lines)
        guard, known = one.guard(), len(others.all)
        assert one.end() == 0
        wait_for_end(guard, 1.0)
        assert len(others.all) == known, "the other robot was not told anything"
        assert "/robot2/chatrobot_guard" in rig.ask("node", "list", "--no-daemon", "--spin-time", "3")
        assert two.end() == 0


def test_logs_are_sentences_on_rosout_and_events_are_quiet_while_idle(
    workspace: Workspace, tmp_path: Path
) -> None:
    from rcl_interfaces.msg import Log
    from rclpy.qos import QoSProfile

    with rig_of(workspace, tmp_path) as rig:
        logs: list[Log] = []
        came = threading.Condition()

        def note(log: Log) -> None:
            with came:
                logs.append(log)
                came.notify_all()

        rig.ear.node.handle.create_subscription(Log, "/rosout", note, QoSProfile(depth=100))
        events, telemetry = (
            rig.hear(f"/robot1/chatrobot/{topic}", Text) for topic in ("events", "telemetry")
        )
        launched(rig, "robot1")
        telemetry.wait_for(lambda _: True)
        idle_s = time.monotonic()
        time.sleep(IDLE_S)
        assert not events.since(idle_s)
        assert len(telemetry.since(idle_s)) > 5 * IDLE_S
        rig.ear.publish("/robot1/user_input", Text("forward 1 m at 9 m/s"))
        with came:
            refused = came.wait_for(
                lambda: [log for log in logs if "9.00 m/s is more than this robot may do" in log.msg],
                PATIENCE_S,
            )
        assert refused
        names = {"robot1.chatrobot_control", "robot1.chatrobot_base"}
        assert {(log.name, log.level) for log in refused} <= {(name, WARN) for name in names}
        assert all(log.stamp.sec for log in refused)
        assert not [log.msg for log in logs if re.search(r"[a-z]+_[a-z]+ \(|[0-9]\.[0-9]{6}", log.msg)]
        assert json.loads(events.all[-1][1].data)["event"] in ("result", "finished")


@pytest.mark.parametrize("on", ["ros", "dds"])
def test_a_fixed_transform_is_latched_on_tf_static(workspace: Workspace, tmp_path: Path, on: str) -> None:
    with rig_of(workspace, tmp_path) as rig:
        robot = (
            rig.run("chatrobot", "sim", "--world", "empty")
            if on == "ros"
            else rig.start("python", "-m", "chatrobot", "sim", "--on", "dds", "--world", "empty")
        )
        robot.wait_for_line("it ends with Ctrl-C")
        time.sleep(1.0)
        told = rig.ask(
            *("topic", "echo", "--once", "/tf_static", "tf2_msgs/msg/TFMessage"),
            *("--qos-durability", "transient_local", "--qos-reliability", "reliable"),
        )
        assert "child_frame_id: laser" in told
        moving = rig.ask("topic", "echo", "--once", "/tf", "tf2_msgs/msg/TFMessage")
        assert "child_frame_id: base_link" in moving
        assert "laser" not in moving


def test_ctrl_c_of_ros2_run_gives_zero_and_not_a_word_of_an_exception(
    workspace: Workspace, tmp_path: Path
) -> None:
    with rig_of(workspace, tmp_path) as rig:
        for executable in ("sim", "control", "base", "input"):
            process = rig.run("chatrobot", executable)
            process.wait_for_line(executable if executable != "sim" else "it ends with")
            process.interrupt()
            assert process.end() == 0, process.lines
            said = "\n".join(process.lines)
            assert "exited" not in said, said
            assert "xception" not in said, said
            assert "Traceback" not in said, said
