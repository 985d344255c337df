"""The guard's process, on a line and a wire of this test's own."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator

import pytest

from chatrobot.core.errors import WireError
from chatrobot.guard.__main__ import Guard, HaltedRobot
from chatrobot.guard.watch import BEAT, GOODBYE, HANDSHAKE, TRIPPED
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import M, Wire

PATIENCE_S = 5.0


class Connection(Wire):
    """A wire whose other end may be gone for a while."""

    comes_back = True
    is_connected = True

    def __init__(self) -> None:
        self.halted = threading.Event()

    def publish(self, topic: str, message: Message) -> None:  # noqa: ARG002 - the protocol's
        if not self.is_connected:
            raise WireError("gone")
        self.halted.set()

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None: ...

    def close(self) -> None: ...


class Watched:
    """A guard at work in a thread, and Motion's end of its line."""

    def __init__(self) -> None:
        self.wire = Connection()
        self.line, its_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        self.line.settimeout(PATIENCE_S)
        guard = Guard(its_end, [HaltedRobot(self.wire, "cmd_vel", "odom")])
        self.thread = threading.Thread(target=guard.run)
        self.thread.start()

    def answer_to(self, word: bytes, patience_s: float = PATIENCE_S) -> bytes:
        self.line.settimeout(patience_s)
        self.line.send(word)
        try:
            return self.line.recv(1)
        except TimeoutError:
            return b""


@pytest.fixture
def guard() -> Iterator[Watched]:
    watched = Watched()
    yield watched
    watched.line.send(GOODBYE)
    watched.thread.join(PATIENCE_S)
    assert not watched.thread.is_alive()


def test_it_echoes_what_it_hears(guard: Watched) -> None:
    assert guard.answer_to(HANDSHAKE) == HANDSHAKE
    assert guard.answer_to(BEAT) == BEAT


def test_a_handshake_that_comes_with_beats_is_what_it_echoes(guard: Watched) -> None:
    assert guard.answer_to(BEAT + HANDSHAKE + BEAT) == HANDSHAKE


def test_who_cannot_halt_the_robot_does_not_say_it_could(guard: Watched) -> None:
    assert guard.answer_to(HANDSHAKE) == HANDSHAKE
    guard.wire.is_connected = False
    assert guard.answer_to(BEAT, 0.1) == b"", "Motion takes a guard that does not echo for dead"
    guard.wire.is_connected = True
    assert guard.answer_to(HANDSHAKE) == HANDSHAKE


def test_a_motion_that_is_gone_between_handshake_and_first_beat_is_noticed(guard: Watched) -> None:
    guard.answer_to(HANDSHAKE)
    assert guard.wire.halted.wait(PATIENCE_S), "nobody beats"
    assert guard.answer_to(BEAT) == TRIPPED


def test_it_goes_on_trying_to_halt_over_a_wire_that_comes_back(guard: Watched) -> None:
    guard.answer_to(HANDSHAKE)
    guard.wire.is_connected = False
    assert not guard.wire.halted.wait(0.25)
    guard.wire.is_connected = True
    assert guard.wire.halted.wait(PATIENCE_S)
