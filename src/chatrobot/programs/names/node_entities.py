"""The part of `rclpy.node.Node` that makes and destroys what a program publishes, hears, calls and times with."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from chatrobot.programs.names.clock import Clock
from chatrobot.programs.names.errors import RCLError
from chatrobot.programs.names.node_graph import NodeGraph
from chatrobot.programs.names.qos import (
    PublisherEventCallbacks,
    QoSProfile,
    SubscriptionEventCallbacks,
    qos_profile_services_default,
)
from chatrobot.programs.names.services import Client, ClientHandle, Service, ServiceHandle
from chatrobot.programs.names.task import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from chatrobot.programs.names.timers import GuardCondition, Rate, Timer
from chatrobot.programs.names.topics import Publisher, PublisherHandle, Subscription, SubscriptionHandle


class NodeEntities(NodeGraph):
    """See the module."""

    context: Any
    default_callback_group: Any
    _clock: Clock
    _wake_executor: Callable[[], None]

    def __init__(self) -> None:
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._rate_group: CallbackGroup = ReentrantCallbackGroup()

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
        self.__check("Failed to create publisher: rcl node's context is invalid")
        qos_profile = qos_of(qos_profile)
        group = callback_group or self.default_callback_group
        publisher = publisher_class(
            PublisherHandle(self.context, self.resolve_topic_name(topic), msg_type),
            msg_type,
            topic,
            qos_profile,
            event_callbacks=event_callbacks or PublisherEventCallbacks(),
            callback_group=group,
        )
        self._publishers.append(publisher)
        self._wake_executor()
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
        self.__check("Failed to create subscription: rcl node's context is invalid")
        qos_profile = qos_of(qos_profile)
        group = callback_group or self.default_callback_group
        subscription = Subscription(
            SubscriptionHandle(self._wake_executor, self.resolve_topic_name(topic)),
            msg_type,
            topic,
            callback,
            group,
            qos_profile,
            raw,
            event_callbacks=event_callbacks or SubscriptionEventCallbacks(),
        )
        self.__add(self._subscriptions, subscription, group)
        return subscription

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        check_type("service", srv_type)
        self.__check("Failed to create client: rcl node's context is invalid")
        group = self.default_callback_group if callback_group is None else callback_group
        impl = ClientHandle(self._wake_executor, self.resolve_service_name(srv_name))
        client = Client(self.context, impl, srv_type, srv_name, qos_profile, group)
        self.__add(self._clients, client, group)
        return client

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
        self.__check("Failed to create service: rcl node's context is invalid")
        group = self.default_callback_group if callback_group is None else callback_group
        impl = ServiceHandle(self._wake_executor, self.resolve_service_name(srv_name))
        service = Service(impl, srv_type, srv_name, callback, group, qos_profile)
        self.__add(self._services, service, group)
        return service

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        period_ns = int(float(timer_period_sec) * 1e9)
        group = self.default_callback_group if callback_group is None else callback_group
        clock = self._clock if clock is None else clock
        timer = Timer(callback, group, period_ns, clock, context=self.context, autostart=autostart)
        timer.handle.wake = self._wake_executor
        self.__add(self._timers, timer, group)
        return timer

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, MutuallyExclusiveCallbackGroup(), clock)
        return Rate(timer, context=self.context)

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        group = self.default_callback_group if callback_group is None else callback_group
        guard = GuardCondition(callback, group, context=self.context)
        guard.handle.wake = self._wake_executor
        self.__add(self._guards, guard, group)
        return guard

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
        is_known = self.destroy_timer(rate._timer)
        rate.destroy()
        return is_known

    # --- inner ---

    def __check(self, words: str) -> None:
        with self.handle:
            if not self.context._is_valid:
                raise RCLError(words)

    def __add(self, entities: list[Any], entity: Any, group: CallbackGroup) -> None:
        group.add_entity(entity)
        entities.append(entity)
        self._wake_executor()


def destroy(entities: list[Any], entity: Any) -> bool:
    if entity not in entities:
        return False
    entities.remove(entity)
    entity.destroy()
    return True


def qos_of(qos_or_depth: Any) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if isinstance(qos_or_depth, int):
        if qos_or_depth < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=qos_or_depth)
    raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")


def check_type(wanted: str, kind: Any) -> None:
    """What is no ROS type, or one of another sort than "message" or "service", fails as in rclpy."""
    if not hasattr(kind, "_type_name"):
        raise AttributeError(
            f"type object '{type(kind).__name__}' has no attribute '_TYPE_SUPPORT' This might be a ROS 1 message type "
            "but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace after your ROS 1 "
            "workspace."
        )
    is_service = hasattr(kind, "Request")
    if is_service != (wanted == "service"):
        other = "message" if wanted == "service" else "service"
        raise RuntimeError(
            f"The {wanted} type provided is not valid ({kind}), this might be a {other} or action"
        )
