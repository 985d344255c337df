"""rclpy.publisher, rclpy.subscription"""

from __future__ import annotations

import inspect
from collections import deque
from copy import deepcopy
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.errors import Destroyable, Entity, Queue, RCLError
from chatrobot.programs.names.qos import DurabilityPolicy, QoSProfile


class PublisherHandle(Destroyable):
    """The way of what is published on `name`. `kept` is for subscriptions that come late."""

    def __init__(self, context: Any, name: str, msg_type: type[Any]) -> None:
        super().__init__()
        self.context = context
        self.name = name
        self.msg_type = msg_type
        self.send = graph.sender(name, msg_type)
        self.kept: deque[Any] = deque()

    def kept_for(self, subscription: Any) -> list[Any]:
        """What a late subscription gets."""
        late = subscription.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
        return list(self.kept) if late and subscription.msg_type is self.msg_type else []


class Publisher(Entity):
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
        super().__init__(publisher_impl)
        self.__publisher = publisher_impl
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.event_handlers: list[Any] = []
        publisher_impl.kept = deque(maxlen=max(1, qos_profile.depth))
        graph.publishers[publisher_impl.name].append(publisher_impl)
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
            return len(graph.subscriptions[self.__publisher.name]) + (self.__publisher.send is not None)

    @property
    def topic_name(self) -> str:
        with self.handle:
            return self.__publisher.name

    def assert_liveliness(self) -> None:
        """It lives."""

    def wait_for_all_acked(self, timeout: Any = None) -> bool:
        return True

    def destroy(self) -> None:
        if not self.__publisher.is_destroyed:
            self.__publisher.destroy_when_not_in_use()
            graph.publishers[self.__publisher.name].remove(self.__publisher)


class MessageInfo(dict[str, Any]):
    """What a callback with two arguments gets besides the message."""


class SubscriptionHandle(Queue):
    """What comes in on `name`: the last messages, as many as the depth."""

    sensor = ""


class Subscription(Entity):
    """Calls back with what the program or the robot's sensors say."""

    def __init__(
        self,
        subscription_impl: SubscriptionHandle,
        msg_type: type[Any],
        topic: str,
        callback: Any,
        callback_group: Any,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: Any,
    ) -> None:
        super().__init__(subscription_impl)
        self.__subscription = impl = subscription_impl
        self.msg_type = msg_type
        self.topic = topic
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        self.event_handlers: list[Any] = []
        depth = qos_profile.depth if qos_profile.depth > 0 else 10
        impl.queue = deque(maxlen=depth)
        get_link().send("topic", "listens", impl.name, msg_type._type_name)
        found = graph.sensor_of(impl.name, msg_type)
        if found is not None:
            impl.sensor, self.__convert = found
            get_link().listen(impl.sensor, depth, self.__hear)
        graph.add_subscription(self)

    def __hear(self, values: list[Any]) -> None:
        self._receive(self.__convert(values))

    def _receive(self, message: Any) -> None:
        self.__subscription.put(message)

    def _take(self) -> tuple[Any, ...]:
        message = self.__subscription.queue.popleft()
        return (message, MessageInfo()) if self.__wants_info else (message,)

    def get_publisher_count(self) -> int:
        with self.handle:
            get_link().look()
            return len(graph.publishers[self.__subscription.name]) + bool(self.__subscription.sensor)

    @property
    def topic_name(self) -> str:
        with self.handle:
            return self.__subscription.name

    @property
    def callback(self) -> Any:
        return self.__callback

    @callback.setter
    def callback(self, value: Any) -> None:
        self.__callback = value
        self.__wants_info = _wants_info(value)

    def destroy(self) -> None:
        impl = self.__subscription
        if not impl.is_destroyed:
            impl.destroy_when_not_in_use()
            graph.subscriptions[impl.name].remove(self)
            if impl.sensor:
                get_link().unlisten(impl.sensor, self.__hear)


def _wants_info(callback: Any) -> bool:
    """Whether it takes what is known of a message besides the message."""
    for count in (1, 2):
        try:
            inspect.signature(callback).bind(*range(count))
        except TypeError:
            continue
        except ValueError:  # a builtin does not say
            return False
        return count == 2
    raise RuntimeError(
        "Subscription.__init__(): callback should be either be callable with one argument"
        "(to get only the message) or two (to get message and message info)"
    )
