"""ROS names as DDS names, and back."""

from __future__ import annotations

from chatrobot.core.errors import WireError


def dds_topic_name(topic: str, namespace: str) -> str:
    """`cmd_vel` in namespace `robot1` is `rt/robot1/cmd_vel`; `/clock` is `rt/clock` in every namespace.

    Raises:
        WireError: no topic can be called that.
    """
    name = topic[1:] if topic.startswith("/") else f"{namespace.strip('/')}/{topic}".lstrip("/")
    parts = name.split("/")
    if not all(part.isascii() and part.replace("_", "a").isalnum() for part in parts):
        raise WireError(f"{topic!r} is no topic name: letters, digits, _ and / between them")
    return f"rt/{name}"


def ros_topic_name(dds_topic: str) -> str:
    """`rt/robot1/odom` is `/robot1/odom`; empty for what is no ROS topic."""
    return dds_topic[2:] if dds_topic.startswith("rt/") else ""


def ros_type_name(dds_type: str) -> str:
    """`nav_msgs::msg::dds_::Odometry_` is `nav_msgs/msg/Odometry`; empty for what is no ROS message."""
    package, _, short = dds_type.partition("::msg::dds_::")
    return f"{package}/msg/{short.removesuffix('_')}" if short else ""
