"""rclpy.context"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.arguments import parsed
from chatrobot.programs.names.rclpy.impl.logging_severity import LoggingSeverity
from chatrobot.programs.names.rclpy.logging import set_logger_level
from chatrobot.programs.ros_args import RosArguments


class Context:
    """Between `init` and `shutdown` it is ok."""

    def __init__(self) -> None:
        self._is_initialized = False
        self._is_shut_down = False
        self._callbacks: list[Callable[[], Any]] = []
        self._ros_arguments = RosArguments()

    def init(
        self, args: Any = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        if self._is_initialized:
            raise RuntimeError("Context.init() must only be called once")
        if domain_id is not None and domain_id < 0:
            raise RuntimeError("domain_id must be a non-negative integer")
        self._ros_arguments = parsed(sys.argv if args is None else args)
        for logger, level in self._ros_arguments.levels:
            set_logger_level(logger, LoggingSeverity[level])
        self._is_initialized = True

    def ok(self) -> bool:
        get_link().look()
        return self._is_valid

    @property
    def _is_valid(self) -> bool:
        """As `ok`, at no cost of time."""
        return self._is_initialized and not self._is_shut_down

    @property
    def _was_initialized(self) -> bool:
        return self._is_initialized

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        if not callable(callback):
            raise TypeError("callback should be a callable")
        if not self._is_valid:
            callback()
        else:
            self._callbacks.append(callback)

    def shutdown(self) -> None:
        if not self._is_initialized:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        if self._is_shut_down:
            raise RuntimeError("failed to shutdown: rcl_shutdown already called on the given context")
        self._finish()

    def try_shutdown(self) -> None:
        if self._is_valid:
            self._finish()

    def _finish(self) -> None:
        self._is_shut_down = True
        callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            callback()

    def destroy(self) -> None:
        """It is not used any more."""
        self.try_shutdown()

    @property
    def handle(self) -> Context:
        """There is none below this one."""
        return self

    def get_domain_id(self) -> int:
        return 0

    def __enter__(self) -> Context:
        self.init()
        return self

    def __exit__(self, *_: object) -> None:
        self.try_shutdown()
