"""Motion's end of the line to a guard whose answers come late, as on a busy machine."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.guard.watch import BEAT, ECHO_LOST_S, GOODBYE, HANDSHAKE, TRIPPED
from chatrobot.motion.safety.watchdog import GuardLine, SharedGuard


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
    assert guard.link.silent_s() > ECHO_LOST_S
    guard.answer(TRIPPED)
    guard.link.was_tripped()
    assert guard.link.silent_s() < ECHO_LOST_S


@pytest.fixture
def shared(guard: SlowGuard) -> SharedGuard:
    return SharedGuard(guard.link, guard.clock)


def test_many_motions_beat_as_one(guard: SlowGuard, shared: SharedGuard) -> None:
    shares = [shared.share() for _ in range(20)]
    guard.line.recv(100)
    for _ in range(10):
        for share in shares:
            share.beat()
            guard.clock.advance(TICK_S / len(shares))
    assert 10 <= len(guard.line.recv(1000)) <= 14


def test_a_trip_is_told_to_each_motion_until_it_has_shaken_hands_itself(
    guard: SlowGuard, shared: SharedGuard
) -> None:
    first, second = shared.share(), shared.share()
    guard.answer(TRIPPED)
    assert first.was_tripped()
    first.handshake()
    guard.answer(HANDSHAKE + BEAT)
    assert not first.was_tripped()
    assert second.was_tripped(), "it has not been told yet"
    second.handshake()
    guard.answer(HANDSHAKE)
    assert not second.was_tripped()


def test_the_guard_is_let_go_of_with_the_last_of_them(guard: SlowGuard, shared: SharedGuard) -> None:
    first, second = shared.share(), shared.share()
    guard.line.recv(100)
    first.goodbye()
    second.beat()
    assert guard.line.recv(100) == BEAT
    second.goodbye()
    assert guard.line.recv(100) == GOODBYE
