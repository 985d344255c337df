"""Where a program is rehearsed: a simulated robot, the governor, and a clock that only we move."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.governor.governor import Governor, Verdict
from chatrobot.governor.rule import Sensed
from chatrobot.motion.governed_motion import decelerated, is_cut_short
from chatrobot.motion.programs.execution import HeldTwist
from chatrobot.robots.profile import Point, RobotProfile
from chatrobot.sim.fault_injection import NO_FAULTS
from chatrobot.sim.robot import SimRobot
from chatrobot.sim.world import EMPTY_WORLD, World
from chatrobot.transports.transport import WireTransport
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Flag, Imu, LaserScan, Message, Number
from chatrobot.wire.sensor_topics import subscribe_sensors

LEASE = "rehearsal"
STEADY_STEP_S = 2.0 * TICK_S
"""While nothing changes there is nothing to govern: the path's rows are this far apart."""
REST_S = 3.0
_EARLY_S = 1e-9


class RehearsalEnvironment:
    """See the module; `Stage` of `programs.lock_step`. `path` is rows of (t_s, x_m, y_m, yaw_rad).

    The governor works without the lidar here: what a program would hit is to be found, not hidden by a late stop. The
    program itself sees what its robot's lidar would see.
    """

    def __init__(
        self,
        profile: RobotProfile,
        world: World = EMPTY_WORLD,
        start: Pose = ORIGIN,
        area: Sequence[Point] | None = None,
    ) -> None:
        self._profile = profile
        self._clock = VirtualClock()
        hub = MemoryHub()
        self.robot = SimRobot(profile, world, NO_FAULTS, wire=hub.connect(), clock=self._clock, start=start)
        self.robot.listen_to(sensors=False, lidar=False)
        epoch = StopEpoch()
        self._wire = hub.connect()
        self._transport = WireTransport(self._wire, profile.wiring, epoch)
        self._governor = Governor(replace(profile, lidar=None), epoch, area)
        self._governor.leases.open(LEASE, "program", math.inf, 0.0)
        self._sensed = Sensed(dict.fromkeys(profile.safety.requires, 0.0))
        self._governor.begin(LEASE, 0.0, self._sensed)
        self._minds_place = profile.safety.fence is not None or bool(area)
        self._held = HeldTwist(profile.wiring.base_timeout_s)
        self._is_steady = True
        self._sent, self._governed_s = ZERO_TWIST, 0.0
        self._ticks = 0
        self._boxes: dict[str, deque[Sequence[Any]]] = {}
        self._newest: dict[str, Sequence[Any]] = {}
        self.path: list[tuple[float, float, float, float]] = [(0.0, *start)]
        self.limited: dict[str, tuple[float, Verdict]] = {}
        """By the governor's rule: when it first took something away, and what."""

    @property
    def now_s(self) -> float:
        return self._clock.now_s()

    @property
    def due_s(self) -> float:
        return (self._ticks + 1) * TICK_S if self._boxes else 1e6

    def ask(self, twist: Twist) -> None:
        if twist == self._held.at(self.now_s) and self._is_steady:
            self._held.publish(twist, self.now_s)
            return
        self._held.publish(twist, self.now_s)
        self._govern()

    def listen(self, sensor: str, depth: int) -> None:
        if sensor not in self._boxes:
            subscribe_sensors(self._wire, self._profile.wiring, {sensor: self._hear(sensor)})
            self.robot.listen_to(sensors=True, lidar=sensor == "scan" or "scan" in self._boxes)
        before = self._boxes.get(sensor, ())
        self._boxes[sensor] = deque(before, maxlen=max(1, min(depth, 100)))

    def advance(self, until_s: float, *, wakes: bool = False) -> None:
        while self.now_s < until_s - _EARLY_S and not (wakes and any(self._boxes.values())):
            self._step(until_s)

    def take_messages(self) -> list[list[Any]]:
        messages = [[sensor, *values] for sensor, box in self._boxes.items() for values in box]
        for box in self._boxes.values():
            box.clear()
        return sorted(messages, key=lambda message: message[1])

    def finish(self) -> None:
        """The program is over, its lease has ended: zero, until the robot stands."""
        self.ask(ZERO_TWIST)
        ends_s = self.now_s + REST_S
        while self.now_s < ends_s and not self.robot.true_twist.is_zero:
            self._step(ends_s)

    def _step(self, until_s: float) -> None:
        """To the next tick, or over several where nothing changes."""
        tick_s = (self._ticks + 1) * TICK_S
        if self._is_steady and not self._boxes:
            tick_s += STEADY_STEP_S - TICK_S
        end_s = min(until_s, tick_s)
        expires_s = self._held.ends_s
        if self.now_s < expires_s <= end_s and not self._held.at(self.now_s).is_zero:
            end_s = expires_s
            self._is_steady = False
        self.robot.step(end_s - self.now_s)
        self._clock.advance(end_s - self.now_s)
        self.path.append((self.now_s, *self.robot.true_pose))
        ticks = int((self.now_s + _EARLY_S) / TICK_S)
        if ticks > self._ticks:
            self._ticks = ticks
            self._deliver()
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

    def _hear(self, sensor: str) -> Callable[[Any], None]:
        def take(message: Message) -> None:
            self._newest[sensor] = self._values(message)

        return take

    def _values(self, message: Message) -> Sequence[Any]:
        if isinstance(message, Imu):
            return (*message, self.robot.true_pose.yaw_rad)
        if isinstance(message, (Flag, Number)):
            return (self.now_s, message.data)
        if isinstance(message, LaserScan):
            return (*message[:-1], [round(range_m, 4) for range_m in message.ranges_m])
        return message

    def _deliver(self) -> None:
        """Once a tick what each sensor said last: programs need no more than 50 Hz."""
        for sensor, values in self._newest.items():
            self._boxes[sensor].append(values)
        self._newest.clear()


def limited_reason(verdict: Verdict) -> Reason:
    """What the governor took away, in the words that plans have for it."""
    if verdict.reason is not None:
        return verdict.reason
    return Reason(
        "limited",
        {
            "asked_mps": verdict.asked.speed_mps,
            "possible_mps": verdict.allowed.speed_mps,
            "asked_radps": abs(verdict.asked.wz_radps),
            "possible_radps": abs(verdict.allowed.wz_radps),
        },
    )
