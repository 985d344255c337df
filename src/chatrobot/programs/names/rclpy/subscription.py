"""rclpy.subscription"""

from __future__ import annotations

import inspect
from collections import deque
from typing import Any

from chatrobot.programs.inside import graph, robot
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.qos import QoSProfile


class MessageInfo(dict[str, Any]):
    """What a callback with two arguments gets besides the message."""


class Subscription:
    """Keeps the last `depth` messages until an executor takes them."""

    def __init__(
        self,
        node: Any,
        msg_type: type[Any],
        topic: str,
        callback: Any,
        qos_profile: QoSProfile,
        callback_group: Any,
        raw: bool,
    ) -> None:
        self.msg_type = msg_type
        self.topic = topic
        self.topic_name = node.resolve_topic_name(topic)
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.raw = raw
        self.is_destroyed = False
        self._node = node
        self._wants_info = _positional(callback) == 2
        depth = qos_profile.depth if qos_profile.depth > 0 else 10
        self._queue: deque[Any] = deque(maxlen=depth)
        sensor = robot.sensor_of(self.topic_name, msg_type)
        self._sensor = sensor[0] if sensor is not None else ""
        self._convert = sensor[1] if sensor is not None else None
        get_link().send("topic", "listens", self.topic_name, msg_type._type_name)
        if self._sensor:
            get_link().listen(self._sensor, depth, self._hear)
        graph.add_subscription(self)

    def _hear(self, values: list[Any]) -> None:
        assert self._convert is not None
        self.receive(self._convert(values))

    def receive(self, message: Any) -> None:
        self._queue.append(message)
        self._node._wake_executor()

    @property
    def is_waiting(self) -> bool:
        return bool(self._queue)

    def take(self) -> tuple[Any, ...]:
        message = self._queue.popleft()
        return (message, MessageInfo()) if self._wants_info else (message,)

    def get_publisher_count(self) -> int:
        get_link().look()
        return graph.count_publishers(self.topic_name) + bool(self._sensor)

    def destroy(self) -> None:
        if not self.is_destroyed:
            self.is_destroyed = True
            graph.remove_subscription(self)
            if self._sensor:
                get_link().unlisten(self._sensor, self._hear)

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


def _positional(callback: Any) -> int:
    """How many arguments a callback needs; 1 where it does not say."""
    try:
        parameters = inspect.signature(callback).parameters.values()
    except (TypeError, ValueError):
        return 1
    return sum(
        p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) for p in parameters
    )
