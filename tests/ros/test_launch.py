"""`ros2 launch` brings up the simulated robot with its nodes, in a namespace too, and takes all down again."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from ros_rig import Workspace, rig_of

from chatrobot.wire.messages import Odometry, Text, TwistMessage

pytestmark = pytest.mark.realtime


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
        struck_s = launch.interrupt()
        velocities.wait_for(lambda twist: not any(twist), max(struck_s, moving_s))
        assert launch.end() in (0, 1, 2, 130)
        assert not any(velocities.all[-1][1])
        assert "Traceback" not in "\n".join(launch.lines)


def test_without_the_vendor_s_bring_up_it_is_said_how_to_get_it(workspace: Workspace, tmp_path: Path) -> None:
    with rig_of(workspace, tmp_path) as rig:
        launch = rig.start("ros2", "launch", "chatrobot", "wheeltec.launch.py")
        launch.wait_for_line("turn_on_wheeltec_robot is not here")
        launch.wait_for_line("robot.launch.py robot:=wheeltec_mini_mec on_robot:=true")
        launch.end()


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
