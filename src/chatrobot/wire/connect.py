"""A wire by its address: what Motion, the guard, the nodes and the simulated robot ask for.

local:PATH                  the processes of this machine (a bare path means the same)
dds:  dds://42  dds://42/robot1         a ROS 2 domain, by default ROS_DOMAIN_ID's; a robot's namespace
rosbridge:ws://host:9090  …#robot1      a robot's rosbridge; a robot's namespace

A namespace in the address goes before the one in the robot's profile.
"""

from __future__ import annotations

import os
import re
from typing import Literal, NamedTuple, Protocol, runtime_checkable

from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import Wire

ADDRESSES = "local:PATH, dds:, dds://DOMAIN[/NAMESPACE] or rosbridge:ws://HOST:9090[#NAMESPACE]"
_DDS = re.compile(r"dds:(?://(?P<domain>[0-9]{0,3})(?:/(?P<namespace>[A-Za-z_][A-Za-z0-9_/]*)?)?)?")


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

    def full_name(self, topic: str) -> str:
        """A topic as `survey` names it."""
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


def comes_back(wire: Wire) -> bool:
    """Whether an error of this wire may pass: what could not be sent is worth another try."""
    return isinstance(wire, Returning)


def wire_address(on: str) -> str:
    """The address of the wire that `--on` names.

    Raises:
        UsageError: no robot is to be had there.
    """
    if on == "rosbridge":
        return "rosbridge:ws://localhost:9090"
    if on == "dds" or on.startswith(("dds:", "rosbridge:", "local:")):
        return on if ":" in on else f"{on}:"
    raise UsageError(
        f"this version cannot drive a robot over {on!r}",
        where="--on",
        allowed="sim, dds, dds://DOMAIN/NAMESPACE, rosbridge:ws://HOST:9090 or local:PATH",
    )


def is_on_this_machine(address: str) -> bool:
    """Whether all who meet on that wire are on this machine: beats are cheap there, and hardly ever late."""
    scheme, separator, _ = address.partition(":")
    if scheme == "dds" and separator:
        from chatrobot.wire.dds.discovery import discovery_from

        discovery = discovery_from(os.environ)
        return discovery.range in ("LOCALHOST", "OFF") and not discovery.peers and not discovery.uri
    if scheme == "rosbridge" and separator:
        from urllib.parse import urlsplit

        return urlsplit(address.partition(":")[2]).hostname in ("localhost", "127.0.0.1", "::1")
    return True


def _connect_dds(address: str, wiring: Wiring, node_name: str) -> Wire:
    from chatrobot.wire.dds.discovery import MAX_DOMAIN_ID, discovery_from

    match = _DDS.fullmatch(address)
    domain_id = int(match["domain"]) if match and match["domain"] else None
    if match is None or (domain_id or 0) > MAX_DOMAIN_ID:
        raise UsageError(f"{address!r} is no DDS domain", allowed=f"dds: or dds://0 to dds://{MAX_DOMAIN_ID}")
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
        namespace=match["namespace"] or wiring.namespace,
        discovery=discovery_from(os.environ, domain_id),
    )


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
