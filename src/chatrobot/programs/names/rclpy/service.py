"""rclpy.service"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.names.rclpy._rclpy_pybind11 import Destroyable
from chatrobot.programs.names.rclpy.qos import QoSProfile


class ServiceHandle(Destroyable):
    """What is asked of a service, until an executor takes it."""

    def __init__(self, wake: Callable[[], None], name: str) -> None:
        super().__init__()
        self.wake = wake
        self.name = name
        self.srv_type: Any = None
        self.queue: deque[tuple[Any, Any]] = deque()

    @property
    def is_waiting(self) -> bool:
        return bool(self.queue)

    def receive(self, request: Any, answer: Any) -> None:
        """A request; `answer` takes the response."""
        self.queue.append((request, answer))
        self.wake()


class Service:
    """Answers the program's own clients."""

    def __init__(
        self,
        service_impl: ServiceHandle,
        srv_type: Any,
        srv_name: str,
        callback: Any,
        callback_group: Any,
        qos_profile: QoSProfile,
    ) -> None:
        self.__service = service_impl
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        service_impl.srv_type = srv_type
        graph.add_service(service_impl)

    def send_response(self, response: Any, header: Any) -> None:
        """`header` is of the request: it takes the response to who asked."""
        if not isinstance(response, self.srv_type.Response):
            raise TypeError
        with self.handle:
            header(response)

    @property
    def service_name(self) -> str:
        with self.handle:
            return self.__service.name

    @property
    def handle(self) -> Any:
        return self.__service

    def configure_introspection(
        self, clock: Any, service_event_qos_profile: Any, introspection_state: Any
    ) -> None:
        """Nobody outside could look on."""

    def destroy(self) -> None:
        self.__service.destroy_when_not_in_use()
        graph.remove_service(self.__service)
