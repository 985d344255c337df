"""What a transport sends, and what a stop makes of it."""

from __future__ import annotations

import pytest

from chatrobot.core.errors import SafetyError
from chatrobot.core.geometry import Twist
from chatrobot.core.governed import GovernedTwist, Mint, StopEpoch
from chatrobot.motion.safety.stop import WireTransport
from chatrobot.robots.profile import Wiring
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import TwistMessage


def make() -> tuple[WireTransport, StopEpoch, list[TwistMessage], MemoryHub]:
    hub, epoch = MemoryHub(), StopEpoch()
    sent: list[TwistMessage] = []
    hub.connect().subscribe("cmd_vel", TwistMessage, sent.append)
    return WireTransport(hub.connect(), Wiring(), epoch), epoch, sent, hub


def test_a_velocity_cannot_be_made_without_the_governor() -> None:
    with pytest.raises(SafetyError):
        GovernedTwist(Twist(1.0, 0.0, 0.0), 0, object())  # type: ignore[arg-type]


def test_halt_sends_a_zero_at_once() -> None:
    transport, _, sent, _ = make()
    transport.halt()
    assert sent == [TwistMessage(0.0, 0.0, 0.0)]


def test_a_velocity_made_before_a_stop_is_worthless_after_it() -> None:
    transport, epoch, sent, _ = make()
    old = Mint().twist(Twist(0.3, 0.0, 0.0), epoch.value)
    transport.halt()
    assert not transport.send(old)
    assert sent == [TwistMessage(0.0, 0.0, 0.0)]


def test_a_send_that_a_stop_overtakes_takes_its_velocity_back() -> None:
    transport, epoch, sent, hub = make()

    def stop_meanwhile(message: TwistMessage) -> None:
        if message.vx_mps:
            transport.halt()  # another thread's stop, at the worst moment

    hub.connect().subscribe("cmd_vel", TwistMessage, stop_meanwhile)
    assert not transport.send(Mint().twist(Twist(0.3, 0.0, 0.0), epoch.value))
    assert sent[-1] == TwistMessage(0.0, 0.0, 0.0)
