"""The wire over rosbridge: its JSON protocol (version 2) on a websocket, for robots that offer nothing else.

Protocol: https://github.com/RobotWebTools/rosbridge_suite, ROSBRIDGE_PROTOCOL.md. A thread of the backend reads,
and reconnects when the robot is gone; meanwhile publishing fails at once, and nothing is kept for later. Scans and
pictures are asked for in CBOR; a server that has none ignores that and sends JSON.
"""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import json
import queue
import socket
import struct
import threading
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from chatrobot.core.errors import WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.codec import as_base64
from chatrobot.wire.messages import LaserScan, Message
from chatrobot.wire.ros_messages import Listener, RosForm, ros_form, with_wall_stamp
from chatrobot.wire.rosbridge.protocol import advertise_request, read, request_id, subscribe_request
from chatrobot.wire.rosbridge.rosapi import RosApi
from chatrobot.wire.stamps import StampTranslator
from chatrobot.wire.wire import Endpoint, M, Wire

OPEN_TIMEOUT_S = 3.0
UNACKNOWLEDGED_S = 1.0
"""A connection whose data is not acknowledged for this long is given up: when Wi-Fi comes back, the velocities of
ten seconds must not pour out of the kernel's queue."""
PING_S = 1.0
FIRST_RETRY_S, LAST_RETRY_S = 0.02, 1.0
"""A robot whose base holds its last command waits for our zero all the while."""
ANSWER_S = 0.5
"""A service of the robot's answers within this time, or is taken not to be there."""
QUEUE_BYTES = 65_536
"""With more than this on its way the other end does not read: what comes now is dropped."""
MESSAGE_BYTES = 8_388_608
_SIOCOUTQ = 0x5411


class _Subscription(Listener):
    """One topic as one kind of message."""

    def __init__(self, form: RosForm) -> None:
        super().__init__(form)
        self._clock = StampTranslator()

    def deliver(self, fields: Any) -> None:
        self.hear(fields, lambda stamp_s: self._clock.local_s(stamp_s, time.monotonic()))


class RosbridgeWire(Wire):
    """A process's end of a robot's rosbridge. Connects at once; a thread of its own delivers and reconnects.

    Args:
        url: `ws://host:9090` or `wss://…`; `user:password@` and a query (`?token=…`) are passed on to the server.
        wiring: the robot's topics and types.
        namespace: of the robot, put before relative topics; empty for none.

    Raises:
        WireError: no rosbridge answers there.
    """

    comes_back = True
    knows_others = True

    def __init__(self, url: str, wiring: Wiring, *, namespace: str = "") -> None:
        self._url, self._wiring, self.namespace = url, wiring, namespace.strip("/")
        parts = urlsplit(url)
        self._place = (
            f"{parts.scheme}://{parts.hostname}:{parts.port or (443 if parts.scheme == 'wss' else 80)}"
        )
        self._lock = threading.Lock()
        self._subscriptions: dict[tuple[str, type], _Subscription] = {}
        self._advertised: dict[tuple[str, type], RosForm] = {}
        self._refused: dict[str, str] = {}
        self._has_null_ranges = False
        self._rosapi = RosApi(self._call)
        self._answers: dict[str, queue.Queue[dict[str, Any]]] = {}
        self._calls = itertools.count(1)
        self._ended = threading.Event()
        self._connection: ClientConnection | None = None
        try:
            connection = self._connect()
        except (OSError, WebSocketException) as error:
            raise WireError(
                f"no rosbridge answers at {self._place}; start rosbridge_server on the robot, or check"
                f" host and port ({error})"
            ) from error
        self._thread = threading.Thread(target=self._run, args=(connection,), name="rosbridge", daemon=True)
        self._thread.start()

    def publish(self, topic: str, message: Message) -> None:
        form = self._advertised.get((topic, type(message))) or self._advertise(topic, type(message))
        refusal = self._refused.get(request_id("advertise", topic, form))
        if refusal is not None:
            raise WireError(f"rosbridge refuses {topic}: {refusal}")
        fields = form.to_ros(with_wall_stamp(message))
        self._send({"op": "publish", "topic": self.resolve(topic), "msg": fields})

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        with self._lock:
            if self._ended.is_set():
                raise WireError("this end of the wire is closed")
            subscription = self._subscriptions.get((topic, kind))
            if subscription is None:
                subscription = _Subscription(ros_form(topic, kind, self._wiring))
                self._subscriptions = {**self._subscriptions, (topic, kind): subscription}
            subscription.callbacks = (*subscription.callbacks, callback)
            if len(subscription.callbacks) == 1:
                with contextlib.suppress(WireError):  # where it is gone just now, it is told on its return
                    self._send(subscribe_request(self.resolve(topic), topic, subscription.form))

    def close(self) -> None:
        self._ended.set()
        with self._lock:
            connection, self._connection = self._connection, None
        if connection is not None:
            with contextlib.suppress(WebSocketException, OSError):
                connection.close()
        if self._thread is not threading.current_thread():
            self._thread.join()

    @property
    def is_connected(self) -> bool:
        return self._connection is not None

    @property
    def has_null_ranges(self) -> bool:
        return self._has_null_ranges

    def rewire(self, wiring: Wiring) -> None:
        self._wiring = wiring

    def survey(self) -> list[Endpoint]:
        return self._rosapi.survey()

    def publishers_of(self, topic: str) -> list[str]:
        return self._rosapi.publishers_of(self.resolve(topic))

    def resolve(self, topic: str) -> str:
        if topic.startswith("/"):
            return topic
        return f"/{self.namespace}/{topic}" if self.namespace else f"/{topic}"

    def _call(self, service: str, arguments: dict[str, Any]) -> dict[str, Any] | None:
        """Return what a service of the robot answers; None where there is none, or no answer."""
        number = f"call:{next(self._calls)}"
        answer = self._answers[number] = queue.Queue()
        try:
            self._send({"op": "call_service", "id": number, "service": service, "args": arguments})
            return answer.get(timeout=ANSWER_S)
        except (WireError, queue.Empty):
            return None
        finally:
            del self._answers[number]

    def _advertise(self, topic: str, kind: type[Message]) -> RosForm:
        with self._lock:
            form = ros_form(topic, kind, self._wiring)
            self._send(advertise_request(self.resolve(topic), topic, form))
            self._advertised = {**self._advertised, (topic, kind): form}
            return form

    def _send(self, request: dict[str, Any]) -> None:
        connection = self._connection
        if connection is None:
            raise WireError(f"rosbridge at {self._place} is gone")
        if _queued_bytes(connection.socket) > QUEUE_BYTES:
            return
        try:
            connection.send(json.dumps(request, separators=(",", ":"), default=as_base64))
        except (WebSocketException, OSError) as error:
            raise WireError(f"rosbridge at {self._place} is gone") from error

    def _connect(self) -> ClientConnection:
        """A connection that has been told all this end publishes and listens to."""
        opening = connect(
            self._url,
            open_timeout=OPEN_TIMEOUT_S,
            close_timeout=UNACKNOWLEDGED_S,
            ping_interval=PING_S,
            ping_timeout=2 * PING_S,
            compression=None,
            proxy=None,
            max_size=MESSAGE_BYTES,
        )
        connection = opening.__enter__()  # it outlives this function: `close` is what leaving would do
        raw = connection.socket
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(UNACKNOWLEDGED_S * 1000))
        with self._lock:
            self._refused = {}
            self._connection = connection
            with contextlib.suppress(WireError):  # gone already: the reader will see it, too
                for (topic, _), form in self._advertised.items():
                    self._send(advertise_request(self.resolve(topic), topic, form))
                for (topic, _), subscription in self._subscriptions.items():
                    self._send(subscribe_request(self.resolve(topic), topic, subscription.form))
        return connection

    def _run(self, connection: ClientConnection | None) -> None:
        retry_s = FIRST_RETRY_S
        while not self._ended.is_set():
            if connection is not None:
                retry_s = FIRST_RETRY_S
                self._read(connection)
                connection = None
                continue
            if self._ended.wait(retry_s):
                return
            retry_s = min(LAST_RETRY_S, retry_s * 2.0)
            with contextlib.suppress(OSError, WebSocketException):
                connection = self._connect()

    def _read(self, connection: ClientConnection) -> None:
        """Until it is gone."""
        try:
            for text in connection:
                if self._ended.is_set():
                    break
                self._hear(text)
        except (WebSocketException, OSError):
            pass
        finally:
            with self._lock:
                if self._connection is connection:
                    self._connection = None

    def _hear(self, text: str | bytes) -> None:
        try:
            heard = read(text)
            operation = heard.op
            if operation == "publish":
                for (topic, kind), subscription in tuple(self._subscriptions.items()):
                    if self.resolve(topic) == heard.topic and not self._ended.is_set():
                        subscription.deliver(heard.msg)
                        if kind is LaserScan and not self._has_null_ranges:  # infinity and NaN alike, in JSON
                            self._has_null_ranges = None in heard.msg.ranges
            elif operation == "service_response" and heard.id in self._answers:
                self._answers[heard.id].put(vars(heard.values) if heard.result else {})
            elif operation == "status" and heard.level == "error":
                self._refused[str(heard.id)] = str(heard.msg)
        except (ValueError, TypeError, AttributeError, RecursionError):
            return


def _queued_bytes(raw: socket.socket) -> int:
    """Return how much the other end has not acknowledged yet (tcp(7))."""
    try:
        return int(struct.unpack("i", fcntl.ioctl(raw.fileno(), _SIOCOUTQ, b"\0\0\0\0"))[0])
    except (OSError, ValueError):  # ValueError: a socket that another thread has just closed has no number
        return 0  # closed: sending will say so
