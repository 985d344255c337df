"""rclpy.client"""

from __future__ import annotations

import threading
import time
from collections import deque
from copy import deepcopy
from typing import Any

from chatrobot.programs.inside import graph
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle
from chatrobot.programs.names.rclpy.qos import QoSProfile
from chatrobot.programs.names.rclpy.task import Future

LOOKS_EVERY_S = 0.25


class Client:
    """Calls a service of the program; there is no other."""

    def __init__(
        self, node: Any, srv_type: Any, srv_name: str, qos_profile: QoSProfile, callback_group: Any
    ) -> None:
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.service_name: str = node.resolve_service_name(srv_name)
        self.qos_profile = qos_profile
        self.callback_group = callback_group
        self.is_destroyed = False
        self._node = node
        self._responses: deque[tuple[Future, Any]] = deque()
        get_link().send("topic", "listens", self.service_name, srv_type._type_name)

    def call_async(self, request: Any) -> Future:
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        self._check()
        future = Future()
        service = graph.find_service(self.service_name, self.srv_type)
        if service is not None:
            service.receive(deepcopy(request), lambda response: self._receive(future, deepcopy(response)))
        return future

    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Waits; for ever where nobody spins."""
        done = threading.Event()
        future = self.call_async(request)
        future.add_done_callback(lambda _: done.set())
        if not done.wait(timeout_sec):
            raise TimeoutError
        return future.result()

    def remove_pending_request(self, future: Future) -> None:
        """Its answer is not wanted any more."""
        self._responses = deque(entry for entry in self._responses if entry[0] is not future)

    def _receive(self, future: Future, response: Any) -> None:
        self._responses.append((future, response))
        self._node._wake_executor()

    @property
    def is_waiting(self) -> bool:
        return bool(self._responses)

    def take(self) -> tuple[Future, Any]:
        return self._responses.popleft()

    def service_is_ready(self) -> bool:
        self._check()
        get_link().look()
        return graph.find_service(self.service_name, self.srv_type) is not None

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        until_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        while not self.service_is_ready():
            left_s = LOOKS_EVERY_S if until_s is None else min(LOOKS_EVERY_S, until_s - time.monotonic())
            if left_s <= 0.0 or not self._node.context.is_valid:
                return False
            time.sleep(left_s)
        return True

    def destroy(self) -> None:
        self.is_destroyed = True

    def _check(self) -> None:
        if self.is_destroyed:
            raise InvalidHandle(DESTROYED)

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
