"""The wire over DDS keeps the contract of wires."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from about import About
from dds_rig import AcquaintedWire, Ends

from chatrobot.testing.wire_contract import CAMERA, WireContract
from chatrobot.wire.messages import Message


class TestDdsWire(WireContract):
    @pytest.fixture
    def connect(self) -> Iterator[Callable[[], AcquaintedWire]]:  # type: ignore[override]
        ends = Ends(CAMERA)
        yield ends.connect
        ends.close()

    def as_it_arrives(self, message: Message) -> About:
        return About(message)
