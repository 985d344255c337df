"""rclpy.client, rclpy.service, and rclpy.action, which refuses."""

from __future__ import annotations

import threading
import time
from collections import deque
from copy import deepcopy
from typing import Any, NoReturn

from chatrobot.programs.inside import graph
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.errors import Entity, Queue
from chatrobot.programs.names.qos import QoSProfile
from chatrobot.programs.names.task import Future


class ServiceHandle(Queue):
    """What is asked of a service: requests, each with what takes its response."""

    srv_type: Any = None


class Service(Entity):
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
        super().__init__(service_impl)
        self.__service = service_impl
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        service_impl.srv_type = srv_type
        graph.services[service_impl.name] = service_impl

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

    def configure_introspection(
        self, clock: Any, service_event_qos_profile: Any, introspection_state: Any
    ) -> None:
        """Nobody outside could look on."""

    def destroy(self) -> None:
        self.__service.destroy_when_not_in_use()
        if graph.services.get(self.__service.name) is self.__service:
            del graph.services[self.__service.name]


LOOKS_EVERY_S = 0.25


class ClientHandle(Queue):
    """What services answer: a future and its response."""

    srv_type: Any = None

    def find_service(self) -> Any:
        """Who serves it, None for nobody."""
        return graph.find_service(self.name, self.srv_type)


class Client(Entity):
    """Calls a service of the program; there is no other."""

    def __init__(
        self,
        context: Any,
        client_impl: ClientHandle,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: Any,
    ) -> None:
        self.context = context
        super().__init__(client_impl)
        self.__client = client_impl
        client_impl.srv_type = srv_type
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self.callback_group = callback_group
        get_link().send("topic", "listens", client_impl.name, srv_type._type_name)

    def call_async(self, request: Any) -> Future:
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        with self.handle:
            impl, future = self.__client, Future()
            service = impl.find_service()
            if service is not None:
                service.put((deepcopy(request), lambda response: impl.put((future, deepcopy(response)))))
            return future

    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Waits; for ever where nobody spins."""
        done = threading.Event()
        future = self.call_async(request)
        future.add_done_callback(lambda _: done.set())
        if not done.wait(timeout_sec):
            raise TimeoutError
        return future.result()

    def get_pending_request(self, sequence_number: int) -> Future:
        """Requests have no numbers here: what is answered is taken at once."""
        raise KeyError(sequence_number)

    def remove_pending_request(self, future: Future) -> None:
        """Its answer is not wanted any more."""
        impl = self.__client
        impl.queue = deque(entry for entry in impl.queue if entry[0] is not future)

    def service_is_ready(self) -> bool:
        with self.handle:
            get_link().look()
            return self.__client.find_service() is not None

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        until_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        while not self.service_is_ready():
            left_s = LOOKS_EVERY_S if until_s is None else min(LOOKS_EVERY_S, until_s - time.monotonic())
            if left_s <= 0.0 or not self.context._is_valid:
                return False
            time.sleep(left_s)
        return True

    @property
    def service_name(self) -> str:
        with self.handle:
            return self.__client.name

    def configure_introspection(
        self, clock: Any, service_event_qos_profile: Any, introspection_state: Any
    ) -> None:
        """Nobody outside could look on."""


def _refuse(name: str) -> NoReturn:
    raise NotImplementedError(f"{name}: actions are not available here; publish velocities, or use a service")


class ActionClient:
    """Needs a server that only a whole ROS system has."""

    def __init__(self, *_: Any, **__: Any) -> None:
        _refuse("ActionClient")


class ActionServer:
    """Needs clients that only a whole ROS system has."""

    def __init__(self, *_: Any, **__: Any) -> None:
        _refuse("ActionServer")
