"""The surroundings of a rehearsal: a simulated robot, the governor, and a clock that only we move."""

from __future__ import annotations

import math
from dataclasses import replace

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import Governor, Verdict
from chatrobot.governor.rule import Sensed
from chatrobot.motion.governed_motion import decelerated, is_cut_short
from chatrobot.motion.programs.clocks import HeldTwist, SensorMailbox, is_tick
from chatrobot.motion.safety.stop import WireTransport
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.fault_injection import NO_FAULTS
from chatrobot.sim.robot import SimRobot
from chatrobot.sim.world import EMPTY_WORLD, World
from chatrobot.wire.memory import MemoryHub

LEASE = "rehearsal"
STEADY_STEP_S = 2.0 * TICK_S
"""While nothing changes there is nothing to govern: the path's rows are this far apart."""
REST_S = 3.0
_EARLY_S = 1e-9


class RehearsalEnvironment:
    """See the module. Times are seconds since the program's start; `path` is rows of (t_s, x_m, y_m, yaw_rad).

    The governor works without the lidar here: what a program would hit is to be found, not hidden by a late stop. The
    program itself sees what its robot's lidar would see.
    """

    def __init__(self, profile: RobotProfile, world: World = EMPTY_WORLD, start: Pose = ORIGIN) -> None:
        self._profile = profile
        self._clock = VirtualClock()
        hub = MemoryHub()
        # The control loop sends 50 times a second, here only what changes is sent: this base must not time out. `_held`
        # ends what the program published, after as long.
        held_on = replace(profile, wiring=replace(profile.wiring, base_timeout_s=None))
        self.robot = SimRobot(held_on, world, NO_FAULTS, wire=hub.connect(), clock=self._clock, start=start)
        self.robot.listen_to(sensors=False, lidar=False)
        epoch = StopEpoch()
        wire = hub.connect()
        self.sensors = SensorMailbox()
        self.sensors.attach(wire, profile.wiring)
        self._transport = WireTransport(wire, profile.wiring, epoch)
        self._governor = Governor(replace(profile, lidar=None), epoch)
        self._governor.leases.open(LEASE, "program", math.inf, 0.0)
        self._sensed = Sensed(dict.fromkeys(profile.safety.requires, 0.0))
        self._governor.begin(LEASE, 0.0, self._sensed)
        self._minds_place = profile.safety.fence is not None
        self._held = HeldTwist(profile.wiring.base_timeout_s)
        self._is_steady = True
        self._sent, self._governed_s = ZERO_TWIST, 0.0
        self._heard: frozenset[str] = frozenset()
        self.path: list[tuple[float, float, float, float]] = [(0.0, *start)]
        self.limited: dict[str, tuple[float, Verdict]] = {}
        """By the governor's rule: when it first took something away, and what."""

    @property
    def now_s(self) -> float:
        """Return the time since the program's start."""
        return self._clock.now_s()

    def ask(self, twist: Twist) -> None:
        """Take a velocity that the program publishes now."""
        if twist == self._held.at(self.now_s) and self._is_steady:
            self._held.publish(twist, self.now_s)
            return
        self._held.publish(twist, self.now_s)
        self._govern()

    def advance(self, until_s: float) -> None:
        """Let time pass."""
        if self._heard != self.sensors.sensors:
            self._heard = self.sensors.sensors
            self.robot.listen_to(sensors=True, lidar="scan" in self._heard)
        while self.now_s < until_s - _EARLY_S:
            self._step(until_s)

    def finish(self) -> None:
        """End the program's lease: zero, until the robot stands."""
        self.ask(ZERO_TWIST)
        ends_s = self.now_s + REST_S
        while self.now_s < ends_s and not self.robot.true_twist.is_zero:
            self._step(ends_s)

    def _step(self, until_s: float) -> None:
        """Let time pass to the next tick, or over several where nothing changes."""
        stride_s = STEADY_STEP_S if self._is_steady and not self._heard else TICK_S
        end_s = min(until_s, (int((self.now_s + _EARLY_S) / TICK_S)) * TICK_S + stride_s)
        expires_s = self._held.ends_s
        if self.now_s < expires_s <= end_s and not self._held.at(self.now_s).is_zero:
            end_s = expires_s
            self._is_steady = False
        self.robot.step(end_s - self.now_s)
        self._clock.advance(end_s - self.now_s)
        self.path.append((self.now_s, *self.robot.true_pose))
        if is_tick(self.now_s):
            self.sensors.collect(self.now_s)
        if not self._is_steady:
            self._govern()

    def _govern(self) -> None:
        now_s = self.now_s
        held = self._held.at(now_s)
        asked = decelerated(held, self._sent, self._profile.limits, min(now_s - self._governed_s, TICK_S))
        verdict = self._governor.govern(asked, LEASE, now_s, self.robot.true_pose, self._sensed)
        self._transport.send(verdict.sent)
        self._sent, self._governed_s = verdict.sent.twist, now_s
        self._is_steady = asked == held and verdict.sent.twist == verdict.allowed and not self._minds_place
        self._note(verdict)

    def _note(self, verdict: Verdict) -> None:
        if not verdict.asked.is_finite or is_cut_short(verdict):
            self.limited.setdefault(verdict.rule, (self.now_s, verdict))
