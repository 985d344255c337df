"""The two joints, made alike for the contract: simulated time in one thread, real time in processes."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event, Finished, Telemetry
from chatrobot.governor.lease import RELEASERS
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.motion_link import MotionLink
from chatrobot.link.processes import MotionProcess, spawn
from chatrobot.link.socket_link import SocketLink
from chatrobot.motion.motion import Motion
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget, RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.local import LocalWire
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import TwistMessage

PROFILE = "wheeltec_mini_mec"


class LinkRig(Protocol):
    """A link to a robot in the empty world, and an ear on its wire."""

    link: MotionLink
    velocities: list[TwistMessage]

    def close(self) -> None: ...


class SimulatedRig:
    """Everything in this thread."""

    def __init__(
        self, _folder: Path, releasers: frozenset[str] = RELEASERS, profile: RobotProfile | None = None
    ) -> None:
        profile, clock, self.hub = profile or load_profile(PROFILE), VirtualClock(), MemoryHub()
        hub = self.hub
        self.velocities: list[TwistMessage] = []
        self.robot = SimRobot(
            profile, load_world("empty"), FaultInjection.parse(""), wire=hub.connect(), clock=clock
        )
        hub.connect().subscribe("cmd_vel", TwistMessage, self.velocities.append)
        wire, guard = hub.connect(), SimulatedGuard(clock)

        def build(emit: Callable[[Event], None]) -> Motion:
            planner = Planner(profile, load_world("empty"))
            programs = ProgramHost(profile, is_in_step=True)
            return Motion(
                profile, wire, clock, planner, guard, emit, lambda goal: goal(), programs, releasers
            )

        self.link: MotionLink = InProcessLink(
            build, wire, clock, self.robot.step, guard, hub.connect(), "cmd_vel"
        )
        self.link.next_event(0.3)

    def close(self) -> None:
        self.link.close()


class ProcessRig:
    """The simulated robot, Motion and its guard in processes of their own."""

    def __init__(self, folder: Path, budget: MotionBudget = NOT_CHOSEN) -> None:
        path = folder / "robot.wire"
        self._robot = spawn("chatrobot.sim", "--socket", str(path), "--profile", PROFILE, "--world", "empty")
        link = SocketLink(MotionProcess.start([str(path)], PROFILE, "empty", budget)[0])
        link.wait_until_ready()
        self.link: MotionLink = link
        self.velocities: list[TwistMessage] = []
        self._ear = LocalWire(path)
        self._ear.subscribe("cmd_vel", TwistMessage, self.velocities.append)

    def close(self) -> None:
        self.link.close()
        self._ear.close()
        self._robot.terminate()
        self._robot.wait(10.0)


def events_until(rig: LinkRig, wanted: Callable[[Event], bool], patience_s: float = 30.0) -> list[Event]:
    """All events up to the first wanted one."""
    seen: list[Event] = []
    deadline_s = time.monotonic() + patience_s
    while time.monotonic() < deadline_s:
        event = rig.link.next_event(0.1)
        if event is not None:
            seen.append(event)
            if wanted(event):
                return seen
    told = [event for event in seen if not isinstance(event, Telemetry)]
    raise AssertionError(f"the event did not come; seen besides telemetry: {told[-8:]}; last: {seen[-1:]}")


def finished(rig: LinkRig, turn: int) -> Finished:
    """The end of a turn."""
    last = events_until(rig, lambda event: isinstance(event, Finished) and event.turn == turn)[-1]
    assert isinstance(last, Finished)
    return last


def send_plan(rig: LinkRig, turn: int, plan_text: str, mode: str = "queue", **more: Any) -> None:
    rig.link.send("plan", turn, plan_text=plan_text, mode=mode, **more)


def moving(rig: LinkRig, turn: int) -> None:
    """Wait until that turn's motion shows in odometry."""
    events_until(rig, lambda event: event.turn == turn and event.name == "progress" and event.pose.x_m > 0.05)  # type: ignore[attr-defined]
