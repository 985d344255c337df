"""Whom to meet on ROS 2: its environment variables, and for DDS the configuration of Cyclone made of them. Pure.

Measured against ROS 2 processes with rmw_cyclonedds in LOCALHOST and SUBNET range, either started first, and on
machines whose only network is `lo` (docs/wires.md has the table). Two interfaces and multicast left on is what meets
all of them; in LOCALHOST range a time to live of zero keeps our multicasts on this machine, and our own
addresses are peers because who listens without multicast binds only one of them.
"""

from __future__ import annotations

import fcntl
import re
import socket
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal
from xml.sax.saxutils import quoteattr

from chatrobot.core.errors import UsageError

Range = Literal["LOCALHOST", "SUBNET", "OFF"]

MAX_DOMAIN_ID = 232
"""From 233 on its ports lie beyond 65535 (OMG DDSI-RTPS 2.5, 9.6.2)."""
LOOPBACK = "127.0.0.1"
_SIOCGIFADDR = 0x8915
_WITHOUT_RANGES = ("foxy", "galactic", "humble")
"""These know ROS_LOCALHOST_ONLY alone."""
_ADDRESS = re.compile(
    r"(?:dds|ros):(?://(?P<domain>[0-9]{0,3})(?:/(?P<namespace>[A-Za-z_][A-Za-z0-9_/]*)?)?)?"
)


def domain_and_namespace(address: str) -> tuple[int | None, str]:
    """Read what `dds://42/robot1` or `ros://42/robot1` names; None for the environment's domain.

    Raises:
        UsageError: it names no domain.
    """
    match = _ADDRESS.fullmatch(address)
    domain_id = int(match["domain"]) if match and match["domain"] else None
    if match is None or (domain_id or 0) > MAX_DOMAIN_ID:
        scheme = address.partition(":")[0]
        raise UsageError(
            f"{address!r} names no ROS 2 domain",
            allowed=f"{scheme}: or {scheme}://0/NAMESPACE to {scheme}://{MAX_DOMAIN_ID}/NAMESPACE",
        )
    return domain_id, match["namespace"] or ""


def ros_reaches_this_machine_alone(environ: Mapping[str, str]) -> bool:
    """Whether nobody on another machine can meet ROS nodes started with these variables.

    Unlike on DDS we choose no range of our own: in Jazzy a node in LOCALHOST range and one in SUBNET range, ROS's
    default, may not meet even on one machine, and then the robot's own driver would not hear us (decision 8).
    """
    if environ.get("ROS_LOCALHOST_ONLY", "").strip() == "1":
        return True
    has_peers = environ.get("ROS_STATIC_PEERS", "").strip("; ")
    if environ.get("ROS_DISTRO", "").lower() in _WITHOUT_RANGES or has_peers:
        return False
    return environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").strip() in ("LOCALHOST", "OFF")


@dataclass(frozen=True)
class Discovery:
    """Where to look.

    Attributes:
        domain_id: 0 to 232; who is on another does not exist for us.
        range: LOCALHOST meets this machine, SUBNET whom multicast reaches, OFF nobody.
        peers: hosts asked one by one, for networks without multicast.
        uri: the user's own Cyclone configuration, which then alone counts; empty for ours.
    """

    domain_id: int = 0
    range: Range = "LOCALHOST"
    peers: tuple[str, ...] = ()
    uri: str = ""

    @property
    def this_machine_only(self) -> bool:
        """Whether other machines are not to be heard at all."""
        return self.range == "LOCALHOST" and not self.peers and not self.uri


def discovery_from(environ: Mapping[str, str], domain_id: int | None = None) -> Discovery:
    """What the environment asks for; `domain_id` where the address names one.

    Raises:
        UsageError: a variable's value cannot be used.
    """
    if domain_id is None:
        domain_id = _domain_id(environ.get("ROS_DOMAIN_ID", "").strip() or "0", "ROS_DOMAIN_ID")
    peers = environ.get("CHATROBOT_PEERS", "").replace(",", ";").split(";")
    peers += environ.get("ROS_STATIC_PEERS", "").split(";")
    return Discovery(
        domain_id=domain_id,
        range=_range(environ),
        peers=tuple(dict.fromkeys(peer.strip() for peer in peers if peer.strip())),
        uri=environ.get("CYCLONEDDS_URI", "").strip(),
    )


def _domain_id(text: str, where: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) <= MAX_DOMAIN_ID):
        raise UsageError(f"{text!r} is not a ROS 2 domain", where=where, allowed=f"0 to {MAX_DOMAIN_ID}")
    return int(text)


def _range(environ: Mapping[str, str]) -> Range:
    localhost_only = environ.get("ROS_LOCALHOST_ONLY", "").strip()
    if localhost_only == "1":
        return "LOCALHOST"  # in ROS, too, it goes before the newer variable
    asked = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").strip().upper()
    if asked in ("SUBNET", "SYSTEM_DEFAULT"):
        return "SUBNET"
    if asked in ("LOCALHOST", "OFF"):
        return "LOCALHOST" if asked == "LOCALHOST" else "OFF"
    if asked:
        raise UsageError(
            f"{asked!r} is not a discovery range",
            where="ROS_AUTOMATIC_DISCOVERY_RANGE",
            allowed="LOCALHOST, SUBNET, OFF or SYSTEM_DEFAULT",
        )
    return "SUBNET" if localhost_only == "0" else "LOCALHOST"


def configuration(discovery: Discovery, addresses: Sequence[str]) -> str:
    """Cyclone's configuration.

    Args:
        addresses: this machine's IPv4 addresses other than the loopback; none on a machine with only `lo`, where
            asking Cyclone to find an interface would fail.
    """
    if discovery.uri:
        return discovery.uri
    interfaces = f'<NetworkInterface address="{LOOPBACK}" priority="0"/>'
    if addresses:
        interfaces = '<NetworkInterface autodetermine="true" priority="1"/>' + interfaces
    general = f"<Interfaces>{interfaces}</Interfaces>"
    tag = ""
    peers: tuple[str, ...] = ("localhost", *addresses, *discovery.peers)
    if discovery.range == "LOCALHOST":
        general += "<MulticastTimeToLive>0</MulticastTimeToLive>"
    elif discovery.range == "OFF":
        # Nobody but the processes that were started with this one would know the tag.
        general += "<AllowMulticast>false</AllowMulticast>"
        tag, peers = "<Tag>chatrobot_off</Tag>", ("localhost",)
    asked = "".join(f"<Peer address={quoteattr(peer)}/>" for peer in peers)
    return (
        f"<CycloneDDS><Domain><General>{general}</General><Discovery>{tag}"
        "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
        f"<Peers>{asked}</Peers></Discovery></Domain></CycloneDDS>"
    )


def machine_addresses() -> list[str]:
    """This machine's IPv4 addresses (one an interface), the loopback left out."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        for _, name in socket.if_nameindex():
            try:
                reply = fcntl.ioctl(probe.fileno(), _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
            except OSError:
                continue  # it has no address, or is down
            address = socket.inet_ntoa(reply[20:24])
            if not address.startswith("127."):
                found.append(address)
    return found
