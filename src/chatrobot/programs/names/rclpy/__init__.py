"""rclpy"""

from __future__ import annotations

from typing import Any

from chatrobot.programs.names.rclpy.context import Context as Context
from chatrobot.programs.names.rclpy.parameter import Parameter as Parameter
from chatrobot.programs.names.rclpy.signals import SignalHandlerOptions as SignalHandlerOptions
from chatrobot.programs.names.rclpy.task import Future as Future
from chatrobot.programs.names.rclpy.utilities import get_default_context as get_default_context
from chatrobot.programs.names.rclpy.utilities import (
    get_rmw_implementation_identifier as get_rmw_implementation_identifier,
)
from chatrobot.programs.names.rclpy.utilities import ok as ok
from chatrobot.programs.names.rclpy.utilities import shutdown as _shutdown
from chatrobot.programs.names.rclpy.utilities import try_shutdown as _try_shutdown

_executors: list[Any] = []


def init(
    *,
    args: list[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> None:
    context = get_default_context() if context is None else context
    context.init(args, domain_id=domain_id)


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    _shutdown(context=context)


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    _try_shutdown(context=context)


def get_global_executor() -> Any:
    """The one that `spin` uses where none is given."""
    if not _executors:
        from chatrobot.programs.names.rclpy.executors import SingleThreadedExecutor

        _executors.append(SingleThreadedExecutor())
        get_default_context().on_shutdown(_forget_global_executor)
    return _executors[0]


def _forget_global_executor() -> None:
    _executors.pop().shutdown()


def create_node(node_name: str, **options: Any) -> Any:
    from chatrobot.programs.names.rclpy.node import Node

    return Node(node_name, **options)


def spin_once(node: Any, *, executor: Any = None, timeout_sec: float | None = None) -> None:
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        executor.remove_node(node)


def spin(node: Any, executor: Any = None) -> None:
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        while executor.context.ok():
            executor.spin_once()
    finally:
        executor.remove_node(node)


def spin_until_future_complete(
    node: Any, future: Future, executor: Any = None, timeout_sec: float | None = None
) -> None:
    executor = get_global_executor() if executor is None else executor
    added = False
    try:
        added = executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if added:
            executor.remove_node(node)
