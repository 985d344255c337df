"""rclpy.service"""

from __future__ import annotations

from collections import deque
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle
from chatrobot.programs.names.rclpy.qos import QoSProfile


class Service:
    """Answers the program's own clients."""

    def __init__(
        self,
        node: Any,
        srv_type: Any,
        srv_name: str,
        callback: Any,
        callback_group: Any,
        qos_profile: QoSProfile,
    ) -> None:
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.service_name: str = node.resolve_service_name(srv_name)
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.is_destroyed = False
        self._node = node
        self._queue: deque[tuple[Any, Any]] = deque()
        graph.add_service(self)

    def receive(self, request: Any, answer: Any) -> None:
        """A request; `answer` takes the response."""
        self._queue.append((request, answer))
        self._node._wake_executor()

    @property
    def is_waiting(self) -> bool:
        return bool(self._queue)

    def take(self) -> tuple[Any, Any]:
        return self._queue.popleft()

    def send_response(self, response: Any, answer: Any) -> None:
        if not isinstance(response, self.srv_type.Response):
            raise TypeError
        if self.is_destroyed:
            raise InvalidHandle(DESTROYED)
        answer(response)

    def destroy(self) -> None:
        self.is_destroyed = True
        graph.remove_service(self)

    def __enter__(self) -> Service:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
