"""rclpy.context, rclpy.utilities"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.errors import RCLInvalidROSArgsError, UnknownROSArgsError
from chatrobot.programs.names.logging import LoggingSeverity, set_logger_level
from chatrobot.programs.ros_args import RosArguments, RosArgumentsError, read_ros_args, split_ros_args


def parsed(args: Sequence[str]) -> RosArguments:
    try:
        found = read_ros_args(args)
    except RosArgumentsError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from error
    if found.unknown:
        raise UnknownROSArgsError(f"Found unknown ROS arguments: {list(found.unknown)!r}")
    return found


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


_default: list[Context] = []


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The process's own; after a shutdown a new one takes its place."""
    if not _default:
        _default.append(Context())
    return _default.pop() if shutting_down else _default[0]


def ok(*, context: Context | None = None) -> bool:
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None) -> None:
    (get_default_context(shutting_down=True) if context is None else context).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    if context is None:
        context = get_default_context()
        if context._is_valid:
            context = get_default_context(shutting_down=True)
    context.try_shutdown()


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Arguments without what stands between `--ros-args` and `--`."""
    return split_ros_args(sys.argv if args is None else args)[0]


def get_rmw_implementation_identifier() -> str:
    return "rmw_chatrobot"


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """-1 stands for ever."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * 1_000_000_000)
