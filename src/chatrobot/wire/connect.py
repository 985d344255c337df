"""A wire by its address: what Motion, the guard, the nodes and the simulated robot ask for.

local:PATH                  the processes of this machine (a bare path means the same)
dds:  dds://42  dds://42/robot1         a ROS 2 domain, by default ROS_DOMAIN_ID's; a robot's namespace
ros:  ros://42  ros://42/robot1         the same through ROS's own library, where it is sourced
rosbridge:ws://host:9090  …#robot1      a robot's rosbridge; a robot's namespace

A namespace in the address goes before the one in the robot's profile.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol, runtime_checkable

from chatrobot.core.clock import Clock, RealClock
from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.wire.ros.wire import RosWire

ADDRESSES = "local:PATH, dds: or ros:, dds://DOMAIN[/NAMESPACE] or rosbridge:ws://HOST:9090[#NAMESPACE]"
_DOMAIN = re.compile(
    r"(?:dds|ros):(?://(?P<domain>[0-9]{0,3})(?:/(?P<namespace>[A-Za-z_][A-Za-z0-9_/]*)?)?)?"
)


Connect = Callable[[str, Wiring, str], Wire]
"""What `connect_wire` is: address, wiring and our name there to an end of the wire."""


@runtime_checkable
class Discovering(Protocol):
    """A wire whose ends need time to find each other."""

    def advertise(self, topic: str, kind: type[Message]) -> None: ...

    def wait_for_listener(
        self, topic: str, kind: type[Message], timeout_s: float, count: int = 1
    ) -> bool: ...


@runtime_checkable
class Knowing(Protocol):
    """A wire that knows who publishes."""

    def publishers_of(self, topic: str) -> list[str]: ...


class Endpoint(NamedTuple):
    """Somebody else's end of a topic. `topic` is absolute (`/robot1/odom`), `type_name` is `package/msg/Name`."""

    topic: str
    type_name: str
    role: Literal["publishes", "listens"]


@runtime_checkable
class Surveying(Protocol):
    """A wire that can tell who else is on it."""

    def survey(self) -> list[Endpoint]:
        """The endpoints of others, as far as they have been discovered."""
        ...

    def resolve(self, topic: str) -> str:
        """A topic as `survey` names it."""
        ...

    def rewire(self, wiring: Wiring) -> None:
        """Take the robot to be wired like this; before anything is published or listened to."""
        ...


def connect_wire(address: str, wiring: Wiring, node_name: str) -> Wire:
    """This process's end of the wire at `address`.

    Args:
        address: one of `ADDRESSES`.
        wiring: the robot's topics and types.
        node_name: what others see us as, where the wire has names.

    Raises:
        UsageError: there is no such address, or what it needs is not installed.
        WireError: nobody answers there.
    """
    scheme, separator, rest = address.partition(":")
    if scheme == "dds" and separator:
        return _connect_dds(address, wiring, node_name)
    if scheme == "ros" and separator:
        return connect_ros(address, wiring, node_name)
    if scheme == "rosbridge" and separator:
        return _connect_rosbridge(rest, wiring)
    from chatrobot.wire.local import LocalWire

    path = rest if scheme == "local" and separator else address
    if not path or ("/" not in path and not separator):
        raise UsageError(f"{address!r} is no wire", allowed=ADDRESSES)
    return LocalWire(path)


@runtime_checkable
class Returning(Protocol):
    """A wire whose other end may be gone for a while and come back."""

    @property
    def is_connected(self) -> bool: ...


@runtime_checkable
class Nulling(Protocol):
    """A wire whose scans may hold null: for infinity (open space) and for NaN (nothing measured) alike."""

    @property
    def has_null_ranges(self) -> bool: ...


def has_null_ranges(wire: Wire) -> bool:
    """Whether open space cannot be told from a range that was not measured, as far as scans have come."""
    return wire.has_null_ranges if isinstance(wire, Nulling) else False


def advertise(wire: Wire, topic: str, kind: type[Message]) -> None:
    """Let listeners find us before the first message, where the wire needs it: a first zero must not be lost."""
    if isinstance(wire, Discovering):
        wire.advertise(topic, kind)


def wait_for_listener(wire: Wire, topic: str, kind: type[Message], timeout_s: float, count: int = 1) -> bool:
    """Block until `count` listen on `topic`, where the wire can know; False where they don't in time."""
    return wire.wait_for_listener(topic, kind, timeout_s, count) if isinstance(wire, Discovering) else True


def publishers_of(wire: Wire, topic: str) -> list[str]:
    """Who publishes on `topic` besides our own session, by name, where the wire can know."""
    return wire.publishers_of(topic) if isinstance(wire, Knowing) else []


@runtime_checkable
class Resolving(Protocol):
    """A wire whose topics may go by other names than we use: ROS remaps them and knows namespaces."""

    def resolve(self, topic: str) -> str: ...


def resolved(wire: Wire, topic: str) -> str:
    """The name under which any other end of `wire` reaches our `topic`."""
    return wire.resolve(topic) if isinstance(wire, Resolving) and topic else topic


@runtime_checkable
class Namespaced(Protocol):
    """A wire where we are a node in a namespace."""

    @property
    def namespace(self) -> str: ...


def namespace_of(wire: Wire) -> str:
    """The namespace of our node, without slashes around it; empty for none, and where the wire has no nodes."""
    return wire.namespace if isinstance(wire, Namespaced) else ""


@runtime_checkable
class Timed(Protocol):
    """A wire that may keep a time of its own: that of a simulation."""

    @property
    def has_own_time(self) -> bool: ...

    def now_s(self) -> float: ...

    def suspended_s(self) -> float: ...


def clock_of(wire: Wire) -> Clock:
    """The clock that the stamps of this wire's messages are of."""
    return wire if isinstance(wire, Timed) and wire.has_own_time else RealClock()


def comes_back(wire: Wire) -> bool:
    """Whether an error of this wire may pass: what could not be sent is worth another try."""
    return isinstance(wire, Returning)


def wire_address(on: str) -> str:
    """The address of the wire that `--on` names.

    Raises:
        UsageError: no robot is to be had there, or ROS is not here.
    """
    if on == "rosbridge":
        return "rosbridge:ws://localhost:9090"
    if on == "ros" or on.startswith("ros:"):
        require_ros()
    if on in ("dds", "ros") or on.startswith(("dds:", "ros:", "rosbridge:", "local:")):
        return on if ":" in on else f"{on}:"
    raise UsageError(
        f"this version cannot drive a robot over {on!r}",
        where="--on",
        allowed="sim, dds or ros, dds://DOMAIN/NAMESPACE, rosbridge:ws://HOST:9090 or local:PATH",
    )


def is_on_this_machine(address: str) -> bool:
    """Whether all who meet on that wire are on this machine: beats are cheap there, and hardly ever late."""
    scheme, separator, _ = address.partition(":")
    if scheme == "dds" and separator:
        from chatrobot.wire.dds.discovery import discovery_from

        discovery = discovery_from(os.environ)
        return discovery.range in ("LOCALHOST", "OFF") and not discovery.peers and not discovery.uri
    if scheme == "ros" and separator:
        from chatrobot.wire.ros.environment import reaches_this_machine_alone

        return reaches_this_machine_alone(os.environ)
    if scheme == "rosbridge" and separator:
        from urllib.parse import urlsplit

        return urlsplit(address.partition(":")[2]).hostname in ("localhost", "127.0.0.1", "::1")
    return True


def _connect_dds(address: str, wiring: Wiring, node_name: str) -> Wire:
    from chatrobot.wire.dds.discovery import discovery_from

    domain_id, namespace = domain_and_namespace(address)
    try:
        from chatrobot.wire.dds.wire import DdsWire
    except ImportError as error:
        raise UsageError(
            f"DDS is not installed here ({error.name or error})",
            allowed="pip install 'chatrobot[dds]'; its wheels are for x86-64 Linux and Python up to 3.13, elsewhere"
            " take --on rosbridge, or --on ros where ROS 2 is sourced",
        ) from error
    return DdsWire(
        wiring,
        node_name,
        namespace=namespace or wiring.namespace,
        discovery=discovery_from(os.environ, domain_id),
    )


def connect_ros(address: str, wiring: Wiring, node_name: str, ros_args: Sequence[str] = ()) -> RosWire:
    """A ROS node of its own; `ros_args` is what stood behind `--ros-args`.

    Raises:
        UsageError: there is no such address, ROS is not here, or it cannot use the arguments.
        WireError: ROS cannot be opened.
    """
    domain_id, namespace = domain_and_namespace(address)
    try:
        from chatrobot.wire.ros.node import RosNode
        from chatrobot.wire.ros.wire import RosWire
    except ImportError as error:  # not sourced, or of another Python
        raise _no_ros(str(error)) from error
    node = RosNode(node_name, namespace=namespace or wiring.namespace, domain_id=domain_id, ros_args=ros_args)
    return RosWire(wiring, node)


def require_ros() -> None:
    """Quick: without loading it.

    Raises:
        UsageError: ROS is not here; how to get it.
    """
    if find_spec("rclpy") is None:
        raise _no_ros("no rclpy")


def _no_ros(why: str) -> UsageError:
    from chatrobot.wire.ros.environment import HOW_TO_GET_IT

    return UsageError(f"ROS 2 is not here ({why})", allowed=HOW_TO_GET_IT)


def domain_and_namespace(address: str) -> tuple[int | None, str]:
    """What `dds://42/robot1` or `ros://42/robot1` names; None for the environment's domain."""
    from chatrobot.wire.dds.discovery import MAX_DOMAIN_ID

    match = _DOMAIN.fullmatch(address)
    domain_id = int(match["domain"]) if match and match["domain"] else None
    if match is None or (domain_id or 0) > MAX_DOMAIN_ID:
        scheme = address.partition(":")[0]
        raise UsageError(
            f"{address!r} is no domain", allowed=f"{scheme}: or {scheme}://0 to {scheme}://{MAX_DOMAIN_ID}"
        )
    return domain_id, match["namespace"] or ""


def _connect_rosbridge(rest: str, wiring: Wiring) -> Wire:
    try:
        from chatrobot.wire.rosbridge import RosbridgeWire
    except ImportError as error:
        raise UsageError(
            f"rosbridge is not installed here ({error.name or error})",
            allowed="pip install 'chatrobot[rosbridge]'",
        ) from error
    url, _, namespace = rest.partition("#")
    return RosbridgeWire(url, wiring, namespace=namespace or wiring.namespace)
