"""The wire over DDS (Eclipse Cyclone), which is how ROS 2 processes speak: `pip install 'chatrobot[dds]'`.

`definitions` has the messages of ROS, `ros_types` makes them Cyclone's, `graph` is who is there, `wire` is the backend.
Importing this package imports none of them.
"""

from __future__ import annotations

import os

from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import Backend
from chatrobot.wire.discovery import discovery_from, domain_and_namespace
from chatrobot.wire.wire import Wire


def _connect(address: str, wiring: Wiring, node_name: str) -> Wire:
    domain_id, namespace = domain_and_namespace(address)
    try:
        from chatrobot.wire.dds.wire import DdsWire
    except ImportError as error:
        raise UsageError(
            f"DDS is not installed here ({error.name or error})",
            allowed="pip install 'chatrobot[dds]'; its wheels are for x86-64 Linux and Python up to 3.13, elsewhere"
            " use --on rosbridge, or --on ros where ROS 2 is sourced",
        ) from error
    discovery = discovery_from(os.environ, domain_id)
    return DdsWire(wiring, node_name, namespace=namespace or wiring.namespace, discovery=discovery)


def _is_on_this_machine(_: str) -> bool:
    discovery = discovery_from(os.environ)
    return discovery.range in ("LOCALHOST", "OFF") and not discovery.peers and not discovery.uri


BACKEND = Backend(
    _connect, "dds[://DOMAIN[/NAMESPACE]]", _is_on_this_machine, alone="dds:", check=domain_and_namespace
)
