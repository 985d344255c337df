"""A simulated robot, executor and governor on simulated time, for one plan after the other; and a recording wire."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.core.events import Event
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.execution.executor import Executor
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor
from chatrobot.governor.rule import Sensed
from chatrobot.motion.safety.stop import WireTransport
from chatrobot.plan.context import LoweringContext
from chatrobot.plan.lowering import CoreWalk
from chatrobot.plan.steps import Plan
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import Point, RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Message
from chatrobot.wire.wire import M, Wire


class RecordingWire(Wire):
    """Pass everything on to `wire`, and keep what is published through here: (topic, message), in order."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self.published: list[tuple[str, Message]] = []

    def publish(self, topic: str, message: Message) -> None:
        """Keep it and send it."""
        self.published.append((topic, message))
        self._wire.publish(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        """Listen to the wire itself."""
        self._wire.subscribe(topic, kind, callback)

    def close(self) -> None:
        """Leave the wire."""
        self._wire.close()


class Rig:
    """Run plans as Motion does, without its process, approval and rehearsal; look at `robot`, `sensors` and `sent`.

    `connect` makes a further end of a wire that calls back at once, as the one within this process does.
    """

    def __init__(
        self,
        profile: str | RobotProfile = "wheeltec_mini_mec",
        faults: str = "",
        world: str = "empty",
        area: Sequence[Point] | None = None,
        connect: Callable[[], Wire] | None = None,
    ) -> None:
        self.profile = load_profile(profile) if isinstance(profile, str) else profile
        self.clock = VirtualClock()
        connect = connect or MemoryHub().connect
        injected = FaultInjection.parse(faults)
        self.robot = SimRobot(self.profile, load_world(world), injected, wire=connect(), clock=self.clock)
        self.sensors = Sensors(self.profile, self.clock)
        wire = self.wired(connect())
        self.sensors.attach(wire)
        epoch = StopEpoch()
        self.governor = Governor(self.profile, epoch, area)
        self.governor.leases.open("rig", "rig", float("inf"), 0.0)
        self._transport = WireTransport(wire, self.profile.wiring, epoch)
        self._looked_at: object = None
        self.events: list[Event] = []
        self.sent: list[Twist] = []
        self.live(0.5)

    def wired(self, wire: Wire) -> Wire:
        """Return the wire as the driver has it: a subclass may meddle."""
        return wire

    def _sensed(self) -> Sensed:
        return Sensed(self.sensors.ages_s(), self.sensors.battery_percent)

    def live(self, duration_s: float) -> None:
        """Let time pass."""
        for _ in range(round(duration_s / TICK_S)):
            self.clock.advance(TICK_S)
            self.robot.step(TICK_S)

    def halt(self) -> None:
        """Stop, and let it come to rest."""
        self._transport.halt()
        self.live(1.0)

    def run(
        self,
        plan: Plan,
        each_tick: Callable[[float], None] = lambda _: None,
        limit_s: float = 600.0,
        halt_after_s: float = math.inf,
    ) -> Executor:
        """Run `plan` to its end, or halt after so long; `each_tick(seconds since its start)` may meddle.

        Raises:
            AssertionError: it has not ended after `limit_s`.
        """
        estimate = self.sensors.estimate
        start = estimate.pose if estimate is not None else ORIGIN
        context = LoweringContext(self.profile, start, start)
        self.executor = executor = Executor(self.profile, self.sensors, self.events.append)
        began_s = self.clock.now_s()
        assert self.governor.begin("rig", self.clock.now_s(), self._sensed()).refusal is None
        executor.start(1, CoreWalk(plan, context), 10.0, began_s)
        while self.clock.now_s() - began_s < limit_s:
            if self.clock.now_s() - began_s >= halt_after_s:
                self.halt()
                return executor
            each_tick(self.clock.now_s() - began_s)
            asked = executor.tick(self.clock.now_s())
            if executor.is_done:
                return executor
            self._look()
            pose = self.sensors.pose_now()
            verdict = self.governor.govern(asked, "rig", self.clock.now_s(), pose, self._sensed())
            self._transport.send(verdict.sent)
            self.sensors.note_sent(verdict.sent.twist)
            executor.note(verdict.rule, verdict.reason, verdict.sent.twist, self.clock.now_s())
            self.sent.append(verdict.sent.twist)
            self.live(TICK_S)
        raise AssertionError(f"the plan did not end within {limit_s} s")

    def _look(self) -> None:
        scan = self.sensors.scan
        pose = self.sensors.estimator.pose_at(scan.stamp_s) if scan is not None else None
        if scan is not None and pose is not None and scan is not self._looked_at:
            self._looked_at = scan
            self.governor.take_scan(scan, pose)
