"""The modules that a program may import of ours, under the names that ROS gives them.

`rclpy` stands in a few modules of `names`, an idea each; a program finds it where rclpy has it. All is imported here,
by the warm server: in the sandbox no file can be opened any more.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from types import ModuleType

from chatrobot.programs.inside.interfaces import INTERFACES
from chatrobot.programs.names import (
    clock,
    context,
    errors,
    executors,
    logging,
    node,
    parameter,
    qos,
    rclpy,
    services,
    task,
    tf_transformations,
    timers,
    topics,
)

HOMES: Mapping[str, tuple[ModuleType, str]] = {
    "rclpy": (rclpy, ""),
    "rclpy._rclpy_pybind11": (
        errors, "RCLError NodeNameNonExistentError RCLInvalidROSArgsError UnknownROSArgsError InvalidHandle Destroyable Entity Queue"
    ),
    "rclpy.action": (services, "ActionClient ActionServer"),
    "rclpy.callback_groups": (task, "CallbackGroup ReentrantCallbackGroup MutuallyExclusiveCallbackGroup"),
    "rclpy.client": (services, "Client ClientHandle"),
    "rclpy.clock": (clock, "Clock ROSClock"),
    "rclpy.clock_type": (clock, "ClockType"),
    "rclpy.constants": (clock, ""),
    "rclpy.context": (context, "Context"),
    "rclpy.duration": (clock, "Duration"),
    "rclpy.event_handler": (qos, "PublisherEventCallbacks SubscriptionEventCallbacks"),
    "rclpy.exceptions": (errors, "*"),
    "rclpy.executors": (executors, "*"),
    "rclpy.guard_condition": (timers, "GuardCondition GuardHandle"),
    "rclpy.impl": (logging, ""),
    "rclpy.impl.logging_severity": (logging, "LoggingSeverity"),
    "rclpy.impl.rcutils_logger": (logging, "RcutilsLogger"),
    "rclpy.logging": (logging, ""),
    "rclpy.node": (node, "*"),
    "rclpy.parameter": (parameter, "*"),
    "rclpy.publisher": (topics, "Publisher PublisherHandle"),
    "rclpy.qos": (qos, "*"),
    "rclpy.service": (services, "Service ServiceHandle"),
    "rclpy.signals": (rclpy, "SignalHandlerOptions"),
    "rclpy.subscription": (topics, "Subscription SubscriptionHandle MessageInfo"),
    "rclpy.task": (task, "Future Task"),
    "rclpy.time": (clock, "Time"),
    "rclpy.timer": (timers, "Timer TimerHandle Rate"),
    "rclpy.utilities": (context, ""),
    "rclpy.wait_for_message": (rclpy, ""),
    "tf_transformations": (tf_transformations, ""),
}  # fmt: skip
"""Each of ROS's modules: where its contents are, and the classes that say they are of it (`*`: those left)."""


def modules() -> dict[str, ModuleType]:
    """Return all that a program may import of ours, packages included, by its name."""
    found = {package: ModuleType(package, package) for package in {name.split(".")[0] for name in INTERFACES}}
    for name, (home, _) in HOMES.items():
        found[name] = ModuleType(name, home.__doc__)
        contents = {key: value for key, value in vars(home).items() if not key.startswith("__")}
        vars(found[name]).update(contents)
    found.update(INTERFACES)
    for name, module in found.items():
        parent, _, own = name.rpartition(".")
        if parent:
            found[parent].__path__ = []
            setattr(found[parent], own, module)
    return found


def install() -> None:
    """Have programs import these modules; a class says that it is of the one that ROS has it in."""
    for name, (home, classes) in sorted(HOMES.items(), key=lambda entry: entry[1][1] == "*"):
        for key, value in vars(home).items():
            is_own = isinstance(value, type) and value.__module__ == home.__name__
            if is_own and (key in classes.split() or classes == "*"):
                value.__module__ = name
    sys.modules.update(modules())
