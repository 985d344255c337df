"""`ros2 launch` brings up the simulated robot with its nodes, in a namespace too, and takes all down again."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ros_rig import PATIENCE_S, Process, Workspace, rig_of, wait_for_end

from chatrobot.wire.messages import Odometry, Text, TwistMessage

pytestmark = pytest.mark.realtime
GUARD_GONE_S = 1.0


def test_launch_brings_up_a_robot_in_a_namespace_and_ctrl_c_ends_it_standing(
    workspace: Workspace, tmp_path: Path
) -> None:
    with rig_of(workspace, tmp_path) as rig:
        truth = rig.hear("/robot1/chatrobot/sim/truth", Odometry)
        replies = rig.hear("/robot1/chatrobot/reply", Text)
        velocities = rig.hear("/robot1/cmd_vel", TwistMessage)
        elsewhere = rig.hear("/cmd_vel", TwistMessage)
        mine = tmp_path / "mine.yaml"
        mine.write_text("/**/chatrobot_control:\n  ros__parameters:\n    diagnostics_period_s: 2.5\n")
        launch = rig.start(
            *("ros2", "launch", "chatrobot", "simulated_robot.launch.py"),
            *("namespace:=robot1", "world:=empty", f"params_file:={mine}"),
        )
        for line in ("it ends with Ctrl-C", "user_input", "control drives"):
            launch.wait_for_line(line) if line not in "\n".join(launch.lines) else None
        truth.wait_for(lambda _: True)
        assert rig.ear.wait_for_listener("/robot1/user_input", Text, 20.0, count=2)
        rig.ask(
            *("topic", "pub", "--once", "-w", "2", "/robot1/user_input", "std_msgs/msg/String"),
            "{data: 'forward 0.5 m'}",
        )
        replies.wait_for(lambda reply: "0.5" in reply.data and "one" in reply.data)
        final = truth.all[-1][1]
        assert math.hypot(final.x_m, final.y_m) == pytest.approx(0.5, abs=0.03)
        assert not elsewhere.all
        nodes = rig.ask("node", "list", "--no-daemon", "--spin-time", "3")
        assert "/robot1/chatrobot_control" in nodes
        assert "/robot1/chatrobot_base" in nodes
        period = rig.ask(
            *("param", "get", "/robot1/chatrobot_control", "diagnostics_period_s"),
            *("--no-daemon", "--spin-time", "3"),
        )
        assert "2.5" in period
        rig.ear.publish("/robot1/user_input", Text("forward 10 m"))
        moving_s, _ = velocities.wait_for(any, velocities.all[-1][0] + 0.1)
        guard = launch.guard()
        struck_s = launch.interrupt()
        velocities.wait_for(lambda twist: not any(twist), max(struck_s, moving_s))
        ends_cleanly(launch)
        wait_for_end(guard, GUARD_GONE_S)
        assert not any(velocities.all[-1][1])
        assert "chatrobot" not in rig.ask("node", "list", "--no-daemon", "--spin-time", "3")


def ends_cleanly(launch: Process) -> None:
    """Every process gives 0; not a word of an exception. It has been interrupted: twice makes launch itself hang."""
    assert launch.process.wait(PATIENCE_S) == 0
    said = "\n".join(launch.lines)
    assert said.count("process has finished cleanly") == said.count("process started"), said
    for word in ("Traceback", "exception", "has died"):
        assert word not in said, said


@pytest.mark.parametrize("pause_s", [0.02, 0.3])
def test_a_launch_that_is_interrupted_twice_ends_cleanly_too(
    workspace: Workspace, tmp_path: Path, pause_s: float
) -> None:
    with rig_of(workspace, tmp_path) as rig:
        launch = rig.start("ros2", "launch", "chatrobot", "simulated_robot.launch.py", "world:=empty")
        for line in ("control drives", "base understands"):
            launch.wait_for_line(line) if line not in "\n".join(launch.lines) else None
        guard = launch.guard()
        launch.interrupt()
        time.sleep(pause_s)
        launch.interrupt_below()
        ends_cleanly(launch)
        wait_for_end(guard, GUARD_GONE_S)


SPINNER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Spinner(Node):
    def __init__(self):
        super().__init__('spinner')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(0.1, lambda: self.publisher.publish(Twist()))


def main(args=None):
    rclpy.init(args=args)
    node = Spinner()
    try:
        rclpy.spin(node)
    finally:
        node.publisher.publish(Twist())
        node.destroy_node()
        rclpy.shutdown()
"""
"""As programs are written everywhere: after Ctrl-C each line of its `finally` raises."""


def test_an_exported_program_survives_the_second_ctrl_c_of_launch(
    workspace: Workspace, tmp_path: Path
) -> None:
    from chatrobot.programs.export import export
    from chatrobot.programs.library import KeptProgram

    folder = export(KeptProgram("spinner", SPINNER), tmp_path / "ws")
    subprocess.run([sys.executable, "-m", "colcon", "build"], cwd=folder, check=True, capture_output=True)
    with rig_of(workspace, tmp_path) as rig:
        heard = rig.hear("cmd_vel", TwistMessage)
        launching = "source install/local_setup.bash && exec ros2 launch spinner spinner.launch.py"
        launch = rig.start("bash", "-c", f"cd {folder} && {launching}")
        heard.wait_for(lambda _: True)
        launch.interrupt()
        time.sleep(0.02)
        launch.interrupt_below()
        ends_cleanly(launch)


def test_without_the_vendor_s_bring_up_it_is_said_how_to_get_it(workspace: Workspace, tmp_path: Path) -> None:
    with rig_of(workspace, tmp_path) as rig:
        launch = rig.start("ros2", "launch", "chatrobot", "wheeltec.launch.py")
        launch.wait_for_line("turn_on_wheeltec_robot is not here")
        launch.wait_for_line("robot.launch.py robot:=wheeltec_mini_mec on_robot:=true")
        assert launch.process.wait(PATIENCE_S) == 1  # by itself; a Ctrl-C just then may hang `ros2 launch`


def test_the_vendor_s_bring_up_is_included(workspace: Workspace, tmp_path: Path) -> None:
    """In place of Wheeltec's image: a package of that name whose launch file starts the simulated robot."""
    vendor = tmp_path / "vendor"
    index = vendor / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "turn_on_wheeltec_robot").touch()
    folder = vendor / "share" / "turn_on_wheeltec_robot" / "launch"
    folder.mkdir(parents=True)
    (folder / "turn_on_wheeltec_robot.launch.py").write_text(
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    sim = Node(package='chatrobot', executable='sim', arguments=['--world', 'empty'], output='screen')\n"
        "    return LaunchDescription([sim])\n"
    )
    with rig_of(workspace, tmp_path) as rig:
        rig.environment["AMENT_PREFIX_PATH"] = f"{vendor}:{rig.environment['AMENT_PREFIX_PATH']}"
        truth = rig.hear("chatrobot/sim/truth", Odometry)
        launch = rig.start("ros2", "launch", "chatrobot", "wheeltec.launch.py", "robot:=wheeltec_mini_mec")
        truth.wait_for(lambda _: True)
        assert rig.ear.wait_for_listener("user_input", Text, 20.0, count=2)
        rig.ear.publish("user_input", Text("forward 0.3 m"))
        truth.wait_for(lambda true: true.x_m > 0.28)
        launch.end()
        assert "Traceback" not in "\n".join(launch.lines)
