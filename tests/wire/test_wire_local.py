"""The wire between processes keeps the contract of wires, and survives whoever misbehaves on it."""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from chatrobot.core.errors import WireError
from chatrobot.testing.wire_contract import PATIENCE_S, Inbox, WireContract
from chatrobot.wire.local import LocalHub, LocalWire
from chatrobot.wire.messages import Number, Picture, Text, TwistMessage


@contextlib.contextmanager
def running(hub: LocalHub) -> Iterator[None]:
    """Somebody polls the hub, as the simulated robot does."""
    ended = threading.Event()

    def poll() -> None:
        while not ended.is_set():
            hub.poll(0.02)

    thread = threading.Thread(target=poll)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "wire"


class TestLocalWire(WireContract):
    @pytest.fixture
    def connect(self, path: Path) -> Iterator[Callable[[], LocalWire]]:  # type: ignore[override]
        hub = LocalHub(path)
        wires: list[LocalWire] = []

        def connect_one() -> LocalWire:
            wires.append(LocalWire(path))
            return wires[-1]

        with running(hub):
            yield connect_one
            for wire in wires:
                wire.close()
        hub.close()

    def test_packets_that_are_no_messages_are_ignored(
        self, connect: Callable[[], LocalWire], path: Path
    ) -> None:
        inbox = Inbox(connect(), "topic", TwistMessage)
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as stranger:
            stranger.connect(str(path))
            for garbage in (
                b"topic",
                b"\0\0\0",
                b"\xff\xfe",
                b"topic\0TwistMessage\0",
                b"topic\0TwistMessage\0{}",
                b'topic\0TwistMessage\0["a","b","c"]',
                b'topic\0TwistMessage\0"abc"',
                b"topic\0TwistMessage\0[1,2]",
                b"topic\0TwistMessage\0[1,2,null]",
                b"topic\0TwistMessage\0" + b"[" * 100_000,
                b"topic\0TwistMessage\0[1,2,1" + b"0" * 400 + b"]",
                b"topic\0Nonsense\0[1,2,3]",
                b"\0subscribe\0\xff",
            ):
                stranger.send(garbage)
            stranger.send(b"topic\0TwistMessage\0[1,0.5,2]")
            assert inbox.next() == TwistMessage(1.0, 0.5, 2.0)

    def test_a_picture_larger_than_a_packet_is_dropped_and_the_wire_goes_on(
        self, connect: Callable[[], LocalWire]
    ) -> None:
        inbox, pictures = Inbox(connect(), "topic", Number), Inbox(connect(), "camera", Picture)
        sender = connect()
        sender.publish("camera", Picture(1.0, "mono8", 1000, 1000, 1000, bytes(1_000_000)))
        sender.publish("camera", Picture(2.0, "mono8", 1, 1, 1, b"x"))
        sender.publish("topic", Number(1.0))
        assert inbox.next() == Number(1.0)
        assert pictures.next().stamp_s == 2.0

    def test_a_reader_that_is_frozen_does_not_block_the_others(
        self, connect: Callable[[], LocalWire], path: Path
    ) -> None:
        inbox = Inbox(connect(), "topic", Text)
        sender = connect()
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as frozen:
            frozen.connect(str(path))
            frozen.send(b"\0subscribe\0topic")
            for i in range(2_000):
                sender.publish("topic", Text(f"{i} " + "x" * 1000))
                inbox.next()

    def test_a_process_that_floods_the_wire_does_not_starve_the_others(
        self, connect: Callable[[], LocalWire], path: Path
    ) -> None:
        inbox = Inbox(connect(), "topic", Number)
        ended = threading.Event()

        def flood() -> None:
            with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as mad:
                mad.connect(str(path))
                while not ended.is_set():
                    mad.send(b"elsewhere\0Number\0[1.0]")

        thread = threading.Thread(target=flood)
        thread.start()
        try:
            sender = connect()
            for i in range(20):
                sender.publish("topic", Number(float(i)))
                assert inbox.next() == Number(float(i))
        finally:
            ended.set()
            thread.join()


def test_a_hub_that_is_frozen_does_not_block_the_publisher(path: Path) -> None:
    hub = LocalHub(path)
    wire = LocalWire(path)
    for _ in range(5_000):
        wire.publish("topic", Text("x" * 1000))
    wire.close()
    hub.close()


def test_one_turn_of_the_hub_ends_however_much_one_process_sends(path: Path) -> None:
    hub = LocalHub(path)
    wire = LocalWire(path)
    heard: list[Number] = []
    hub.subscribe("topic", Number, heard.append)
    hub.poll(PATIENCE_S)
    for i in range(100):
        wire.publish("topic", Number(float(i)))
    hub.poll(0.0)
    assert 0 < len(heard) < 100
    hub.poll(0.0)
    assert heard == [Number(float(i)) for i in range(100)]
    wire.close()
    hub.close()


def test_the_hub_hears_the_processes_and_they_hear_it(path: Path) -> None:
    hub = LocalHub(path)
    asked: list[Text] = []
    hub.subscribe("question", Text, asked.append)
    hub.subscribe("question", Text, lambda message: hub.publish("answer", Text(message.data.upper())))
    with running(hub):
        wire = LocalWire(path)
        answers = Inbox(wire, "answer", Text)
        wire.publish("question", Text("where"))
        assert answers.next() == Text("WHERE")
        wire.close()
    assert asked == [Text("where")]
    hub.close()


def test_the_hub_hears_itself(path: Path) -> None:
    hub = LocalHub(path)
    heard: list[Number] = []
    hub.subscribe("topic", Number, heard.append)
    hub.publish("topic", Number(1.0))
    assert heard == [Number(1.0)]
    hub.close()


def test_the_hub_knows_how_many_are_there(path: Path) -> None:
    hub = LocalHub(path)
    assert not hub.ever_connected
    wire = LocalWire(path)
    hub.poll(PATIENCE_S)
    assert (hub.ever_connected, hub.client_count) == (True, 1)
    wire.close()
    hub.poll(PATIENCE_S)
    assert (hub.ever_connected, hub.client_count) == (True, 0)
    hub.close()


def test_a_closed_hub_publishes_no_more(path: Path) -> None:
    hub = LocalHub(path)
    hub.close()
    with pytest.raises(WireError):
        hub.publish("topic", Number(1.0))
    with pytest.raises(WireError):
        hub.subscribe("topic", Number, lambda _: None)


def test_closing_a_hub_twice_leaves_its_successor_alone(path: Path) -> None:
    old = LocalHub(path)
    old.close()
    new = LocalHub(path)
    old.close()
    LocalWire(path).close()
    new.close()


def test_publishing_to_a_hub_that_is_gone_is_an_error(path: Path) -> None:
    hub = LocalHub(path)
    wire = LocalWire(path)
    hub.poll(PATIENCE_S)
    hub.close()
    with pytest.raises(WireError):
        wire.publish("topic", Number(1.0))
    wire.close()


def test_where_nobody_serves_the_wire_says_so(path: Path) -> None:
    with pytest.raises(WireError, match=str(path)):
        LocalWire(path)
