"""rclpy, rclpy.signals, rclpy.wait_for_message"""

from __future__ import annotations

from enum import Enum
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.context import Context as Context
from chatrobot.programs.names.context import get_default_context as get_default_context
from chatrobot.programs.names.context import (
    get_rmw_implementation_identifier as get_rmw_implementation_identifier,
)
from chatrobot.programs.names.context import ok as ok
from chatrobot.programs.names.context import shutdown as _shutdown
from chatrobot.programs.names.context import try_shutdown as _try_shutdown
from chatrobot.programs.names.executors import SingleThreadedExecutor
from chatrobot.programs.names.node import Node
from chatrobot.programs.names.parameter import Parameter as Parameter
from chatrobot.programs.names.task import Future as Future

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
        _executors.append(SingleThreadedExecutor())
        get_default_context().on_shutdown(_forget_global_executor)
    return _executors[0]


def _forget_global_executor() -> None:
    _executors.pop().shutdown()


def create_node(node_name: str, **options: Any) -> Any:
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


class SignalHandlerOptions(Enum):
    """In the box no signal reaches a program: a stop ends it."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Nothing is to be done."""


def uninstall_signal_handlers() -> None:
    """Nothing is to be done."""


def wait_for_message(
    msg_type: type[Any], node: Any, topic: str, *, qos_profile: Any = 1, time_to_wait: float = -1
) -> tuple[bool, Any]:
    """(True, message), or (False, None) after `time_to_wait` seconds; negative waits for ever."""
    got: list[Any] = []
    subscription = node.create_subscription(msg_type, topic, got.append, qos_profile)
    executor = SingleThreadedExecutor(context=node.context)
    previous = node.executor
    until_ns = get_link().now_ns() + int(time_to_wait * 1e9)
    try:
        executor.add_node(node)
        while not got and node.context.ok() and (time_to_wait < 0 or get_link().now_ns() < until_ns):
            left_s = (until_ns - get_link().now_ns()) * 1e-9 if time_to_wait >= 0 else None
            executor.spin_once(left_s)
    finally:
        executor.remove_node(node)
        if previous is not None:
            previous.add_node(node)
        node.destroy_subscription(subscription)
    return (True, got[0]) if got else (False, None)
