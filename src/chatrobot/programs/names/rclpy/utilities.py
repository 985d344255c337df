"""rclpy.utilities"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from chatrobot.programs.names.rclpy.context import Context

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
    kept, ours = [], False
    for argument in sys.argv if args is None else args:
        if argument == "--ros-args":
            ours = True
        elif ours and argument == "--":
            ours = False
        elif not ours:
            kept.append(argument)
    return kept


def get_rmw_implementation_identifier() -> str:
    return "rmw_chatrobot"


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """-1 stands for ever."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * 1_000_000_000)
