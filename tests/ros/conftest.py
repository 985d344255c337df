"""Which of these tests can run here, told aloud; and one colcon build for all of them.

They are left out rather than skipped: ROS's own plugin of pytest imports each module, and a skip would end it.
"""

from __future__ import annotations

import importlib.util
import shutil
import warnings
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from ros_rig import Workspace

ROS = ("rclpy", "ros2cli", "colcon_core")
TESTS = {
    "test_ros_wire.py": (ROS, "the contract of wires over rclpy"),
    "test_real_rosbridge.py": (
        ("rclpy", "ros2cli", "rosbridge_server", "rosbridge_library", "websockets", "cbor2"),
        "the contract of wires over the real rosbridge_server, and a robot driven over it",
    ),
    "test_tutorial_lines.py": (
        ROS,
        "colcon build, every `ros2 run` of the tutorial, ros2 topic/node/param/service, diagnostics, Ctrl-C",
    ),
    "test_death_on_ros.py": (ROS, "nodes that die or freeze on ROS, its latencies, the console --on ros"),
    "test_launch.py": (
        (*ROS, "launch_ros"),
        "ros2 launch of the simulated robot with its nodes, of an exported program; Ctrl-C once and twice",
    ),
    "test_good_manners.py": (
        (*ROS, "launch_ros"),
        "namespaces, /rosout, quiet topics, /tf_static, exit codes of ros2 run",
    ),
    "test_logs_that_nobody_reads.py": (("rclpy",), "a node whose terminal is held up (Ctrl-S)"),
    "test_turtlesim.py": (
        (*ROS, "launch_ros", "turtlesim"),
        "turtlesim drives a square; DDS without ROS drives it, either started first, LOCALHOST and SUBNET",
    ),
    "test_bags.py": (
        (*ROS, "ros2bag", "ros2bag_mcap_cli", "mcap"),
        "chatrobot record over rclpy, ros2 bag info and play of recordings",
    ),
    "test_programs_like_rclpy.py": (("rclpy",), "programs under real rclpy do what they do in the sandbox"),
    "test_messages_like_ros.py": (("rclpy",), "message classes of the sandbox against ROS's own"),
    "test_sandbox_like_rclpy.py": (("rclpy",), "what our rclpy says against what rclpy says"),
}
"""File: what it needs, and what stays untested without."""


def _missing(modules: tuple[str, ...]) -> list[str]:
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    return missing + ([] if shutil.which("ros2") else ["ros2"])


collect_ignore = [file for file, (needed, _) in TESTS.items() if _missing(needed)]
for file in collect_ignore:
    needed, what = TESTS[file]
    text = f"NOT TESTED on real ROS 2, for want of {', '.join(_missing(needed))}: {what} (tests/ros/{file})"
    warnings.warn(text, stacklevel=1)  # a category of ours would be unknown to pytest-xdist


@pytest.fixture(scope="session")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    from ros_rig import Workspace

    return Workspace(tmp_path_factory.mktemp("colcon"))
