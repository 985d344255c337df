"""What the governor limits while a stick drives: told soon, told again while it lasts, and told no more often."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Limited
from chatrobot.core.geometry import ZERO_TWIST, Twist

STEP_S = 0.06


class Hand:
    """Holds a stick in the furnished home, on simulated time."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.heard: list[tuple[float, Event]] = []
        self.connection: Connection = connect(Setup(world="home", fast=True), self._hear)

    def _hear(self, event: Event) -> None:
        self.heard.append((self.now_s, event))

    def hold(self, twist: Twist, duration_s: float) -> None:
        """Hold it like that: some 17 messages a second."""
        session = self.connection.session
        for _ in range(round(duration_s / STEP_S)):
            session.steer(twist)
            session.pump(STEP_S)
            self.now_s += STEP_S

    def limits(self) -> list[tuple[float, Limited]]:
        return [(at_s, event) for at_s, event in self.heard if isinstance(event, Limited)]


@pytest.fixture
def hand() -> Iterator[Hand]:
    made = Hand()
    yield made
    made.connection.close()


def test_the_reason_is_told_within_half_a_second_and_again_while_it_lasts(hand: Hand) -> None:
    hand.hold(Twist(0.4, 0.0, 0.0), 30.0)
    limits = hand.limits()
    first = limits[0][1]
    assert (first.turn, first.rule) == (0, "obstacle")
    assert first.reason is not None
    assert first.reason.code == "obstacle_ahead"
    assert 0.3 < first.sent.vx_mps < 0.4, "as soon as it goes slower, before it stands"
    assert hand.now_s - limits[-1][0] < 2.5, "the robot still stands there, and the stick is still held"
    gaps_s = [later - at_s for (at_s, _), (later, _) in itertools.pairwise(limits)]
    assert min(gaps_s) > 0.2
    assert len(limits) < 20


def test_nothing_is_told_where_nothing_is_limited(hand: Hand) -> None:
    hand.hold(Twist(0.2, 0.0, 0.3), 1.0)
    hand.hold(ZERO_TWIST, 1.0)
    assert hand.limits() == []
