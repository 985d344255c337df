"""The wire over rclpy, for where ROS 2 is sourced: whatever middleware it runs on, we are a node of it.

`node` is one node with its thread, `wire` is the backend. Importing this package imports neither, and no rclpy.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING

from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import Backend
from chatrobot.wire.discovery import domain_and_namespace, ros_reaches_this_machine_alone

if TYPE_CHECKING:
    from chatrobot.wire.ros.wire import RosWire

HOW_TO_GET_IT = (
    "source /opt/ros/jazzy/setup.bash in this terminal, with a Python that sees it (a virtual environment made with"
    " --system-site-packages); without ROS use --on dds or --on rosbridge"
)


def connect_ros(address: str, wiring: Wiring, node_name: str, ros_args: Sequence[str] = ()) -> RosWire:
    """Open a ROS node of its own; `ros_args` is what stood behind `--ros-args`.

    Raises:
        UsageError: there is no such address, ROS is not here, or it cannot use the arguments.
        WireError: ROS cannot be opened.
    """
    domain_id, namespace = domain_and_namespace(address)
    try:
        from chatrobot.wire.ros.node import RosNode
        from chatrobot.wire.ros.wire import RosWire
    except ImportError as error:  # not sourced, or of another Python
        raise _no_ros(str(error)) from error
    node = RosNode(node_name, namespace=namespace or wiring.namespace, domain_id=domain_id, ros_args=ros_args)
    return RosWire(wiring, node)


def require_ros() -> None:
    """Check that ROS can be found, without loading it.

    Raises:
        UsageError: ROS is not here; how to get it.
    """
    if find_spec("rclpy") is None:
        raise _no_ros("no rclpy")


def _no_ros(why: str) -> UsageError:
    return UsageError(f"ROS 2 is not here ({why})", allowed=HOW_TO_GET_IT)


BACKEND = Backend(
    connect_ros,
    "ros[://DOMAIN[/NAMESPACE]]",
    lambda _: ros_reaches_this_machine_alone(os.environ),
    alone="ros:",
    require=require_ros,
)
