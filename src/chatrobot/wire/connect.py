"""A wire by its address: what Motion, the guard, the nodes and the simulated robot ask for.

local:PATH                  the processes of this machine (a bare path means the same)
dds:  dds://42  dds://42/robot1         a ROS 2 domain, by default ROS_DOMAIN_ID's; a robot's namespace
ros:  ros://42  ros://42/robot1         the same through ROS's own library, where it is sourced
rosbridge:ws://host:9090  …#robot1      a robot's rosbridge; a robot's namespace

A namespace in the address goes before the one in the robot's profile.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import NamedTuple

from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.wire import Wire

MODULES = {
    "dds": "chatrobot.wire.dds",
    "ros": "chatrobot.wire.ros",
    "rosbridge": "chatrobot.wire.rosbridge",
    "local": "chatrobot.wire.local",
}
"""The module whose `BACKEND` opens the addresses of a scheme. A wire is added here."""
ENTRY_POINT_GROUP = "chatrobot.wires"
"""Another package's wire: the entry point's name is the scheme, its value the module."""

Connect = Callable[[str, Wiring, str], Wire]
"""What `connect_wire` is: address, wiring and our name there to an end of the wire."""


class Backend(NamedTuple):
    """A kind of wire. Its module is light: it loads the library that it stands on in `connect`, never before.

    Attributes:
        connect: opens our end; raises UsageError for a bad address and for what is not installed, else WireError.
        form: an address, for messages: `rosbridge:ws://HOST:9090`.
        is_on_this_machine: whether all who meet at an address are on this machine.
        alone: the address that the scheme alone stands for (`--on dds`).
        require: raises UsageError where it is not installed, without loading it.
    """

    connect: Connect
    form: str
    is_on_this_machine: Callable[[str], bool] = lambda _: True
    alone: str = ""
    require: Callable[[], None] = lambda: None


def connect_wire(address: str, wiring: Wiring, node_name: str) -> Wire:
    """Open this process's end of the wire at `address`.

    Args:
        address: as `--on` names it, or a local wire's path.
        wiring: the robot's topics and types.
        node_name: what others see us as, where the wire has names.

    Raises:
        UsageError: there is no such address, or what it needs is not installed.
        WireError: nobody answers there.
    """
    return _backend(_scheme(address), address).connect(address, wiring, node_name)


def wire_address(on: str) -> str:
    """Return the address of the wire that `--on` names.

    Raises:
        UsageError: no robot is to be had there, or ROS is not here.
    """
    scheme, colon, _ = on.partition(":")
    backend = _backend(scheme, on, "--on")
    backend.require()
    return on if colon else backend.alone or f"{on}:"


def is_on_this_machine(address: str) -> bool:
    """Whether all who meet on that wire are on this machine: beats are cheap there, and hardly ever late."""
    return _backend(_scheme(address), address).is_on_this_machine(address)


def _scheme(address: str) -> str:
    scheme, colon, _ = address.partition(":")
    return "local" if "/" in scheme else scheme if colon else ""


def _backend(scheme: str, address: str, where: str = "") -> Backend:
    module = MODULES.get(scheme) or _installed().get(scheme)
    if module is None:
        forms = [import_module(known).BACKEND.form for known in MODULES.values()]
        raise UsageError(
            f"{address!r} is not a robot address", where=where, allowed=f"sim, {', '.join(forms)}"
        )
    backend: Backend = import_module(module).BACKEND
    return backend


def _installed() -> dict[str, str]:
    """The modules of the wires that other packages bring. Slow: looked up where ours have no such scheme."""
    from importlib.metadata import entry_points

    return {entry.name: entry.value for entry in entry_points(group=ENTRY_POINT_GROUP)}
