"""rclpy.publisher"""

from __future__ import annotations

from collections import deque
from copy import deepcopy
from typing import Any

from chatrobot.programs.inside import graph, robot
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import Destroyable, RCLError
from chatrobot.programs.names.rclpy.qos import DurabilityPolicy, QoSProfile


class PublisherHandle(Destroyable):
    """The way of what is published on `name`. `kept` is for subscriptions that come late."""

    def __init__(self, context: Any, name: str, msg_type: type[Any]) -> None:
        super().__init__()
        self.context = context
        self.name = name
        self.msg_type = msg_type
        self.send = robot.sender(name, msg_type)
        self.kept: deque[Any] = deque()

    def kept_for(self, subscription: Any) -> list[Any]:
        """What a late subscription gets."""
        late = subscription.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        return list(self.kept) if late and subscription.msg_type is self.msg_type else []


class Publisher:
    """Sends to the program's own subscriptions, and to the robot where its topic is the robot's."""

    def __init__(
        self,
        publisher_impl: PublisherHandle,
        msg_type: type[Any],
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: Any,
        callback_group: Any,
    ) -> None:
        self.__publisher = publisher_impl
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.event_handlers: list[Any] = []
        publisher_impl.kept = deque(maxlen=max(1, qos_profile.depth))
        graph.add_publisher(publisher_impl)
        get_link().send("topic", "publishes", publisher_impl.name, msg_type._type_name)

    def publish(self, msg: Any) -> None:
        with self.handle:
            if not isinstance(msg, self.msg_type):
                raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
            impl = self.__publisher
            if not impl.context._is_valid:
                raise RCLError(
                    "Failed to publish: publisher's context is invalid, at ./src/rcl/publisher.c:389"
                )
            get_link().count_publish()
            if impl.send is not None:
                impl.send(msg)
            if self.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
                impl.kept.append(deepcopy(msg))
            graph.publish(impl, msg)

    def get_subscription_count(self) -> int:
        """The robot listens to its own topic."""
        with self.handle:
            get_link().look()
            return graph.count_subscriptions(self.__publisher.name) + (self.__publisher.send is not None)

    @property
    def topic_name(self) -> str:
        with self.handle:
            return self.__publisher.name

    @property
    def handle(self) -> Any:
        return self.__publisher

    def assert_liveliness(self) -> None:
        """It lives."""

    def wait_for_all_acked(self, timeout: Any = None) -> bool:
        return True

    def destroy(self) -> None:
        if not self.__publisher.is_destroyed:
            self.__publisher.destroy_when_not_in_use()
            graph.remove_publisher(self.__publisher)
