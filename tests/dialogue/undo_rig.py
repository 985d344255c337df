"""A session whose robot, wire and Motion a test can get at, on simulated time."""

from __future__ import annotations

import math
from collections.abc import Callable

from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event, Finished, Interpreted, Result
from chatrobot.core.geometry import Pose
from chatrobot.core.wiring import JOYSTICK_TOPIC
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.session import Session
from chatrobot.dialogue.understanding import Understanding
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.motion_link import Sender
from chatrobot.motion.motion import Motion
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Odometry, TwistMessage


class UndoRig:
    """Says texts, lets robots be stopped, pushed about and restarted."""

    def __init__(
        self, world: str = "empty", profile: RobotProfile | None = None, options: Options | None = None
    ) -> None:
        profile, clock, hub = profile or load_profile("wheeltec_mini_mec"), VirtualClock(), MemoryHub()
        around = load_world(world)
        self.events: list[Event] = []
        self.robot = SimRobot(profile, around, FaultInjection.parse(""), wire=hub.connect(), clock=clock)
        self._somebody = hub.connect()
        self._motion_of: list[Motion] = []
        wire, guard = hub.connect(), SimulatedGuard(clock)

        def build(emit: Callable[[Event], None]) -> Motion:
            programs = ProgramHost(profile, is_in_step=True)
            motion = Motion(
                profile, wire, clock, Planner(profile, around), guard, emit, lambda goal: goal(), programs
            )
            self._motion_of.append(motion)
            return motion

        link = InProcessLink(
            build, wire, clock, self.robot.step, guard, hub.connect(), profile.wiring.cmd_vel_topic
        )
        self.motion = self._motion_of[0]
        understanding = Understanding(profile, around, None)
        self.session = Session(link, understanding, self.events.append, options or Options())
        self.live(0.5)

    # --- what a person does ---

    def do(self, text: str) -> Result:
        """Say it and see it through."""
        result = self.session.do(text)
        self.live(0.5)
        return result

    def stopped_after(self, text: str, way_m: float = 0.5, way_deg: float = 30.0) -> Result:
        """Say it, and stop once the robot has gone so far, or turned so far."""
        began = self.pose
        turn = self.session.say(text)
        self._pump_until(lambda: self._is_off(began, way_m, way_deg))
        self.session.say("stop")
        self._pump_until(lambda: turn in self.session.results)
        self.live(0.5)
        return self.session.results[turn]

    def live(self, duration_s: float) -> None:
        """Let time pass."""
        for _ in range(round(duration_s / 0.02)):
            self.session.pump(0.02)

    # --- what happens to the robot ---

    def joystick(self, vx_mps: float, wz_radps: float, duration_s: float) -> None:
        """Somebody drives with a joystick, and lets go."""
        for _ in range(round(duration_s / 0.1)):
            self._somebody.publish(JOYSTICK_TOPIC, TwistMessage(vx_mps, 0.0, wz_radps))
            self.live(0.1)
        self.live(1.0)

    def another_source(self, plan_text: str) -> None:
        """A program of somebody else's has a plan driven."""
        sender = Sender("agent")
        self.motion.receive(sender.envelope("hello"))
        self.motion.receive(sender.envelope("plan", 99, plan_text=plan_text, mode="queue"))
        while not any(isinstance(event, Finished) and event.turn == 99 for event in self.events):
            self.motion.receive(sender.envelope("beat"))
            self.live(0.1)
        self.live(0.5)

    def restart_odometry(self) -> None:
        """The robot's end is switched off and on: it counts from zero where it stands."""
        origin = self.robot.true_pose
        estimator = self.motion.sensors.estimator
        hear = estimator.on_odometry

        def hear_anew(message: Odometry) -> None:
            x_m, y_m, yaw_rad = Pose(*message[1:4]).relative_to(origin)
            hear(message._replace(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad))

        estimator.on_odometry = hear_anew  # type: ignore[method-assign]
        self.live(0.5)

    # --- what came of it ---

    @property
    def pose(self) -> Pose:
        """Where the robot truly is."""
        return self.robot.true_pose

    @property
    def speed_mps(self) -> float:
        """Return how fast the robot says it is."""
        return self.session.understanding.speed_mps

    @property
    def x_m(self) -> float:
        return self.pose.x_m

    def plan_of(self, result: Result) -> str:
        """The plan text of that turn."""
        found = [e for e in self.events if isinstance(e, Interpreted) and e.turn == result.turn]
        return found[-1].plan_text

    def is_at(self, pose: Pose, within_m: float = 0.02, within_deg: float = 1.0) -> bool:
        """The robot truly stands there."""
        return not self._is_off(pose, within_m, within_deg)

    def _is_off(self, pose: Pose, way_m: float, way_deg: float) -> bool:
        off_rad = math.remainder(self.pose.yaw_rad - pose.yaw_rad, 2.0 * math.pi)
        return self.pose.distance_to(pose) > way_m or abs(math.degrees(off_rad)) > way_deg

    def _pump_until(self, done: Callable[[], bool]) -> None:
        for _ in range(20_000):
            if done():
                return
            self.session.pump(0.02)
        raise AssertionError("it did not come to pass")


def on_its_way_to(place: str) -> UndoRig:
    """A robot at home that drives to a place, where what is said replaces what it does."""
    rig = UndoRig("home", None, Options(while_moving="replace"))
    rig.session.say(f"go to the {place}")
    rig.live(2.0)
    return rig


def said(rig: UndoRig, text: str, wait_s: float = 1.0) -> int:
    """Say that, and let some time pass; return its turn."""
    turn = rig.session.say(text)
    rig.live(wait_s)
    return turn
