"""rclpy.guard_condition"""

from __future__ import annotations

from typing import Any

from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle


class GuardCondition:
    """Has an executor call something, from any thread."""

    def __init__(self, callback: Any, callback_group: Any, wake: Any) -> None:
        self.callback = callback
        self.callback_group = callback_group
        self.is_destroyed = False
        self.is_waiting = False
        self._wake = wake

    def trigger(self) -> None:
        if self.is_destroyed:
            raise InvalidHandle(DESTROYED)
        self.is_waiting = True
        self._wake()

    def take(self) -> None:
        self.is_waiting = False

    def destroy(self) -> None:
        self.is_destroyed = True
