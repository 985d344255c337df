"""The last stage: governed velocities onto the wire."""

from __future__ import annotations

from typing import Protocol

from chatrobot.core.governed import GovernedTwist, StopEpoch
from chatrobot.robots.profile import Wiring
from chatrobot.wire.messages import TwistMessage
from chatrobot.wire.wire import Wire

ZERO = TwistMessage(0.0, 0.0, 0.0)


class Transport(Protocol):
    """Knows two things: to send what the governor minted, and to halt."""

    def send(self, twist: GovernedTwist) -> bool:
        """Send, unless a stop came after it was minted. True if it went out and stands."""
        ...

    def halt(self) -> None:
        """Zero, now, from any thread, past everything else; what was minted before is void."""
        ...


class WireTransport:
    """Sends to a robot on any wire.

    `halt` takes no lock. A `send` that a stop overtakes looks at the epoch again after it has sent and takes its
    own velocity back, so whatever the order of the two threads, the last thing on the wire is a zero.
    """

    def __init__(self, wire: Wire, wiring: Wiring, epoch: StopEpoch) -> None:
        self._wire = wire
        self._topic = wiring.cmd_vel_topic
        self._epoch = epoch

    def send(self, twist: GovernedTwist) -> bool:
        if twist.epoch != self._epoch.value:
            return False
        self._wire.publish(self._topic, TwistMessage(*twist.twist))
        if twist.epoch != self._epoch.value:
            self._wire.publish(self._topic, ZERO)
            return False
        return True

    def halt(self) -> None:
        self._epoch.stop()
        self._wire.publish(self._topic, ZERO)
