"""A rosbridge server small enough to read: a real websocket that speaks protocol 2 and routes between its clients.

As the real one does, it holds a topic to the type it was first given, and converts no message of another type; it
writes messages in CBOR for who asks so when subscribing (without a word where that is unknown to it: old servers), and
its JSON says null for every float that is not finite.
"""

from __future__ import annotations

import base64
import contextlib
import json
import math
import socket
import struct
import threading
from collections.abc import Callable
from typing import Any

import cbor2
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

FIXED_ARRAYS = ("nav_msgs/msg/Odometry", "sensor_msgs/msg/Imu")
"""With covariances: version 2.1.0 fails to write them as CBOR, logs that, and sends nothing."""
BYTES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
FLOAT32_ARRAY = 85
"""The tag of RFC 8746: little-endian."""


class FakeRosbridge:
    """Serves on a port of its own until it is closed; `cut` drops all connections, `start` listens again.

    Args:
        offers_cbor: as versions since 0.10 (ROS 1, 2018) and all for ROS 2 do; others send JSON whatever is asked.
    """

    def __init__(self, *, offers_cbor: bool = True) -> None:
        self._offers_cbor = offers_cbor
        self._lock = threading.Lock()
        self._changed = threading.Condition(self._lock)
        self._types: dict[str, str] = {}
        self._subscribers: dict[str, dict[ServerConnection, bool]] = {}
        """Of a topic: who listens, and whether in CBOR."""
        self._advertised: dict[tuple[ServerConnection, str], str] = {}
        self._clients: set[ServerConnection] = set()
        self.requests: list[dict[str, Any]] = []
        self.services: dict[tuple[str, str], dict[str, Any]] = {}
        """What services answer, by name and the topic they are asked about."""
        self._ears: list[tuple[str, Callable[[Any], None]]] = []
        self.paths: list[str] = []
        self.port = 0
        self.start()

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}"

    def start(self) -> None:
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(("127.0.0.1", self.port))
        listener.listen()
        self.port = listener.getsockname()[1]
        self._server = serve(self._serve, sock=listener, compression=None, max_size=None, close_timeout=0.1)
        self._thread = threading.Thread(target=self._server.serve_forever)
        self._thread.start()

    def stop(self) -> None:
        """As if the robot were switched off."""
        self._server.shutdown()
        self._thread.join()
        self.cut()

    def cut(self) -> None:
        """All connections break, without a word."""
        with self._lock:
            clients, self._clients = self._clients, set()
        for client in clients:
            with contextlib.suppress(OSError):
                client.socket.shutdown(socket.SHUT_RDWR)

    def say(self, topic: str, message: Any) -> None:
        """Publish as somebody else on the robot would; `message` is any JSON value."""
        with self._lock:
            self._route(topic, message)

    def listen(self, topic: str, callback: Callable[[Any], None]) -> None:
        """Hear what is published there, as somebody on the robot would."""
        self._ears.append((topic, callback))

    def say_raw(self, text: str | bytes) -> None:
        """Send this to every client: text, or bytes as CBOR travels."""
        with self._lock:
            for client in self._clients:
                client.send(text)

    def wait_for(self, operation: str, count: int, timeout_s: float) -> bool:
        """Until so many such requests have come."""
        with self._changed:
            return self._changed.wait_for(lambda: len(self.of(operation)) >= count, timeout_s)

    def of(self, operation: str) -> list[dict[str, Any]]:
        return [request for request in self.requests if request["op"] == operation]

    def _serve(self, client: ServerConnection) -> None:
        with self._lock:
            self._clients.add(client)
            self.paths.append(client.request.path if client.request else "")
        with contextlib.suppress(ConnectionClosed, OSError):
            for text in client:
                with self._changed:
                    self._do(client, json.loads(text))
                    self._changed.notify_all()
        with self._lock:
            self._clients.discard(client)
            for subscribers in self._subscribers.values():
                subscribers.pop(client, None)

    def _do(self, client: ServerConnection, request: dict[str, Any]) -> None:
        self.requests.append(request)
        if request["op"] == "call_service":
            self._answer(client, request)
            return
        topic = request["topic"]
        if request["op"] == "publish":
            if self._advertised.get((client, topic)) == self._types[topic]:
                self._route(topic, request["msg"])
            return
        known = self._types.setdefault(topic, request["type"])
        if request["op"] == "advertise":
            self._advertised[client, topic] = request["type"]
        elif request["op"] == "subscribe" and known == request["type"]:
            in_cbor = self._offers_cbor and request.get("compression", "none") == "cbor"
            subscribers = self._subscribers.setdefault(topic, {})
            subscribers[client] = subscribers.get(client, False) or in_cbor
        if known != request["type"]:
            problem = f"{topic} is {known}, not {request['type']}"
            client.send(json.dumps({"op": "status", "level": "error", "id": request["id"], "msg": problem}))

    def _answer(self, client: ServerConnection, request: dict[str, Any]) -> None:
        """As the real one does: a service that is not there is an error, and is answered at once."""
        values = self.services.get((request["service"], request["args"].get("topic", "")))
        answer = {"op": "service_response", "id": request["id"], "service": request["service"]}
        client.send(
            json.dumps({**answer, "values": values or "no such service", "result": values is not None})
        )

    def _route(self, topic: str, message: Any) -> None:
        for heard, callback in self._ears:
            if heard == topic:
                callback(message)
        for subscriber, in_cbor in tuple(self._subscribers.get(topic, {}).items()):
            packet = _in_cbor(topic, self._types[topic], message) if in_cbor else _in_json(topic, message)
            with contextlib.suppress(ConnectionClosed, OSError):
                if packet is not None:
                    subscriber.send(packet)


def _in_json(topic: str, message: Any) -> str:
    return json.dumps({"op": "publish", "topic": topic, "msg": _without_infinities(message)})


def _without_infinities(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _without_infinities(field) for name, field in value.items()}
    if isinstance(value, list):
        return [_without_infinities(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _in_cbor(topic: str, type_name: str, message: dict[str, Any]) -> bytes | None:
    if type_name in FIXED_ARRAYS:
        return None
    fields = dict(message)
    if type_name in BYTES:
        fields["data"] = base64.b64decode(fields["data"])
    elif type_name == "sensor_msgs/msg/LaserScan":
        ranges = [math.nan if value is None else value for value in fields["ranges"]]
        fields["ranges"] = cbor2.CBORTag(FLOAT32_ARRAY, struct.pack(f"<{len(ranges)}f", *ranges))
    return cbor2.dumps({"op": "publish", "topic": topic, "msg": fields})
