"""The wire within one process keeps the contract of wires."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from chatrobot.testing.wire_contract import WireContract
from chatrobot.wire.memory import MemoryHub, MemoryWire
from chatrobot.wire.messages import Number


class TestMemoryWire(WireContract):
    @pytest.fixture
    def connect(self) -> Callable[[], MemoryWire]:  # type: ignore[override]
        return MemoryHub().connect

    def test_publishing_calls_the_listeners_at_once(self, connect: Callable[[], MemoryWire]) -> None:
        heard: list[Number] = []
        connect().subscribe("topic", Number, heard.append)
        connect().publish("topic", Number(1.0))
        assert heard == [Number(1.0)]

    def test_a_listener_that_joins_while_it_is_called_hears_the_next_message_first(
        self, connect: Callable[[], MemoryWire]
    ) -> None:
        wire = connect()
        late: list[Number] = []
        wire.subscribe("topic", Number, lambda _: wire.subscribe("topic", Number, late.append))
        wire.publish("topic", Number(1.0))
        assert late == []
        wire.publish("topic", Number(2.0))
        assert late == [Number(2.0)]

    def test_a_closed_end_hears_nothing_more(self, connect: Callable[[], MemoryWire]) -> None:
        wire = connect()
        heard: list[Number] = []
        wire.subscribe("topic", Number, heard.append)
        wire.close()
        connect().publish("topic", Number(1.0))
        assert heard == []
