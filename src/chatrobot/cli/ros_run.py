"""What `ros2 run` starts: the nodes and the simulated robot, `--on ros`. Asked to end they give 0, as ROS's own do."""

from __future__ import annotations

import sys

from chatrobot.cli.entry import STOPPED, main
from chatrobot.cli.ros_help import asks_for_help, show


def input_node() -> int:
    return _run("node", "input")


def base_node() -> int:
    return _run("node", "base")


def control_node() -> int:
    return _run("node", "control")


def simulated_robot() -> int:
    return _run("sim")


def _run(*command: str) -> int:
    if command[0] == "node" and asks_for_help(sys.argv[1:]):
        return show(command[1])
    code = main([*command, "--on", "ros", *sys.argv[1:]])
    return 0 if code == STOPPED else code
