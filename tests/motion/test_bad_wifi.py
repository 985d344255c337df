"""Over a bad Wi-Fi, late, lossy and in bursts, what was asked for is done, only later."""

from __future__ import annotations

import heapq
import random
from collections.abc import Callable
from typing import Any

import pytest
from tests.motion import far_robot

from chatrobot.wire.messages import Message
from chatrobot.wire.ros_messages import stamped
from chatrobot.wire.stamps import StampTranslator
from chatrobot.wire.wire import M, Wire

RESEND_S = 0.2
"""After which TCP sends again what was lost (the least that Linux waits, tcp(7))."""


class BadWifi(Wire):
    """An end of the wire beyond a network that delays every message by chance and loses some.

    `in_order`: nothing is lost for good, but what was lost holds up all that comes after it, as TCP does.
    """

    def __init__(
        self,
        inner: Wire,
        network: far_robot.Network,
        delays_s: tuple[float, float],
        loss: float,
        in_order: bool,
        chance: random.Random,
    ) -> None:
        self._inner, self._clock = inner, network.clock
        self._delays_s, self._loss, self._in_order, self._chance = delays_s, loss, in_order, chance
        self._under_way: list[tuple[float, int, Callable[[], None]]] = []
        self._latest_s = {"up": 0.0, "down": 0.0}
        self._count = 0

    def publish(self, topic: str, message: Message) -> None:
        self._send("down", lambda: self._inner.publish(topic, message))

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        translator = StampTranslator()

        def deliver(message: Any) -> None:
            timed = stamped(message)
            if timed is not None:
                message = timed._replace(stamp_s=translator.local_s(1e6 + timed.stamp_s, self._clock.now_s()))
            callback(message)

        self._inner.subscribe(topic, kind, lambda message: self._send("up", lambda: deliver(message)))

    def close(self) -> None:
        self._inner.close()

    def arrive(self) -> None:
        while self._under_way and self._under_way[0][0] <= self._clock.now_s() + 1e-9:
            heapq.heappop(self._under_way)[2]()

    def _send(self, way: str, deliver: Callable[[], None]) -> None:
        at_s = self._clock.now_s() + self._chance.uniform(*self._delays_s)
        if self._chance.random() < self._loss:
            if not self._in_order:
                return
            at_s += RESEND_S
        if self._in_order:
            at_s = self._latest_s[way] = max(at_s, self._latest_s[way])
        self._count += 1
        heapq.heappush(self._under_way, (at_s, self._count, deliver))


@pytest.mark.parametrize("in_order", [True, False], ids=["tcp", "udp"])
@pytest.mark.parametrize("delays_s", [(0.0, 0.05), (0.15, 0.4)], ids=["0-50ms", "150-400ms"])
def test_a_plan_is_done_over_a_bad_wifi(
    monkeypatch: pytest.MonkeyPatch, delays_s: tuple[float, float], in_order: bool
) -> None:
    wires: list[BadWifi] = []

    def far_wire(inner: Wire, network: far_robot.Network) -> BadWifi:
        wires.append(BadWifi(inner, network, delays_s, 0.1, in_order, random.Random(7)))
        return wires[-1]

    monkeypatch.setattr(far_robot, "FarWire", far_wire)
    rig = far_robot.Rig()
    rig.each_step = wires[0].arrive
    rig.pass_time(1.0)
    end = rig.do("drive 1 m")
    assert (end.outcome, end.reason) == ("completed", None)
    rig.pass_time(1.0)
    assert rig.robot.true_pose.x_m == pytest.approx(1.0, abs=0.08), (
        "half a second late, it is seen when it stands"
    )
    assert rig.robot.true_twist.is_zero
