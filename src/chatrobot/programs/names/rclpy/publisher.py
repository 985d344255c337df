"""rclpy.publisher"""

from __future__ import annotations

from collections import deque
from copy import deepcopy
from typing import Any

from chatrobot.programs.inside import graph, robot
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle, RCLError
from chatrobot.programs.names.rclpy.qos import DurabilityPolicy, QoSProfile


class Publisher:
    """Sends to the program's own subscriptions, and to the robot where its topic is the robot's."""

    def __init__(
        self, node: Any, msg_type: type[Any], topic: str, qos_profile: QoSProfile, callback_group: Any
    ) -> None:
        self.msg_type = msg_type
        self.topic = topic
        self.topic_name = node.resolve_topic_name(topic)
        self.qos_profile = qos_profile
        self._node = node
        self._send = robot.sender(self.topic_name, msg_type)
        self._is_destroyed = False
        self._kept: deque[Any] = deque(maxlen=max(1, qos_profile.depth))
        graph.add_publisher(self)
        get_link().send("topic", "publishes", self.topic_name, msg_type._type_name)

    def publish(self, msg: Any) -> None:
        if self._is_destroyed:
            raise InvalidHandle(DESTROYED)
        if not isinstance(msg, self.msg_type):
            raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
        if not self._node.context.is_valid:
            raise RCLError("Failed to publish: publisher's context is invalid, at ./src/rcl/publisher.c:389")
        get_link().count_publish()
        if self._send is not None:
            self._send(msg)
        if self.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            self._kept.append(deepcopy(msg))
        graph.publish(self, msg)

    def kept_for(self, subscription: Any) -> list[Any]:
        """What a late subscription gets."""
        late = subscription.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        return list(self._kept) if late and subscription.msg_type is self.msg_type else []

    def get_subscription_count(self) -> int:
        """The robot listens to its own topic."""
        get_link().look()
        return graph.count_subscriptions(self.topic_name) + (self._send is not None)

    def assert_liveliness(self) -> None:
        """It lives."""

    def wait_for_all_acked(self, timeout: Any = None) -> bool:
        return True

    def destroy(self) -> None:
        if not self._is_destroyed:
            self._is_destroyed = True
            graph.remove_publisher(self)

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
