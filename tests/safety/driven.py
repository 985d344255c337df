"""A robot of one profile, driven by one source over a wire: what the inherited safety suite stands on."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import Governor
from chatrobot.governor.rule import Sensed
from chatrobot.robots.open_loop import driven_open_loop
from chatrobot.robots.profile import RobotProfile
from chatrobot.transports.transport import WireTransport
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import LaserScan, TwistMessage
from chatrobot.wire.wire import Wire

FRESH = Sensed({"odom": 0.0, "scan": 0.0, "imu": 0.0})
EPSILON = 1e-6
"""Some wires carry single precision, or round."""

PATIENCE_S = 10.0


def memory_ends() -> Callable[[], Wire]:
    """Makes the ends of a wire within this process."""
    return MemoryHub().connect


class Driven:
    """Notes every velocity that arrives at the far end of the wire.

    Args:
        connect: makes a further end of one wire; by default one within this process.
    """

    def __init__(self, profile: RobotProfile, source: str, connect: Callable[[], Wire] | None = None) -> None:
        profile = profile if profile.has_odometry else driven_open_loop(profile)
        self.profile, self.source = profile, source
        self.epoch = StopEpoch()
        self.governor = Governor(profile, self.epoch)
        connect = connect or memory_ends()
        self.arrived: list[TwistMessage] = []
        self.sent = 0
        connect().subscribe(profile.wiring.cmd_vel_topic, TwistMessage, self.arrived.append)
        self.transport = WireTransport(connect(), profile.wiring, self.epoch)
        self.now_s = 50.0
        self.governor.leases.open("lease", source, 0.3, self.now_s)
        if profile.lidar is not None:
            free = LaserScan(self.now_s, -math.pi, math.radians(1.0), 0.1, 8.0, [math.inf] * 360)
            self.governor.take_scan(free, ORIGIN)

    def begin(self) -> Driven:
        assert self.governor.begin("lease", self.now_s, FRESH).refusal is None
        return self

    def ask(self, twist: Twist, after_s: float = TICK_S, beats: bool = True, sensed: Sensed = FRESH) -> str:
        """Ask once; what goes out is in `out`. Returns the rule that had the say."""
        self.now_s += after_s
        if beats:
            self.governor.leases.beat("lease", self.now_s)
        verdict = self.governor.govern(twist, "lease", self.now_s, ORIGIN, sensed)
        assert verdict.asked is twist
        self.sent += self.transport.send(verdict.sent)
        assert self.out[-1] == pytest.approx(TwistMessage(*verdict.sent.twist), abs=EPSILON), (
            "the verdict says what was sent"
        )
        return verdict.rule

    @property
    def out(self) -> list[TwistMessage]:
        """All that arrived, once everything has that was sent."""
        ends_s = time.monotonic() + PATIENCE_S
        while len(self.arrived) < self.sent:
            assert time.monotonic() < ends_s, "it did not arrive"
            time.sleep(0.0001)
        return self.arrived

    def halt(self) -> None:
        self.transport.halt()
        self.sent += 1

    def at_full_speed(self) -> Driven:
        most_mps = self.profile.limits.max_speed_mps
        for _ in range(200):
            self.ask(Twist(most_mps, 0.0, 0.0))
            if self.out[-1].vx_mps == pytest.approx(most_mps):
                return self
        raise AssertionError("it does not get there")

    @property
    def stands(self) -> bool:
        return not any(self.out[-1])
