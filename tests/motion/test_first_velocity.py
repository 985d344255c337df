"""A motion that is launched within a tick goes on from its first velocity: no zero stands between it and the ramp."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event
from chatrobot.link.in_process import InProcessLink
from chatrobot.motion.motion import Motion
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import TwistMessage

READING_S = 1e-4


class ClockThatPasses:
    """As a real clock: it is later each time that it is read, also within one tick."""

    def __init__(self, clock: VirtualClock) -> None:
        self._clock, self._readings, self._at_s = clock, 0, 0.0

    def now_s(self) -> float:
        now_s = self._clock.now_s()
        self._readings = self._readings + 1 if now_s == self._at_s else 0
        self._at_s = now_s
        return now_s + READING_S * self._readings

    def suspended_s(self) -> float:
        return self._clock.suspended_s()


def test_no_zero_follows_the_first_velocity() -> None:
    profile, clock, hub = load_profile("wheeltec_mini_mec"), VirtualClock(), MemoryHub()
    velocities: list[TwistMessage] = []
    robot = SimRobot(profile, load_world("empty"), wire=hub.connect(), clock=clock)
    hub.connect().subscribe("cmd_vel", TwistMessage, velocities.append)
    wire, guard = hub.connect(), SimulatedGuard(clock)

    def build(emit: Callable[[Event], None]) -> Motion:
        planner = Planner(profile, load_world("empty"))
        programs = ProgramHost(profile, is_in_step=True)
        return Motion(
            profile, wire, ClockThatPasses(clock), planner, guard, emit, lambda goal: goal(), programs
        )

    link = InProcessLink(build, wire, clock, robot.step, guard, hub.connect(), "cmd_vel")
    link.next_event(0.3)
    link.send("plan", 1, plan_text="drive 0.3 m", mode="queue")
    for _ in range(40):
        link.next_event(0.02)
    moving = [any(velocity) for velocity in velocities]
    assert any(moving)
    assert all(moving[moving.index(True) :])
