"""Motion's end of the line to a guard whose answers come late, as on a busy machine."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from chatrobot.core.clock import VirtualClock
from chatrobot.guard.watch import BEAT, ECHO_LOST_S, HANDSHAKE, TRIPPED
from chatrobot.motion.safety.watchdog import GuardLine


class SlowGuard:
    """Answers when the test says so."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        ours, self.line = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        self.link = GuardLine(ours, self.clock)

    def answer(self, words: bytes) -> None:
        self.line.send(words)


@pytest.fixture
def guard() -> Iterator[SlowGuard]:
    slow = SlowGuard()
    slow.link.handshake()
    slow.answer(HANDSHAKE)
    assert not slow.link.was_tripped()
    yield slow
    slow.link.goodbye()
    slow.line.close()


def test_a_trip_is_told_until_the_handshake(guard: SlowGuard) -> None:
    guard.answer(TRIPPED)
    assert guard.link.was_tripped()
    assert guard.link.was_tripped()
    guard.link.handshake()
    guard.answer(HANDSHAKE + BEAT)
    assert not guard.link.was_tripped()


def test_a_trip_from_before_the_handshake_that_is_told_after_it_ends_nothing(guard: SlowGuard) -> None:
    """Motion was late while the robot stood, noticed it itself and shook hands; then a motion began."""
    guard.link.handshake()
    guard.answer(TRIPPED)
    assert not guard.link.was_tripped()
    guard.answer(TRIPPED + HANDSHAKE + BEAT)
    assert not guard.link.was_tripped()


@pytest.mark.parametrize("answers", [(HANDSHAKE, TRIPPED), (TRIPPED, HANDSHAKE + BEAT, BEAT + TRIPPED)])
def test_a_trip_after_the_handshake_is_told(guard: SlowGuard, answers: tuple[bytes, ...]) -> None:
    guard.link.handshake()
    for words in answers:
        guard.answer(words)
    assert guard.link.was_tripped()


def test_a_guard_that_has_not_heard_the_handshake_yet_is_alive_while_it_answers(guard: SlowGuard) -> None:
    guard.link.handshake()
    guard.clock.advance(ECHO_LOST_S + 0.1)
    assert not guard.link.is_alive()
    guard.answer(TRIPPED)
    guard.link.was_tripped()
    assert guard.link.is_alive()
