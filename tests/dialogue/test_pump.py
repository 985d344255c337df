"""The thread that pumps a session: whoever else computes in its process is held up by nothing for long."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator

import pytest

from chatrobot.compose import Setup, connect
from chatrobot.core.events import Event
from chatrobot.dialogue.pump import Pump

LOOKED_THROUGH = 20_000
"""Objects that the collector looks through in about 10 ms; with the words and all modules they are some 80,000."""


@pytest.fixture(autouse=True)
def thawed() -> Iterator[None]:
    gc.unfreeze()
    yield
    gc.unfreeze()


def test_the_collector_does_not_look_through_the_words_while_a_robot_moves() -> None:
    heard: list[Event] = []
    connection = connect(Setup(world="empty", fast=True), heard.append)
    pump = Pump(connection.session, lambda _: None)
    pump.start()
    turn = connection.session.say("forward 20 cm")
    while turn not in connection.session.results:
        time.sleep(0.01)
    pump.stop()
    connection.close()
    assert connection.session.results[turn].outcome == "completed"
    assert len(gc.get_objects()) < LOOKED_THROUGH
