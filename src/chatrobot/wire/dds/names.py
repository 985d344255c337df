"""ROS topic names as DDS topic names."""

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
