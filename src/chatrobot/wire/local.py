"""The wire between processes of one machine: one hub (the simulated robot runs it), Unix packet sockets.

SOCK_SEQPACKET keeps message boundaries and makes each send atomic, so any thread may publish without a lock:
that is what lets a stop go out past everything else.
"""

from __future__ import annotations

import contextlib
import errno
import math
import select
import socket
import struct
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.codec import decode, encode, topic_of
from chatrobot.wire.connect import Backend
from chatrobot.wire.messages import Message
from chatrobot.wire.stamps import from_wall_s
from chatrobot.wire.wire import M, Wire

PACKET_BYTES = 262_144
_PACKETS_A_TURN = 64
"""How many packets the hub takes from one process before it looks at the others and at the time."""
_AT_ONCE = int(socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
_SO_TIMESTAMPNS = 35
"""socket(7), asm-generic/socket.h; Python has no name for it."""
_TIMESPEC = struct.Struct("@ll")
_STAMP_BYTES = socket.CMSG_SPACE(_TIMESPEC.size)
SUBSCRIBE = b"\0subscribe\0"
"""A process says this with a topic's name behind it, to hear that topic from then on."""


class _Subscriptions:
    """The callbacks of this process, by topic."""

    def __init__(self) -> None:
        self._callbacks: dict[str, list[tuple[type, Callable[[Any], None]]]] = {}

    def add(self, topic: str, kind: type, callback: Callable[[Any], None]) -> None:
        self._callbacks.setdefault(topic, []).append((kind, callback))

    def deliver(self, topic: str, message: Message) -> None:
        for kind, callback in tuple(self._callbacks.get(topic, ())):
            if type(message) is kind:
                callback(message)

    def wants(self, topic: str) -> bool:
        return topic in self._callbacks


class LocalWire(Wire):
    """A process's end of the local wire. Connects at once; a thread of its own delivers.

    Args:
        has_thread: False where whoever owns it waits for `fileno` and calls `deliver`.

    Raises:
        WireError: nobody serves that socket.
    """

    def __init__(self, path: Path | str, *, has_thread: bool = True) -> None:
        self._subscriptions = _Subscriptions()
        self._closed = False
        self._has_thread = has_thread
        self.is_over = False
        """Nothing more comes: either end has been closed."""
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            self._socket.connect(str(path))
        except OSError as error:
            self._socket.close()
            from shlex import quote  # only then

            starts = f"chatrobot sim --on {quote(f'local:{path}')} starts a simulated one"
            raise WireError(f"no robot answers at {path}; {starts}") from error
        self._reader: threading.Thread | None = None

    def publish(self, topic: str, message: Message) -> None:
        packet = encode(topic, message)
        try:
            self._socket.send(packet, _AT_ONCE)
        except BlockingIOError:
            return  # the hub does not read: it is frozen, and a queue of old velocities would help nobody
        except OSError as error:
            if error.errno == errno.EMSGSIZE:
                return  # a picture larger than a packet: this wire takes small ones
            raise WireError("the other end of the wire is gone") from error

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        self._subscriptions.add(topic, kind, callback)
        try:
            self._socket.send(SUBSCRIBE + topic.encode(), socket.MSG_NOSIGNAL)
        except OSError as error:
            raise WireError("the other end of the wire is gone") from error
        if self._reader is None and self._has_thread:
            self._reader = threading.Thread(target=self._read, name="wire", daemon=True)
            self._reader.start()

    def close(self) -> None:
        if self._closed:
            return
        self._closed = self.is_over = True
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        if self._reader is not None and self._reader is not threading.current_thread():
            self._reader.join()
        self._socket.close()

    def fileno(self) -> int:
        """Return what is readable while there is something to deliver."""
        return self._socket.fileno()

    def deliver(self) -> None:
        """Deliver what has come, without waiting for anything."""
        for _ in range(_PACKETS_A_TURN):
            if not self._deliver_one(socket.MSG_DONTWAIT):
                return

    def _read(self) -> None:
        while self._deliver_one(0):
            pass

    def _deliver_one(self, flags: int) -> bool:
        try:
            packet = self._socket.recv(PACKET_BYTES, flags)
        except BlockingIOError:
            return False
        except OSError:
            packet = b""
        self.is_over = not packet
        message = decode(packet)
        if message is not None:
            self._subscriptions.deliver(topic_of(packet), message)
        return bool(packet)


def _stamped_s(ancillary: Sequence[tuple[int, int, bytes]]) -> float:
    """Return when the kernel took a packet, in seconds of our clock; never where it does not tell."""
    for _, kind, stamp in ancillary:
        if kind == _SO_TIMESTAMPNS and len(stamp) == _TIMESPEC.size:
            seconds, more_ns = _TIMESPEC.unpack(stamp)
            return from_wall_s(seconds + more_ns * 1e-9)
    return math.inf


class LocalHub(Wire):
    """Routes packets between the processes; is itself an end of the wire for the process that runs it.

    Single-threaded: whoever owns it calls `poll`. Callbacks come from within `poll` or `publish`.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self._subscriptions = _Subscriptions()
        self._clients: dict[int, tuple[socket.socket, set[str]]] = {}
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET | socket.SOCK_NONBLOCK)
        with contextlib.suppress(FileNotFoundError):
            self.path.unlink()
        self._listener.bind(str(self.path))
        self._listener.listen(16)
        self._poller = select.epoll()
        self._poller.register(self._listener, select.EPOLLIN)
        self.ever_connected = False
        self._closed = False
        self._came_s = math.inf

    @property
    def age_s(self) -> float:
        """Return how long ago the message that is being delivered came; 0 where the kernel does not tell."""
        return max(0.0, time.monotonic() - self._came_s)

    @property
    def client_count(self) -> int:
        """Return how many processes are connected."""
        return len(self._clients)

    def publish(self, topic: str, message: Message) -> None:
        if self._closed:
            raise WireError("this end of the wire is closed")
        self._came_s = math.inf
        self._subscriptions.deliver(topic, message)
        packet: bytes | None = None
        for client, topics in tuple(self._clients.values()):
            if topic in topics:
                packet = packet or encode(topic, message)
                self._send(client, packet)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        if self._closed:
            raise WireError("this end of the wire is closed")
        self._subscriptions.add(topic, kind, callback)

    def poll(self, timeout_s: float) -> None:
        """Wait up to `timeout_s` for packets and route all that are there."""
        for descriptor, _ in self._poller.poll(max(0.0, timeout_s)):
            if descriptor == self._listener.fileno():
                self._accept()
            elif descriptor in self._clients:
                self._receive(descriptor)

    def close(self) -> None:
        if self._closed:
            return  # by now another hub may serve that path
        self._closed = True
        for descriptor in tuple(self._clients):
            self._drop(descriptor)
        self._poller.close()
        self._listener.close()
        with contextlib.suppress(FileNotFoundError):
            self.path.unlink()

    def fileno(self) -> int:
        """Return what is readable while there is something to route: `LocalHubs` waits for it."""
        return self._poller.fileno()

    def _accept(self) -> None:
        client, _ = self._listener.accept()
        client.setblocking(False)
        with contextlib.suppress(OSError):
            client.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMPNS, 1)
        self._clients[client.fileno()] = (client, set())
        self._poller.register(client, select.EPOLLIN)
        self.ever_connected = True

    def _receive(self, descriptor: int) -> None:
        client, topics = self._clients[descriptor]
        for _ in range(_PACKETS_A_TURN):
            try:
                packet, ancillary, _, _ = client.recvmsg(PACKET_BYTES, _STAMP_BYTES)
            except BlockingIOError:
                return
            except OSError:
                packet, ancillary = b"", []
            if not packet:
                self._drop(descriptor)
                return
            if packet.startswith(SUBSCRIBE):
                topics.add(packet[len(SUBSCRIBE) :].decode(errors="replace"))
            else:
                self._came_s = _stamped_s(ancillary)
                self._route(packet)

    def _route(self, packet: bytes) -> None:
        topic = topic_of(packet)
        for client, topics in tuple(self._clients.values()):
            if topic in topics:
                self._send(client, packet)
        if self._subscriptions.wants(topic):
            message = decode(packet)
            if message is not None:
                self._subscriptions.deliver(topic, message)

    def _send(self, client: socket.socket, packet: bytes) -> None:
        with contextlib.suppress(OSError):  # full: it does not read; gone: its own event will say so
            client.send(packet, _AT_ONCE)

    def _drop(self, descriptor: int) -> None:
        client, _ = self._clients.pop(descriptor)
        self._poller.unregister(descriptor)
        client.close()


class LocalHubs:
    """Many hubs of one process, waited for at once."""

    def __init__(self, hubs: Sequence[LocalHub]) -> None:
        self._hubs = {hub.fileno(): hub for hub in hubs}
        self._poller = select.epoll()
        for hub in hubs:
            self._poller.register(hub, select.EPOLLIN)

    def poll(self, timeout_s: float) -> None:
        """Wait up to `timeout_s` for packets and route all that are there. A closed hub has none."""
        for descriptor, _ in self._poller.poll(max(0.0, timeout_s)):
            self._hubs[descriptor].poll(0.0)


def _connect(address: str, _: Wiring, __: str) -> Wire:
    _check(address)
    return LocalWire(address.removeprefix("local:"))


def _check(address: str) -> None:
    if address == "local:":
        raise UsageError("a local wire needs the path of its socket", allowed="local:PATH")


BACKEND = Backend(_connect, "local:PATH", check=_check)
