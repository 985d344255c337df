"""The wire over rosbridge, for robots that offer nothing else: `pip install 'chatrobot[rosbridge]'`.

`protocol` has its messages, `rosapi` tells who is there, `wire` is the backend. Importing this package imports none of
them.
"""

from __future__ import annotations

from urllib.parse import urlsplit

from chatrobot.core.errors import UsageError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import Backend
from chatrobot.wire.wire import Wire


def _connect(address: str, wiring: Wiring, _: str) -> Wire:
    try:
        from chatrobot.wire.rosbridge.wire import RosbridgeWire
    except ImportError as error:
        raise UsageError(
            f"rosbridge is not installed here ({error.name or error})",
            allowed="pip install 'chatrobot[rosbridge]'",
        ) from error
    url, _, namespace = address.partition(":")[2].partition("#")
    return RosbridgeWire(url, wiring, namespace=namespace or wiring.namespace)


def _is_on_this_machine(address: str) -> bool:
    return urlsplit(address.partition(":")[2]).hostname in ("localhost", "127.0.0.1", "::1")


BACKEND = Backend(
    _connect,
    "rosbridge:ws://HOST:9090[#NAMESPACE]",
    _is_on_this_machine,
    alone="rosbridge:ws://localhost:9090",
)
