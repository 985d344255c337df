"""What our nodes use of rclpy, without ROS: it delivers, and fails, as Jazzy's was seen to (tests/ros has the real).

Publishing needs no executor, delivering does; a callback's exception leaves through `spin`; what is destroyed or shut
down raises RuntimeErrors; reliable readers do not hear best-effort writers; names are validated; arguments may rename.
"""

from __future__ import annotations

import contextlib
import copy
import queue
import re
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from enum import Enum
from importlib.machinery import ModuleSpec
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from fake_ros_messages import CLASSES
from fake_ros_messages import modules as message_modules

Option = Enum("Option", "KEEP_LAST RELIABLE BEST_EFFORT VOLATILE TRANSIENT_LOCAL NO STEADY_TIME")


# ruff: noqa: N818 - their names
class RCLError(RuntimeError): ...


class InvalidHandle(RuntimeError): ...


class NotInitializedException(Exception): ...


class NameValidationException(ValueError): ...


class InvalidTopicNameException(NameValidationException): ...


class InvalidNodeNameException(NameValidationException): ...


class InvalidNamespaceException(NameValidationException): ...


class ExternalShutdownException(Exception): ...


class InvalidParameterTypeException(Exception): ...


class InvalidParameterValueException(Exception): ...


class Ros:
    """All nodes there are: every context of the process meets every other."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.clock_s = 0.0
        self.log: list[tuple[str, str, str]] = []
        """Severity, logger and text."""

    def each(self, kind: str, topic: str) -> Iterator[Any]:
        for node in tuple(self.nodes):
            yield from (end for end in tuple(getattr(node, kind)) if end.topic == topic)

    def call(self, service: str, timeout_s: float = 10.0) -> Any:
        """What a client of that std_srvs/Trigger gets."""
        node, callback = next((n, n.services[service]) for n in self.nodes if service in n.services)
        answers: queue.Queue[Any] = queue.Queue()
        node.inbox.put(lambda: answers.put(callback(None, SimpleNamespace())))
        return answers.get(timeout=timeout_s)

    def parameters(self, name: str) -> dict[str, Any]:
        node = next(node for node in self.nodes if node.get_name() == name)
        return {key: value for key, (value, _) in node.parameters.items()}


class Context:
    def __init__(self) -> None:
        self.is_valid = False
        self.renames: dict[str, str] = {}
        self.overrides: dict[str, Any] = {}


class Publisher:
    def __init__(self, node: Node, kind: type, topic: str, qos: Any) -> None:
        self.node, self.kind, self.topic, self.qos = node, kind, topic, qos
        self.kept: list[Any] = []

    def _matched(self) -> list[Subscription]:
        if self.node.is_destroyed:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        if not self.node.context.is_valid:
            raise RCLError("Failed to publish: publisher's context is invalid")
        return [s for s in self.node.ros.each("subscriptions", self.topic) if s.hears(self)]

    def get_subscription_count(self) -> int:
        return len(self._matched())

    def publish(self, message: Any) -> None:
        if not isinstance(message, self.kind):
            raise TypeError(f"Expected {self.kind}, got {type(message)}")
        if self.qos.durability is Option.TRANSIENT_LOCAL:
            self.kept = [message][-self.qos.depth :]
        for subscription in self._matched():
            subscription.take(copy.deepcopy(message))


class Handle:
    """What is below a subscription: messages that wait to be taken."""

    def __init__(self) -> None:
        self.waiting: deque[Any] = deque()

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: object) -> None:
        pass

    def take_message(self, _kind: type, _raw: bool) -> tuple[Any, dict[str, int]] | None:
        return (self.waiting.popleft(), {}) if self.waiting else None


class Subscription:
    def __init__(self, node: Node, kind: type, topic: str, callback: Any, qos: Any) -> None:
        self.node, self.kind, self.topic, self.callback, self.qos = node, kind, topic, callback, qos
        self.msg_type, self.raw, self.handle = kind, False, Handle()

    def hears(self, publisher: Publisher) -> bool:
        reliable = publisher.qos.reliability is Option.RELIABLE
        keeps = publisher.qos.durability is Option.TRANSIENT_LOCAL
        return (
            self.kind is publisher.kind
            and (reliable or self.qos.reliability is Option.BEST_EFFORT)
            and (keeps or not self.wants_kept)
        )

    @property
    def wants_kept(self) -> bool:
        return getattr(self.qos, "durability", Option.VOLATILE) is Option.TRANSIENT_LOCAL

    def take(self, message: Any) -> None:
        self.handle.waiting.append(message)
        self.node.inbox.put(self._execute)

    def _execute(self) -> None:
        """As the executor does it once for each turn: nothing where the callback has taken it before."""
        taken = self.handle.take_message(self.msg_type, self.raw)
        if taken is not None:
            self.callback(taken[0])


class Node:
    def __init__(self, ros: Ros, name: str, context: Context, namespace: str | None) -> None:
        if not context.is_valid:
            raise NotInitializedException("rclpy.init() has not been called")
        self.ros, self.context = ros, context
        self.name = context.renames.get("__node", name)
        self.namespace = "/" + context.renames.get("__ns", namespace or "").strip("/")
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", self.name):
            raise InvalidNodeNameException(f"Invalid node name: {name!r}")
        self.inbox: queue.Queue[Callable[[], Any]] = queue.Queue()
        self.publishers: list[Publisher] = []
        self.subscriptions: list[Subscription] = []
        self.services: dict[str, Any] = {}
        self.timers: list[list[Any]] = []
        self.parameters: dict[str, tuple[Any, Any]] = {}
        self.is_destroyed = False
        self.declare_parameter("use_sim_time", False)
        ros.nodes.append(self)

    def get_name(self) -> str:
        return self.name

    def get_namespace(self) -> str:
        return self.namespace

    def resolve_topic_name(self, topic: str) -> str:
        if not re.fullmatch(r"(/|~/)?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*", topic):
            raise InvalidTopicNameException(f"Invalid topic name: {topic!r}")
        base = self.namespace.rstrip("/")
        own = f"{base}/{self.name}"
        full = own + topic[1:] if topic[0] == "~" else topic if topic[0] == "/" else f"{base}/{topic}"
        found = self.context.renames.get(topic, self.context.renames.get(full, full))
        return found if found.startswith("/") else f"{base}/{found}"

    def create_publisher(self, kind: type, topic: str, qos: Any) -> Publisher:
        publisher = Publisher(self, kind, self.resolve_topic_name(topic), qos)
        self.publishers.append(publisher)
        return publisher

    def create_subscription(self, kind: type, topic: str, callback: Any, qos: Any) -> Subscription:
        subscription = Subscription(self, kind, self.resolve_topic_name(topic), callback, qos)
        self.subscriptions.append(subscription)
        for publisher in self.ros.each("publishers", subscription.topic):
            if subscription.wants_kept and subscription.hears(publisher):
                for message in publisher.kept:
                    subscription.take(copy.deepcopy(message))
        return subscription

    def get_logger(self) -> Any:
        name = f"{self.namespace}/{self.name}".strip("/").replace("/", ".")
        return SimpleNamespace(
            name=name,
            info=lambda text: self.ros.log.append(("info", name, text)),
            warning=lambda text: self.ros.log.append(("warn", name, text)),
            error=lambda text: self.ros.log.append(("error", name, text)),
        )

    def create_service(self, _kind: type, name: str, callback: Any) -> None:
        self.services[self.resolve_topic_name(name)] = callback

    def create_timer(self, period_s: float, callback: Any, clock: Any) -> None:  # noqa: ARG002
        self.timers.append([time.monotonic() + period_s, period_s, callback])

    def create_guard_condition(self, callback: Callable[[], Any]) -> Any:
        def trigger() -> None:
            if self.is_destroyed:
                raise InvalidHandle("cannot use Destroyable because destruction was requested")
            self.inbox.put(callback)

        return SimpleNamespace(trigger=trigger)

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        return self._infos("publishers", topic)

    def get_subscriptions_info_by_topic(self, topic: str) -> list[Any]:
        return self._infos("subscriptions", topic)

    def get_topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        ends = [end for node in self.ros.nodes for end in (*node.publishers, *node.subscriptions)]
        types = {
            topic: {_type_name(end.kind) for end in ends if end.topic == topic}
            for topic in {e.topic for e in ends}
        }
        return [(topic, sorted(names)) for topic, names in sorted(types.items())]

    def _infos(self, kind: str, topic: str) -> list[Any]:
        return [
            SimpleNamespace(
                node_name=end.node.name, node_namespace=end.node.namespace, topic_type=_type_name(end.kind)
            )
            for end in self.ros.each(kind, self.resolve_topic_name(topic))
        ]

    def declare_parameter(self, name: str, default: Any, descriptor: Any = None) -> Any:
        value = self.context.overrides.get(name, default)
        if type(value) is not type(default):
            raise InvalidParameterTypeException(f"wrong type for {name}")
        ranges = vars(descriptor) if descriptor is not None else {}
        for bounds in (*ranges.get("floating_point_range", ()), *ranges.get("integer_range", ())):
            if not bounds.from_value <= value <= bounds.to_value:
                raise InvalidParameterValueException(f"{name} is out of range")
        self.parameters[name] = (value, descriptor)
        return SimpleNamespace(value=value)

    def get_parameter(self, name: str) -> Any:
        return SimpleNamespace(value=self.parameters[name][0])

    def get_clock(self) -> Any:
        now_s = self.ros.clock_s if self.parameters["use_sim_time"][0] else time.time()
        seconds = int(now_s), int(now_s % 1.0 * 1e9)
        now = SimpleNamespace(nanoseconds=round(now_s * 1e9), seconds_nanoseconds=lambda: seconds)
        return SimpleNamespace(now=lambda: now)

    def destroy_node(self) -> None:
        self.is_destroyed = True
        if self in self.ros.nodes:
            self.ros.nodes.remove(self)


class SingleThreadedExecutor:
    def __init__(self, *, context: Context) -> None:
        self.context = context
        self.node: Any = None

    def add_node(self, node: Node) -> None:
        self.node = node

    def spin_once(self) -> None:
        if not self.context.is_valid:
            raise ExternalShutdownException
        for timer in self.node.timers:
            if time.monotonic() >= timer[0]:
                timer[0] += timer[1]
                timer[2]()
        with contextlib.suppress(queue.Empty):
            self.node.inbox.get(timeout=0.002)()

    def shutdown(self) -> None:
        """Nothing is left to wait for."""


def _read_arguments(context: Context, arguments: list[str]) -> None:
    words = iter(arguments[arguments.index("--ros-args") + 1 :])
    for word in words:
        if word == "--disable-stdout-logs":
            continue
        left, separator, right = next(words, "").partition(":=")
        if word not in ("-p", "-r") or not separator:
            raise RCLError(f"Couldn't parse arguments: {word}")
        if word == "-r":
            context.renames[left] = right
        else:
            named = {"true": True, "false": False}
            number = re.fullmatch(r"-?[0-9]+(\.[0-9]*)?", right)
            parsed = right if number is None else float(right) if number[1] else int(right)
            context.overrides[left] = named.get(right.lower(), parsed)


def _rclpy(ros: Ros) -> dict[str, ModuleType]:
    def init(*, args: Any, context: Context, domain_id: int | None, signal_handler_options: Any) -> None:  # noqa: ARG001
        if context.is_valid:
            raise RuntimeError("Context.init() must only be called once")
        if args:
            _read_arguments(context, args)
        context.is_valid = True

    def try_shutdown(*, context: Context) -> None:
        context.is_valid = False

    def create_node(name: str, *, context: Context, namespace: str | None) -> Node:
        return Node(ros, name, context, namespace)

    exceptions = {n: e for n, e in globals().items() if isinstance(e, type) and issubclass(e, Exception)}
    contents: dict[str, dict[str, Any]] = {
        "rclpy": {"init": init, "try_shutdown": try_shutdown, "create_node": create_node},
        "rclpy.clock": {"Clock": lambda clock_type: clock_type, "ClockType": Option},
        "rclpy.context": {"Context": Context},
        "rclpy.exceptions": exceptions,
        "rclpy.executors": {
            "SingleThreadedExecutor": SingleThreadedExecutor,
            "ExternalShutdownException": ExternalShutdownException,
        },
        "rclpy.qos": {
            "DurabilityPolicy": Option, "HistoryPolicy": Option, "ReliabilityPolicy": Option,
            "QoSProfile": SimpleNamespace,
        },
        "rclpy.signals": {"SignalHandlerOptions": Option},
        "rclpy.utilities": {"get_rmw_implementation_identifier": lambda: "rmw_fake_cpp"},
        "rcl_interfaces": {},
        "rcl_interfaces.msg": {
            "FloatingPointRange": SimpleNamespace, "IntegerRange": SimpleNamespace,
            "ParameterDescriptor": SimpleNamespace,
        },
        "std_srvs": {},
        "std_srvs.srv": {"Trigger": object},
    }  # fmt: skip
    made = {name: ModuleType(name) for name in contents}
    for name, values in contents.items():
        vars(made[name]).update(values)
    made["rclpy"].__spec__ = ModuleSpec("rclpy", None)
    return made


_OVER_RCLPY = ("wire.ros.convert", "wire.ros.node", "wire.ros.wire", "nodes.ros_interfaces")


def install(monkeypatch: pytest.MonkeyPatch) -> Ros:
    """Let this process believe that ROS is sourced, with nobody else there."""
    ros = Ros()
    for name, module in {**_rclpy(ros), **message_modules()}.items():
        monkeypatch.setitem(sys.modules, name, module)
    for name in _OVER_RCLPY:  # imported anew, and forgotten again with the test
        monkeypatch.setitem(sys.modules, f"chatrobot.{name}", ModuleType(name))
        del sys.modules[f"chatrobot.{name}"]
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    return ros


def _type_name(kind: type) -> str:
    return next(name.replace("/", "/msg/") for name, known in CLASSES.items() if known is kind)
