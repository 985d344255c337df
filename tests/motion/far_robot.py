"""A robot on the other side of a bad network, in simulated time; the robot is honest, the network is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event, Finished, Notice
from chatrobot.link.in_process import InProcessLink
from chatrobot.motion.motion import Motion
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Message, TwistMessage
from chatrobot.wire.ros_messages import stamped
from chatrobot.wire.stamps import StampTranslator
from chatrobot.wire.wire import M, Wire


@dataclass
class Network:
    """What lies between a far Motion and its robot.

    `is_down` loses everything both ways; `holds_back` keeps what the robot says until it ends; `ahead_s` is how much
    the robot's clock is ahead of ours.
    """

    clock: VirtualClock
    is_down: bool = False
    holds_back: bool = False
    ahead_s: float = 0.0
    held: list[Callable[[], None]] = field(default_factory=list)

    def let_go(self) -> None:
        """All that was held back pours in at once."""
        self.holds_back = False
        held, self.held = self.held, []
        for deliver in held:
            deliver()


class FarWire(Wire):
    """An end of the wire on the other side of that network; translates stamps as every network's backend does."""

    def __init__(self, inner: Wire, network: Network) -> None:
        self._inner, self._network = inner, network

    def publish(self, topic: str, message: Message) -> None:
        if not self._network.is_down:
            self._inner.publish(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        translator, network = StampTranslator(), self._network

        def deliver(message: Any) -> None:
            timed = stamped(message)
            if timed is not None:
                sent_s = timed.stamp_s
                message = timed._replace(stamp_s=translator.local_s(sent_s, network.clock.now_s()))
            callback(message)

        def hear(message: Any) -> None:
            timed = stamped(message)
            if timed is not None:
                message = timed._replace(stamp_s=1e6 + timed.stamp_s + network.ahead_s)
            if network.holds_back:
                network.held.append(lambda: deliver(message))
            elif not network.is_down:
                deliver(message)

        self._inner.subscribe(topic, kind, hear)

    def close(self) -> None:
        self._inner.close()


class Rig:
    """Motion on one side, the robot on the other; the robot holds its last command for ever."""

    def __init__(self, change: Callable[[RobotProfile], RobotProfile] = lambda profile: profile) -> None:
        profile = change(load_profile("wheeltec_mini_mec"))
        self.clock, self.hub = VirtualClock(), MemoryHub()
        self.network = Network(self.clock)
        self.robot = SimRobot(
            load_profile("wheeltec_mini_mec"),
            load_world("empty"),
            wire=self.hub.connect(),
            clock=self.clock,
        )
        self.velocities: list[TwistMessage] = []
        self.hub.connect().subscribe("cmd_vel", TwistMessage, self.velocities.append)
        self.events: list[Event] = []
        self.each_step: Callable[[], None] = lambda: None
        wire, guard = FarWire(self.hub.connect(), self.network), SimulatedGuard(self.clock)

        def build(emit: Callable[[Event], None]) -> Motion:
            planner = Planner(profile, load_world("empty"))
            programs = ProgramHost(profile, is_in_step=True)
            self.motion = Motion(
                profile, wire, self.clock, planner, guard, emit, lambda goal: goal(), programs
            )
            return self.motion

        self.link = InProcessLink(
            build, wire, self.clock, self._advance, guard, self.hub.connect(), "cmd_vel"
        )
        self.turn = 0
        self.pass_time(0.4)

    def _advance(self, duration_s: float) -> None:
        self.each_step()
        self.robot.step(duration_s)

    def pass_time(self, duration_s: float) -> None:
        ends_s = self.clock.now_s() + duration_s
        while self.clock.now_s() < ends_s - 1e-9:
            event = self.link.next_event(0.02)
            if event is not None:
                self.events.append(event)

    def begin(self, plan_text: str) -> None:
        self.turn += 1
        self.link.send("plan", self.turn, plan_text=plan_text, mode="queue")

    def end_of(self, turn: int) -> Finished | None:
        ends = (event for event in self.events if isinstance(event, Finished) and event.turn == turn)
        return next(ends, None)

    def do(self, plan_text: str, patience_s: float = 30.0) -> Finished:
        self.begin(plan_text)
        ends_s = self.clock.now_s() + patience_s
        while self.clock.now_s() < ends_s:
            self.pass_time(0.02)
            end = self.end_of(self.turn)
            if end is not None:
                return end
        raise AssertionError(f"turn {self.turn} did not end")

    def notices(self) -> list[str]:
        return [event.reason.code for event in self.events if isinstance(event, Notice)]

    @property
    def stands(self) -> bool:
        return self.robot.true_twist.speed_mps < 0.005

    def drive_and_lose_the_network(self) -> None:
        self.begin("drive 5 m at 0.5 m/s")
        self.pass_time(2.0)
        assert not self.stands
        self.network.is_down = True
