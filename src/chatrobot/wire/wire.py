"""What every wire can do: publish and subscribe by topic. Every backend runs one contract suite (tests/wire)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple, TypeVar

from chatrobot.core.clock import Clock, RealClock
from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Flag, Imu, LaserScan, Message, Number, Odometry

M = TypeVar("M", bound=Message)


class Endpoint(NamedTuple):
    """Somebody else's end of a topic. `topic` is absolute (`/robot1/odom`), `type_name` is `package/msg/Name`."""

    topic: str
    type_name: str
    role: Literal["publishes", "listens"]


class Wire(ABC):
    """One process's end of a wire.

    Topics are relative names without a leading slash (`cmd_vel`). Nothing blocks: a message for a receiver that
    does not read is dropped, the rest stays in order. A sender that listens hears itself. Callbacks come on a
    thread of the backend (the memory wire: the publisher's) and must return at once.

    Three methods make a wire. All else is what some wires can do; the defaults are right for a wire that cannot.
    """

    comes_back: bool = False
    """The other end may be gone for a while and come back: an error may pass, and is worth another try."""
    knows_others: bool = False
    """`survey` and `publishers_of` tell who else is on it."""
    sees_others_leave: bool = False
    """Whoever is missing in `survey` has left: it is never merely unknown. The guard relies on it."""
    namespace: str = ""
    """That of our node, without slashes around it; empty for none, and where the wire has no nodes."""

    @abstractmethod
    def publish(self, topic: str, message: Message) -> None:
        """Send to all who listen.

        Raises:
            WireError: the wire is closed or its other end is gone.
        """

    @abstractmethod
    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        """Call `callback` for each message of type `kind` on `topic`; others on it are dropped."""

    @abstractmethod
    def close(self) -> None:
        """Leave. Closing twice does no harm."""

    def publish_fields(  # noqa: B027 - to do nothing is right where there is nothing to do, here and below
        self, topic: str, type_name: str, fields: Mapping[str, Any], *, is_kept: bool = False
    ) -> None:
        """Publish a ROS message that has no planar form (`tf2_msgs/msg/TFMessage`); dropped where there are none.

        Args:
            fields: nested dictionaries; what is left out is zero. Stamps as ROS has them (`stamps.to_wall_s`).
            is_kept: who listens later gets the last message, too (ROS's transient local durability).
        """

    def advertise(self, topic: str, kind: type[Message]) -> None:  # noqa: B027
        """Let listeners find us before the first message, where the wire needs it: a first zero must not be lost."""

    def wait_for_listener(self, topic: str, kind: type[Message], timeout_s: float, count: int = 1) -> bool:  # noqa: ARG002
        """Block until `count` listen on `topic`, ourselves included; False where they don't in time."""
        return True

    def publishers_of(self, topic: str) -> list[str]:  # noqa: ARG002
        """Return who publishes on `topic` besides our own session, by name, as far as the wire knows."""
        return []

    def survey(self) -> list[Endpoint]:
        """Return the endpoints of others, as far as they have been discovered."""
        return []

    def resolve(self, topic: str) -> str:
        """Return the name under which any other end reaches our `topic`: ROS remaps, and knows namespaces."""
        return topic

    def rewire(self, wiring: Wiring) -> None:  # noqa: B027
        """Take the robot to be wired like this; before anything is published or listened to."""

    @property
    def is_connected(self) -> bool:
        """The other end is there, as far as this wire can know."""
        return True

    @property
    def has_null_ranges(self) -> bool:
        """Open space cannot be told from a range that was not measured, as far as scans have come."""
        return False

    @property
    def clock(self) -> Clock:
        """The clock that the stamps of this wire's messages are of."""
        return RealClock()


SENSOR_KINDS: Mapping[str, type[Any]] = {
    "odom": Odometry,
    "imu": Imu,
    "scan": LaserScan,
    "bumper": Flag,
    "battery": Number,
}


def subscribe_sensors(wire: Wire, wiring: Wiring, hear: Mapping[str, Callable[[Any], None]]) -> None:
    """Have each callback of `hear`, by its sensor's name, take what that sensor says, if the robot has it."""
    for sensor, topic in wiring.sensor_topics.items():
        if sensor in hear:
            wire.subscribe(topic, SENSOR_KINDS[sensor], hear[sensor])
