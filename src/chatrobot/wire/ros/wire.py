"""The wire over rclpy: publishing goes straight to the middleware from any thread, whatever the executor does."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any, Literal

from rclpy.exceptions import NameValidationException
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from chatrobot.core.clock import Clock, RealClock
from chatrobot.core.errors import WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Message
from chatrobot.wire.ros.convert import message_class, to_message
from chatrobot.wire.ros.node import RosNode
from chatrobot.wire.ros_messages import RosForm, is_sensor, read_depth, ros_form, stamped
from chatrobot.wire.stamps import StampTranslator, to_wall_s
from chatrobot.wire.wire import Endpoint, M, Wire

_WRITE_DEPTH = 10
"""ROS's; how much a reader keeps nobody asks."""
_LOOK_S = 0.005
_READ_AT_ONCE = 100
"""Of one topic; then the others have their turn."""
_UNKNOWN = "_NODE_NAME_UNKNOWN_"


class _Publisher:
    """One topic as one type."""

    def __init__(self, node: RosNode, topic: str, form: RosForm, *, is_kept: bool = False) -> None:
        self._form = form
        qos = _qos(1, durability=DurabilityPolicy.TRANSIENT_LOCAL) if is_kept else _qos(_WRITE_DEPTH)
        self._publisher = node.handle.create_publisher(message_class(form.type_name), topic, qos)

    def send(self, message: Message) -> None:
        self.send_fields(self._form.to_ros(message))

    def send_fields(self, fields: Mapping[str, Any]) -> None:
        try:
            self._publisher.publish(to_message(self._form.type_name, fields))
        except RuntimeError as error:  # rclpy's InvalidHandle and RCLError: the node is gone
            raise WireError(f"publishing failed: {error}") from error

    def listener_count(self) -> int:
        try:
            return int(self._publisher.get_subscription_count())
        except RuntimeError as error:
            raise WireError(f"this end of the wire is closed: {error}") from error


class _Subscription:
    """One topic as one kind of message, for all callbacks of this end."""

    def __init__(self, form: RosForm, local_s: Callable[[float], float]) -> None:
        self._form = form
        self._local_s = local_s
        self.callbacks: tuple[Callable[[Any], None], ...] = ()
        self.subscription: Any = None
        """ROS's own; set once it is there."""

    def deliver(self, ros_message: Any) -> None:
        """The message that the executor has taken, and all that wait behind it.

        The executor takes one a turn, and a turn costs it a millisecond: on a busy machine it would fall behind,
        and hear ever older odometry.
        """
        for _ in range(_READ_AT_ONCE):
            self._deliver_one(ros_message)
            ros_message = self._take_next()
            if ros_message is None:
                return

    def _take_next(self) -> Any:
        subscription = self.subscription
        if subscription is None:
            return None
        try:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
        except RuntimeError:  # rclpy's InvalidHandle: the node is closing
            return None
        return taken[0] if taken is not None else None

    def _deliver_one(self, ros_message: Any) -> None:
        try:
            message = self._form.from_ros(ros_message)
        except (AttributeError, TypeError, ValueError, OverflowError):
            return  # a wire never dies of a bad message
        if message is None:
            return
        timed = stamped(message)
        if timed is not None:
            message = timed._replace(stamp_s=self._local_s(timed.stamp_s))
        for callback in self.callbacks:
            callback(message)


class RosWire(Wire):
    """A node's end of ROS. It owns the node: closing closes it.

    Relative topics are in the node's namespace; remappings hold. With `use_sim_time` stamps are the simulation's
    and pass through; else those of other machines are translated to the monotonic clock.

    Args:
        wiring: the robot's topics and types.
    """

    knows_others = True
    sees_others_leave = True

    def __init__(self, wiring: Wiring, node: RosNode) -> None:
        self.node = node
        self.namespace = str(node.handle.get_namespace()).strip("/")
        self._wiring = wiring
        self._lock = threading.Lock()
        self._publishers: dict[tuple[str, object], _Publisher] = {}
        self._subscriptions: dict[tuple[str, type], _Subscription] = {}
        self.has_own_time = node.has_own_time

    def publish(self, topic: str, message: Message) -> None:
        publisher = self._publishers.get((topic, type(message)))
        if publisher is None:
            publisher = self._open_publisher(topic, type(message), self._form(topic, type(message)))
        elif self.node.is_closed:
            raise WireError("this end of the wire is closed")
        timed = None if self.has_own_time else stamped(message)
        publisher.send(message if timed is None else timed._replace(stamp_s=to_wall_s(timed.stamp_s)))

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        with self._lock:
            self._must_be_open()
            subscription = self._subscriptions.get((topic, kind))
            if subscription is not None:
                subscription.callbacks = (*subscription.callbacks, callback)
                return
            form = self._form(topic, kind)
            subscription = _Subscription(form, self._stamp_reader())
            subscription.callbacks = (callback,)
            reliability = (
                ReliabilityPolicy.BEST_EFFORT
                if is_sensor(topic, kind, self._wiring)
                else ReliabilityPolicy.RELIABLE
            )
            try:
                subscription.subscription = self.node.handle.create_subscription(
                    message_class(form.type_name),
                    topic,
                    subscription.deliver,
                    _qos(read_depth(kind), reliability),
                )
            except (RuntimeError, NameValidationException) as error:
                raise WireError(f"cannot listen on {topic}: {error}") from error
            self._subscriptions = {**self._subscriptions, (topic, kind): subscription}

    def publish_fields(
        self, topic: str, type_name: str, fields: Mapping[str, Any], *, is_kept: bool = False
    ) -> None:
        publisher = self._publishers.get((topic, type_name))
        if publisher is None:
            form = RosForm(type_name, dict, lambda _: None)
            publisher = self._open_publisher(topic, type_name, form, is_kept=is_kept)
        publisher.send_fields(fields)

    def advertise(self, topic: str, kind: type[Message]) -> None:
        self._open_publisher(topic, kind, self._form(topic, kind))

    def wait_for_listener(self, topic: str, kind: type[Message], timeout_s: float, count: int = 1) -> bool:
        publisher = self._open_publisher(topic, kind, self._form(topic, kind))
        ends_s = time.monotonic() + timeout_s
        while publisher.listener_count() < count:
            if time.monotonic() > ends_s:
                return False
            time.sleep(_LOOK_S)
        return True

    def publishers_of(self, topic: str) -> list[str]:
        handle = self.node.handle
        try:
            found = handle.get_publishers_info_by_topic(topic)
        except (RuntimeError, NameValidationException) as error:
            raise WireError(f"cannot look at {topic}: {error}") from error
        names = [_full_name(info.node_namespace, info.node_name) for info in found]
        own = self._own_name()
        for known, _ in self._publishers:  # a second node may have our name: only as many as we have are ours
            if known == topic and own in names:
                names.remove(own)
        return sorted(set(names))

    def survey(self) -> list[Endpoint]:
        handle, own = self.node.handle, self._own_name()

        def others(topic: str, infos: list[Any], role: Literal["publishes", "listens"]) -> list[Endpoint]:
            return [
                Endpoint(topic, info.topic_type, role)
                for info in infos
                if _full_name(info.node_namespace, info.node_name) != own
            ]

        found: list[Endpoint] = []
        for topic, _ in handle.get_topic_names_and_types():
            found += others(topic, handle.get_publishers_info_by_topic(topic), "publishes")
            found += others(topic, handle.get_subscriptions_info_by_topic(topic), "listens")
        return found

    def rewire(self, wiring: Wiring) -> None:
        self._wiring = wiring

    def resolve(self, topic: str) -> str:
        return str(self.node.handle.resolve_topic_name(topic))

    @property
    def clock(self) -> Clock:
        return _RosClock(self.node) if self.has_own_time else RealClock()

    def close(self) -> None:
        self.node.close()

    def _own_name(self) -> str:
        return _full_name(self.node.handle.get_namespace(), self.node.handle.get_name())

    def _must_be_open(self) -> None:
        if self.node.is_closed:
            raise WireError("this end of the wire is closed")

    def _form(self, topic: str, kind: type[Any]) -> RosForm:
        return ros_form(topic, kind, self._wiring)

    def _stamp_reader(self) -> Callable[[float], float]:
        if self.has_own_time:
            return lambda stamp_s: stamp_s or self.node.now_s()
        clock = StampTranslator()
        return lambda stamp_s: clock.local_s(stamp_s, time.monotonic())

    def _open_publisher(self, topic: str, key: object, form: RosForm, *, is_kept: bool = False) -> _Publisher:
        with self._lock:
            self._must_be_open()
            publisher = self._publishers.get((topic, key))
            if publisher is None:
                try:
                    publisher = _Publisher(self.node, topic, form, is_kept=is_kept)
                except (RuntimeError, NameValidationException) as error:
                    raise WireError(f"cannot publish on {topic}: {error}") from error
                self._publishers = {**self._publishers, (topic, key): publisher}
            return publisher


class _RosClock(RealClock):
    """ROS's time, which may be a simulation's. A machine that slept has not looked after its robot all the same."""

    def __init__(self, node: RosNode) -> None:
        self._node = node

    def now_s(self) -> float:
        return self._node.now_s()


def _qos(
    depth: int,
    reliability: Any = ReliabilityPolicy.RELIABLE,
    durability: Any = DurabilityPolicy.VOLATILE,
) -> QoSProfile:
    """ROS's defaults: what its own endpoints and every base ask for."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth, reliability=reliability, durability=durability
    )


def _full_name(namespace: str, name: str) -> str:
    if name == _UNKNOWN or not name:
        return "a process that is no ROS node"
    return f"{namespace.rstrip('/')}/{name}"
