"""The tutorial's own `ros2 run` lines, unchanged, on real ROS 2 with the simulated robot; and what `ros2` sees of us.

One domain, one set of processes for the whole module: a start costs seconds.
"""

from __future__ import annotations

import json
import math
import re
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from ros_rig import Rig, Workspace, rig_of

from chatrobot.wire.messages import Odometry, Text, TwistMessage

pytestmark = pytest.mark.realtime
LINE = "linear.x = 0.2,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0"


class Tutorial(Rig):
    """The robot, control, base and input, as the tutorial starts them."""

    def begin(self) -> None:
        self.truth = self.hear("chatrobot/sim/truth", Odometry)
        self.velocities = self.hear("cmd_vel", TwistMessage)
        self.replies = self.hear("chatrobot/reply", Text)
        self.events = self.hear("chatrobot/events", Text)
        self.robot = self.run("chatrobot", "sim", "--world", "empty")
        self.control = self.run("chatGPT_test", "chatGPT_control")
        self.base = self.run(
            "chatGPT_test",
            "chatGPT_base",
            "--ros-args",
            "-p",
            "generate_code:=True",
            "-p",
            "revChatGPT:=True",
        )
        self.input = self.run("chatGPT_test", "chatGPT_input")
        self.robot.wait_for_line("it ends with Ctrl-C")
        for process, said in (
            (self.control, "control drives"),
            (self.base, "user_input"),
            (self.input, "line"),
        ):
            process.wait_for_line(said)
        self.truth.wait_for(lambda _: True)

    def result(self, since_s: float) -> dict[str, object]:
        _, message = self.events.wait_for(lambda m: json.loads(m.data)["event"] == "result", since_s)
        return dict(json.loads(message.data))

    def pose(self) -> Odometry:
        found: Odometry = self.truth.wait_for(lambda _: True, self.truth.all[-1][0])[1]
        return found


@pytest.fixture(scope="module")
def rig(workspace: Workspace, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tutorial]:
    rig = Tutorial(workspace, tmp_path_factory.mktemp("tutorial"), "wheeltec_mini_mec", ())
    try:
        rig.begin()
        yield rig
    finally:
        rig.close()


def test_the_executables_run_under_the_python_that_ran_colcon(workspace: Workspace) -> None:
    for package, names in (
        ("chatrobot", {"input", "base", "control", "sim"}),
        ("chatGPT_test", {"chatGPT_input", "chatGPT_base", "chatGPT_control"}),
    ):
        folder = workspace.folder / "install" / package / "lib" / package
        assert {file.name for file in folder.iterdir()} == names
        assert all(file.read_text().splitlines()[0] == f"#!{sys.executable}" for file in folder.iterdir())


def test_a_line_typed_at_input_drives_the_robot(rig: Tutorial) -> None:
    before = rig.pose()
    said_s = rig.input.say("forward 1 m")
    result = rig.result(said_s)
    assert result["outcome"] == "completed", result
    after = rig.pose()
    assert math.hypot(after.x_m - before.x_m, after.y_m - before.y_m) == pytest.approx(1.0, abs=0.03)
    rig.input.wait_for_line("1.00 m")


def test_a_tutorial_line_from_ros2_topic_pub_moves_the_robot_for_a_second(rig: Tutorial) -> None:
    before = rig.pose()
    began_s = time.monotonic()
    rig.ask(
        "topic",
        "pub",
        "--once",
        "-w",
        "1",
        "/chatgpt_node",
        "std_msgs/msg/String",
        json.dumps({"data": LINE}),
    )
    first_s, _ = rig.velocities.wait_for(any, began_s)
    stopped_s, _ = rig.velocities.wait_for(lambda twist: not any(twist), first_s + 0.5)
    assert stopped_s - first_s == pytest.approx(1.0, abs=0.3)  # it ramps down after the second
    streamed = [at_s for at_s, twist in rig.velocities.since(first_s) if any(twist)]
    assert len(streamed) / (streamed[-1] - streamed[0]) > 20.0
    after = rig.pose()
    assert math.hypot(after.x_m - before.x_m, after.y_m - before.y_m) == pytest.approx(0.2, abs=0.02)


def test_the_tutorial_s_parameters_are_explained(rig: Tutorial) -> None:
    said = "\n".join(rig.base.lines)
    assert "generate_code is set" in said
    assert "revChatGPT is set" in said


def test_ros2_sees_the_nodes_and_their_topics(rig: Tutorial) -> None:
    nodes = rig.ask("node", "list", "--no-daemon", "--spin-time", "3").split()
    assert set(nodes) >= {f"/chatrobot_{name}" for name in ("base", "control", "guard", "input", "sim")}
    topics = dict(
        line.removesuffix("]").split(" [")
        for line in rig.ask("topic", "list", "-t", "--no-daemon", "--spin-time", "3").splitlines()
    )
    assert topics["/cmd_vel"] == "geometry_msgs/msg/Twist"
    assert topics["/user_input"] == topics["/chatgpt_node"] == "std_msgs/msg/String"
    assert topics["/odom"] == "nav_msgs/msg/Odometry"
    assert topics["/scan"] == "sensor_msgs/msg/LaserScan"
    assert topics["/tf"] == "tf2_msgs/msg/TFMessage"
    assert topics["/diagnostics"] == "diagnostic_msgs/msg/DiagnosticArray"
    about = rig.ask("topic", "info", "--verbose", "--no-daemon", "--spin-time", "3", "/cmd_vel")
    assert about.count("Reliability: RELIABLE") >= 3
    assert "Durability: VOLATILE" in about


def test_ros2_param_lists_and_describes_and_may_not_change_them(rig: Tutorial) -> None:
    at = ("--no-daemon", "--spin-time", "3")
    listed = rig.ask("param", "list", "/chatrobot_base", *at)
    for name in ("generate_code", "revChatGPT", "robot", "world", "diagnostics_period_s", "use_sim_time"):
        assert name in listed
    assert "True" in rig.ask("param", "get", "/chatrobot_base", "generate_code", *at)
    described = rig.ask("param", "describe", "/chatrobot_control", "diagnostics_period_s", *at)
    assert "Seconds between two messages" in described
    assert "Max value: 60.0" in described
    assert "read-only" in rig.ask("param", "set", "/chatrobot_control", "robot", "turtlesim", *at)


def test_the_stop_service_stops_and_release_is_not_offered(rig: Tutorial) -> None:
    said_s = rig.input.say("forward 10 m")
    rig.velocities.wait_for(any, said_s)
    answer = rig.ask("service", "call", "/chatrobot_control/stop", "std_srvs/srv/Trigger")
    assert "success=True" in answer
    assert rig.result(said_s)["outcome"] == "stopped"
    services = rig.ask("service", "list", "--no-daemon", "--spin-time", "3").split()
    assert {"/chatrobot_control/stop", "/chatrobot_control/emergency_stop", "/chatrobot_base/stop"} <= set(
        services
    )
    assert "/chatrobot_control/release" not in services


def test_diagnostics_are_told(rig: Tutorial) -> None:
    told = rig.ask("topic", "echo", "--once", "/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
    assert re.search("name: /chatrobot_(base|control)", told)
    assert "hardware_id: wheeltec_mini_mec" in told


def test_ctrl_c_at_control_sends_the_zero_before_it_ends(rig: Tutorial) -> None:
    """The last of this module: control is gone afterwards."""
    said_s = rig.input.say("forward 10 m")
    rig.velocities.wait_for(any, said_s)
    struck_s = rig.control.interrupt()
    zero_s, _ = rig.velocities.wait_for(lambda twist: not any(twist), struck_s)
    assert rig.control.end() == 0, "ros2 run says so otherwise"
    assert not [twist for at_s, twist in rig.velocities.since(zero_s) if any(twist)]
    assert zero_s - struck_s < 0.25
    assert not [line for line in rig.control.lines if "Traceback" in line or "exited" in line]
    final = rig.truth.wait_for(lambda truth: truth.vx_mps == 0.0, zero_s)[1]
    assert final.vx_mps == 0.0


def test_with_use_sim_time_a_second_is_the_simulation_s(workspace: Workspace, tmp_path: Path) -> None:
    """At half speed the tutorial's line lasts two seconds on the wall's clock."""
    with rig_of(workspace, tmp_path) as rig:
        began_s, ended = time.monotonic(), threading.Event()
        velocities = rig.hear("cmd_vel", TwistMessage)

        def simulated_s() -> float:
            return 100.0 + 0.5 * (time.monotonic() - began_s)

        def tell_the_time() -> None:
            while not ended.wait(0.01):
                now_s = simulated_s()
                stamp = {"sec": int(now_s), "nanosec": int(now_s % 1.0 * 1e9)}
                rig.ear.publish_fields("/clock", "rosgraph_msgs/msg/Clock", {"clock": stamp})
                rig.ear.publish_fields("odom", "nav_msgs/msg/Odometry", {"header": {"stamp": stamp}})

        teller = threading.Thread(target=tell_the_time)
        teller.start()
        try:
            control = rig.run("chatrobot", "control", "--ros-args", "-p", "use_sim_time:=true")
            control.wait_for_line("control drives")
            rig.ear.wait_for_listener("chatgpt_node", Text, 10.0)
            rig.ear.publish("chatgpt_node", Text(LINE.replace("0.2", "0.1")))
            first_s, _ = velocities.wait_for(any)
            stopped_s, _ = velocities.wait_for(lambda twist: not any(twist), first_s + 0.5)
        finally:
            ended.set()
            teller.join()
    assert stopped_s - first_s == pytest.approx(2.0, abs=0.5)
