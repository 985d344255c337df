"""rclpy.qos, rclpy.event_handler"""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import Any

from chatrobot.programs.names.clock import Duration


class InvalidQoSProfileException(Exception):
    """A profile that says too little or contradicts itself."""

    def __init__(self, *args: object) -> None:
        super().__init__("Invalid QoSProfile", *args)


class QoSPolicyEnum(IntEnum):
    """Base of the policies."""

    @classmethod
    def short_keys(cls) -> list[str]:
        return [key.lower() for key in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        return int(cls[name.upper()])

    @property
    def short_key(self) -> str:
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """How many messages are kept."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether lost messages are sent again."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """Whether who comes late gets what was sent before."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """How a publisher shows that it lives."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy


class QoSProfile:
    """How a topic is served. In the box everything is delivered in order; `depth` and durability count."""

    def __init__(
        self,
        history: int | None = None,
        depth: int | None = None,
        reliability: int | None = None,
        durability: int | None = None,
        lifespan: Duration | None = None,
        deadline: Duration | None = None,
        liveliness: int | None = None,
        liveliness_lease_duration: Duration | None = None,
        avoid_ros_namespace_conventions: bool | None = None,
    ) -> None:
        if history is None:
            if depth is None:
                raise InvalidQoSProfileException("History and/or depth settings are required.")
            history = HistoryPolicy.KEEP_LAST
        assert isinstance(history, int)
        self.history = HistoryPolicy(history)
        if self.history == HistoryPolicy.KEEP_LAST and depth is None:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        self.depth = 10 if depth is None else depth
        assert isinstance(self.depth, int)
        self.reliability = ReliabilityPolicy(_int(reliability, ReliabilityPolicy.RELIABLE))
        self.durability = DurabilityPolicy(_int(durability, DurabilityPolicy.VOLATILE))
        self.lifespan = _duration(lifespan)
        self.deadline = _duration(deadline)
        self.liveliness = LivelinessPolicy(_int(liveliness, LivelinessPolicy.SYSTEM_DEFAULT))
        self.liveliness_lease_duration = _duration(liveliness_lease_duration)
        self.avoid_ros_namespace_conventions = bool(avoid_ros_namespace_conventions)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoSProfile) and vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value}' for key, value in vars(self).items())})"


def _int(value: Any, default: int) -> int:
    if value is None:
        return default
    assert isinstance(value, int)
    return value


def _duration(value: Any) -> Duration:
    if value is None:
        return Duration()
    assert isinstance(value, Duration)
    return value


qos_profile_default = QoSProfile(depth=10)
qos_profile_system_default = QoSProfile(history=HistoryPolicy.SYSTEM_DEFAULT, depth=0)
qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = QoSProfile(depth=10)
qos_profile_parameters = QoSProfile(depth=1000)
qos_profile_parameter_events = QoSProfile(depth=1000)
qos_profile_best_available = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_AVAILABLE)
qos_profile_action_status_default = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class QoSPresetProfiles(Enum):
    """The profiles by name."""

    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        return [key.lower() for key in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        return cls[name.upper()].value


class _Callbacks:
    def __init__(self, **callbacks: Any) -> None:
        self.__dict__.update(callbacks)


class PublisherEventCallbacks(_Callbacks):
    """Taken and never called: in the box no QoS goes wrong."""


class SubscriptionEventCallbacks(_Callbacks):
    """Taken and never called: in the box no QoS goes wrong."""
