"""rclpy.guard_condition"""

from __future__ import annotations

from typing import Any

from chatrobot.programs.names.rclpy._rclpy_pybind11 import Destroyable


class GuardHandle(Destroyable):
    """Whether it was triggered."""

    def __init__(self) -> None:
        super().__init__()
        self.is_waiting = False
        self.wake: Any = lambda: None


class GuardCondition:
    """Has an executor call something, from any thread."""

    def __init__(self, callback: Any, callback_group: Any, context: Any = None) -> None:
        self._context = context
        self.__gc = GuardHandle()
        self.callback = callback
        self.callback_group = callback_group

    @property
    def handle(self) -> Any:
        return self.__gc

    def trigger(self) -> None:
        with self.handle:
            self.__gc.is_waiting = True
            self.__gc.wake()

    def destroy(self) -> None:
        self.__gc.destroy_when_not_in_use()
