"""rclpy.node"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from chatrobot.programs.inside import graph, ros_names
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from chatrobot.programs.names.rclpy.client import Client
from chatrobot.programs.names.rclpy.clock import Clock, ROSClock
from chatrobot.programs.names.rclpy.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NotInitializedException,
)
from chatrobot.programs.names.rclpy.guard_condition import GuardCondition
from chatrobot.programs.names.rclpy.impl.rcutils_logger import RcutilsLogger
from chatrobot.programs.names.rclpy.logging import get_logger
from chatrobot.programs.names.rclpy.node_parameters import NodeParameters
from chatrobot.programs.names.rclpy.publisher import Publisher
from chatrobot.programs.names.rclpy.qos import QoSProfile, qos_profile_services_default
from chatrobot.programs.names.rclpy.service import Service
from chatrobot.programs.names.rclpy.subscription import Subscription
from chatrobot.programs.names.rclpy.timer import Rate, Timer
from chatrobot.programs.names.rclpy.utilities import get_default_context

T = TypeVar("T")


class Node(NodeParameters):
    """What a program's class derives from."""

    def __init__(
        self,
        node_name: str,
        *,
        context: Any = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: Any = None,
        start_parameter_services: bool = True,
        parameter_overrides: list[Any] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._context = get_default_context() if context is None else context
        if not self._context.is_valid:
            raise NotInitializedException("cannot create node")
        self._name = get_link().settings.remaps.get("__node", node_name)
        space = namespace or ""
        self._namespace = space if space.startswith("/") else f"/{space}"
        _raise_for(ros_names.node_name_problem(self._name), InvalidNodeNameException, self._name)
        _raise_for(ros_names.namespace_problem(self._namespace), InvalidNamespaceException, self._namespace)
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._rates: dict[int, Timer] = {}
        self._executor: Any = None
        self._clock = ROSClock()
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        self._default_callback_group = MutuallyExclusiveCallbackGroup()
        graph.nodes.append(self)
        overrides = {**get_link().settings.params, **{p.name: p.value for p in parameter_overrides or ()}}
        NodeParameters.__init__(
            self, overrides, allow_undeclared_parameters, automatically_declare_parameters_from_overrides
        )

    # --- what it is ---

    def get_name(self) -> str:
        return self._name

    def get_namespace(self) -> str:
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def get_logger(self) -> RcutilsLogger:
        return self._logger

    def get_clock(self) -> Clock:
        return self._clock

    @property
    def context(self) -> Any:
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        return self._default_callback_group

    @property
    def publishers(self) -> Iterator[Publisher]:
        yield from tuple(self._publishers)

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        yield from tuple(self._subscriptions)

    @property
    def clients(self) -> Iterator[Client]:
        yield from tuple(self._clients)

    @property
    def services(self) -> Iterator[Service]:
        yield from tuple(self._services)

    @property
    def timers(self) -> Iterator[Timer]:
        yield from tuple(self._timers)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        yield from tuple(self._guards)

    @property
    def executor(self) -> Any:
        return self._executor

    @executor.setter
    def executor(self, new_executor: Any) -> None:
        previous = self._executor
        if previous is new_executor:
            return
        self._executor = new_executor
        if previous is not None:
            previous.remove_node(self)
        if new_executor is not None:
            new_executor.add_node(self)

    def forget_executor(self, executor: Any) -> None:
        """`executor` has let go of this node."""
        if self._executor is executor:
            self._executor = None

    def _wake_executor(self) -> None:
        if self._executor is not None:
            self._executor.wake()

    # --- names ---

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        _raise_for(ros_names.topic_name_problem(topic), InvalidTopicNameException, topic)
        remaps = {} if only_expand else get_link().settings.remaps
        return ros_names.resolve(topic, self._name, self._namespace, remaps)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        _raise_for(ros_names.topic_name_problem(service), InvalidServiceNameException, service)
        remaps = {} if only_expand else get_link().settings.remaps
        return ros_names.resolve(service, self._name, self._namespace, remaps)

    # --- making ---

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        _check_type(msg_type, "_fields_and_field_types")
        publisher = publisher_class(self, msg_type, topic, _qos(qos_profile), self._group(callback_group))
        self._publishers.append(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> Subscription:
        _check_type(msg_type, "_fields_and_field_types")
        group = self._group(callback_group)
        subscription = Subscription(self, msg_type, topic, callback, _qos(qos_profile), group, raw)
        return self._add(self._subscriptions, subscription, group)

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        _check_type(srv_type, "Request")
        group = self._group(callback_group)
        return self._add(self._clients, Client(self, srv_type, srv_name, qos_profile, group), group)

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        _check_type(srv_type, "Request")
        group = self._group(callback_group)
        service = Service(self, srv_type, srv_name, callback, group, qos_profile)
        return self._add(self._services, service, group)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        group = self._group(callback_group)
        period_ns = int(float(timer_period_sec) * 1e9)
        clock = self._clock if clock is None else clock
        timer = Timer(
            callback,
            group,
            period_ns,
            clock,
            context=self._context,
            autostart=autostart,
            wake=self._wake_executor,
        )
        return self._add(self._timers, timer, group)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, MutuallyExclusiveCallbackGroup(), clock)
        rate = Rate(timer, context=self._context)
        self._rates[id(rate)] = timer
        return rate

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        group = self._group(callback_group)
        return self._add(self._guards, GuardCondition(callback, group, self._wake_executor), group)

    # --- destroying ---

    def destroy_publisher(self, publisher: Publisher) -> bool:
        return _destroy(self._publishers, publisher)

    def destroy_subscription(self, subscription: Subscription) -> bool:
        return _destroy(self._subscriptions, subscription)

    def destroy_client(self, client: Client) -> bool:
        return _destroy(self._clients, client)

    def destroy_service(self, service: Service) -> bool:
        return _destroy(self._services, service)

    def destroy_timer(self, timer: Timer) -> bool:
        return _destroy(self._timers, timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return _destroy(self._guards, guard)

    def destroy_rate(self, rate: Rate) -> bool:
        timer = self._rates.pop(id(rate), None)
        rate.destroy()
        return timer is not None and self.destroy_timer(timer)

    def destroy_node(self) -> None:
        """Everything it made is destroyed; a second time does nothing."""
        if self._executor is not None:
            self._executor.remove_node(self)
        for entities in (
            self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards,
        ):  # fmt: skip
            for entity in tuple(entities):
                _destroy(entities, entity)
        if self in graph.nodes:
            graph.nodes.remove(self)

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()

    # --- who is there ---

    def count_publishers(self, topic_name: str) -> int:
        return graph.count_publishers(self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        name = self.resolve_topic_name(topic_name)
        return graph.count_subscriptions(name) + (name == get_link().settings.topics.get("cmd_vel"))

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        return graph.topic_types()

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        return graph.service_types()

    def get_node_names(self) -> list[str]:
        return [node.get_name() for node in graph.nodes]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(node.get_name(), node.get_namespace()) for node in graph.nodes]

    # --- inner ---

    def _group(self, group: CallbackGroup | None) -> CallbackGroup:
        return self._default_callback_group if group is None else group

    def _add(self, entities: list[T], entity: T, group: CallbackGroup) -> T:
        entities.append(entity)
        group.add_entity(entity)
        self._wake_executor()
        return entity


def _destroy(entities: list[Any], entity: Any) -> bool:
    if entity not in entities:
        return False
    entities.remove(entity)
    entity.destroy()
    return True


def _raise_for(
    problem: tuple[str, int] | None, kind: Callable[[str, str, int], Exception], name: str
) -> None:
    if problem is not None:
        raise kind(name, *problem)


def _qos(qos_or_depth: Any) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if isinstance(qos_or_depth, int):
        if qos_or_depth < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=qos_or_depth)
    raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")


def _check_type(kind: Any, mark: str) -> None:
    """What is no ROS type at all fails as in rclpy."""
    if not hasattr(kind, mark):
        raise AttributeError(
            f"type object '{getattr(kind, '__name__', kind)}' has no attribute '_TYPE_SUPPORT'. This might be a "
            "ROS 1 message type but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace "
            "after your ROS 1 workspace."
        )
