"""rclpy.node"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from chatrobot.programs.inside import graph, ros_names
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy._rclpy_pybind11 import DESTROYED, InvalidHandle, RCLError
from chatrobot.programs.names.rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from chatrobot.programs.names.rclpy.client import Client
from chatrobot.programs.names.rclpy.clock import Clock, ROSClock
from chatrobot.programs.names.rclpy.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    NotInitializedException,
)
from chatrobot.programs.names.rclpy.guard_condition import GuardCondition
from chatrobot.programs.names.rclpy.impl.rcutils_logger import RcutilsLogger
from chatrobot.programs.names.rclpy.logging import get_logger
from chatrobot.programs.names.rclpy.node_checks import check_type, destroy, qos_of, raise_for
from chatrobot.programs.names.rclpy.node_graph import NodeGraph
from chatrobot.programs.names.rclpy.node_parameters import NodeParameters
from chatrobot.programs.names.rclpy.publisher import Publisher
from chatrobot.programs.names.rclpy.qos import QoSProfile, qos_profile_services_default
from chatrobot.programs.names.rclpy.service import Service
from chatrobot.programs.names.rclpy.subscription import Subscription
from chatrobot.programs.names.rclpy.timer import Rate, Timer
from chatrobot.programs.names.rclpy.utilities import get_default_context

T = TypeVar("T")


class Node(NodeGraph, NodeParameters):
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
        raise_for(ros_names.node_name_problem(self._name), InvalidNodeNameException, self._name)
        raise_for(ros_names.namespace_problem(self._namespace), InvalidNamespaceException, self._namespace)
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._rates: dict[int, Timer] = {}
        self._executor: Any = None
        self._is_destroyed = False
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
        self._check_destroyed()
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
    def handle(self) -> Any:
        """There is none below this one."""
        return self

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

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

    def _wake_executor(self) -> None:
        if self._executor is not None:
            self._executor.wake()

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
        check_type("message", msg_type)
        self._check_destroyed()
        self._check_context("Failed to create publisher: rcl node's context is invalid")
        publisher = publisher_class(self, msg_type, topic, qos_of(qos_profile), self._group(callback_group))
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
        check_type("message", msg_type)
        self._check_destroyed()
        self._check_context("Failed to create subscription: rcl node's context is invalid")
        group = self._group(callback_group)
        subscription = Subscription(self, msg_type, topic, callback, qos_of(qos_profile), group, raw)
        return self._add(self._subscriptions, subscription, group)

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        check_type("service", srv_type)
        self._check_destroyed()
        self._check_context("Failed to create client: rcl node's context is invalid")
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
        check_type("service", srv_type)
        self._check_destroyed()
        self._check_context("Failed to create service: rcl node's context is invalid")
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
        self._check_context(
            "failed to create timer: the given context is not valid, either rcl_init() was not called or "
            "rcl_shutdown() was called."
        )
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
        return destroy(self._publishers, publisher)

    def destroy_subscription(self, subscription: Subscription) -> bool:
        return destroy(self._subscriptions, subscription)

    def destroy_client(self, client: Client) -> bool:
        return destroy(self._clients, client)

    def destroy_service(self, service: Service) -> bool:
        return destroy(self._services, service)

    def destroy_timer(self, timer: Timer) -> bool:
        return destroy(self._timers, timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return destroy(self._guards, guard)

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
                destroy(entities, entity)
        self._is_destroyed = True
        if self in graph.nodes:
            graph.nodes.remove(self)

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()

    # --- inner ---

    def _group(self, group: CallbackGroup | None) -> CallbackGroup:
        return self._default_callback_group if group is None else group

    def _check_destroyed(self) -> None:
        if self._is_destroyed:
            raise InvalidHandle(DESTROYED)

    def _check_context(self, words: str) -> None:
        if not self._context.is_valid:
            raise RCLError(words)

    def _add(self, entities: list[T], entity: T, group: CallbackGroup) -> T:
        entities.append(entity)
        group.add_entity(entity)
        self._wake_executor()
        return entity
