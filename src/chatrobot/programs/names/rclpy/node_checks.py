"""What `rclpy.node.Node` checks of what it is given."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from chatrobot.programs.names.rclpy.qos import QoSProfile


def destroy(entities: list[Any], entity: Any) -> bool:
    if entity not in entities:
        return False
    entities.remove(entity)
    entity.destroy()
    return True


def raise_for(problem: tuple[str, int] | None, kind: Callable[[str, str, int], Exception], name: str) -> None:
    if problem is not None:
        raise kind(name, *problem)


def qos_of(qos_or_depth: Any) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if isinstance(qos_or_depth, int):
        if qos_or_depth < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=qos_or_depth)
    raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")


def check_type(wanted: str, kind: Any) -> None:
    """What is no ROS type, or one of another sort than "message" or "service", fails as in rclpy."""
    if not hasattr(kind, "_type_name"):
        raise AttributeError(
            f"type object '{type(kind).__name__}' has no attribute '_TYPE_SUPPORT' This might be a ROS 1 message type "
            "but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace after your ROS 1 "
            "workspace."
        )
    is_service = hasattr(kind, "Request")
    if is_service != (wanted == "service"):
        other = "message" if wanted == "service" else "service"
        raise RuntimeError(
            f"The {wanted} type provided is not valid ({kind}), this might be a {other} or action"
        )
