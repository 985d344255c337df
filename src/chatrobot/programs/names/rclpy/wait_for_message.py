"""rclpy.wait_for_message"""

from __future__ import annotations

from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.executors import SingleThreadedExecutor


def wait_for_message(
    msg_type: type[Any], node: Any, topic: str, *, qos_profile: Any = 1, time_to_wait: float = -1
) -> tuple[bool, Any]:
    """(True, message), or (False, None) after `time_to_wait` seconds; negative waits for ever."""
    got: list[Any] = []
    subscription = node.create_subscription(msg_type, topic, got.append, qos_profile)
    executor = SingleThreadedExecutor(context=node.context)
    previous = node.executor
    until_ns = get_link().now_ns() + int(time_to_wait * 1e9)
    try:
        executor.add_node(node)
        while not got and node.context.ok() and (time_to_wait < 0 or get_link().now_ns() < until_ns):
            left_s = (until_ns - get_link().now_ns()) * 1e-9 if time_to_wait >= 0 else None
            executor.spin_once(left_s)
    finally:
        executor.remove_node(node)
        if previous is not None:
            previous.add_node(node)
        node.destroy_subscription(subscription)
    return (True, got[0]) if got else (False, None)
