"""The command-line arguments of a context or of one node, as rclpy takes them."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.programs.names.rclpy._rclpy_pybind11 import RCLInvalidROSArgsError, UnknownROSArgsError
from chatrobot.programs.ros_args import RosArguments, RosArgumentsError, read_ros_args


def parsed(args: Sequence[str]) -> RosArguments:
    try:
        found = read_ros_args(args)
    except RosArgumentsError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from error
    if found.unknown:
        raise UnknownROSArgsError(f"Found unknown ROS arguments: {list(found.unknown)!r}")
    return found
