"""DDS for tests: a domain of this run's own, this machine only, and ends that know one another before they speak."""

from __future__ import annotations

import os
import random

import pytest

from chatrobot.robots.profile import Wiring
from chatrobot.wire.messages import Message

pytest.importorskip(
    "cyclonedds", reason="cyclonedds has no wheel for this machine or Python: DDS stays untested here"
)

from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.discovery import Discovery

PATIENCE_S = 10.0
DOMAIN_ID = random.Random(os.getpid()).randrange(100, 232)
HERE = Discovery(domain_id=DOMAIN_ID)


class Ends:
    """The ends of one test. `connect` makes a further one."""

    def __init__(self, wiring: Wiring = Wiring(), namespace: str = "") -> None:  # noqa: B008
        self._wiring, self._namespace = wiring, namespace
        self.wires: list[AcquaintedWire] = []

    def connect(self) -> AcquaintedWire:
        wire = AcquaintedWire(self, self._wiring, f"node_{len(self.wires)}", self._namespace)
        self.wires.append(wire)
        return wire

    def listeners(self, topic: str, kind: type[Message]) -> int:
        return sum((topic, kind) in wire._readers for wire in self.wires)

    def close(self) -> None:
        for wire in self.wires:
            wire.close()


class AcquaintedWire(DdsWire):
    """Waits, before it publishes, for all listeners of the test: the contract is about what comes after discovery."""

    def __init__(self, ends: Ends, wiring: Wiring, name: str, namespace: str) -> None:
        super().__init__(wiring, name, namespace=namespace, discovery=HERE)
        self._ends = ends

    def publish(self, topic: str, message: Message) -> None:
        count = self._ends.listeners(topic, type(message))
        assert self.wait_for_listener(topic, type(message), PATIENCE_S, count)
        super().publish(topic, message)
