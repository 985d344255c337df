"""The simulated robot: a ROS node of a wire like any other robot, that moves when somebody lets time pass."""

from __future__ import annotations

import math
from collections import deque

from chatrobot.core.clock import Clock
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.bases import Base
from chatrobot.sim.contact import RELEASE_M, Surroundings
from chatrobot.sim.fault_injection import NO_FAULTS, FaultInjection
from chatrobot.sim.sensors import Gyro, SimLidar, WheelOdometry
from chatrobot.sim.shapes import Shape
from chatrobot.sim.world import EMPTY_WORLD, World
from chatrobot.wire.messages import Flag, Message, Odometry, TwistMessage
from chatrobot.wire.wire import Wire

TRUTH_TOPIC = "chatrobot/sim/truth"
"""`Odometry` messages with the true pose (yaw not wrapped) and velocity. For the simulation and the console only."""

TICK_S = 0.01
"""Odometry and gyro report at 100 Hz."""
_TRUTH_TICKS = 2
_SLACK_S = 1e-9
"""Sums of steps and multiples of ticks differ by rounding; what is due this much later is due now."""


class SimRobot:
    """A robot in a world. It holds its last command for ever, or for the profile's `base_timeout_s`.

    Topics are the profile's. Stamps are seconds of `clock`, read once at the start: afterwards time passes by
    `step` alone. It begins at `start`, in the frame of the world and of its odometry. Wheels that cannot move
    the robot spin on unless the injected faults say that they stall.
    """

    def __init__(
        self,
        profile: RobotProfile,
        world: World = EMPTY_WORLD,
        faults: FaultInjection = NO_FAULTS,
        *,
        wire: Wire,
        clock: Clock,
        start: Pose = ORIGIN,
    ) -> None:
        self._wiring = profile.wiring
        self._faults = faults
        self._wire = wire
        self._base = Base(profile)
        self._track_m = max(y for _, y in profile.footprint) - min(y for _, y in profile.footprint)
        self._surroundings = Surroundings(profile.footprint, [obstacle.shape for obstacle in world.obstacles])
        self._added: dict[str, Shape] = {}
        self._odometry = WheelOdometry(faults)
        self._odometry.pose = start
        self._gyro = Gyro(faults)
        self._lidar = SimLidar(profile.lidar, faults) if profile.lidar and profile.wiring.scan_topic else None
        self.start_s = clock.now_s()
        """When its first tick began; ticks come every `TICK_S` from there."""
        self.now_s = self.start_s
        """The time it has been stepped to."""
        self._ticks = 0
        self._command_ends_s = math.inf
        self._late: deque[tuple[float, str, Message]] = deque()
        self.true_pose = start
        """Where it really is. Yaw is not wrapped."""
        self._yaw_at_tick_rad = start.yaw_rad
        self.true_twist = ZERO_TWIST
        """How it really moves, in its own frame."""
        self._travelled_m = 0.0
        self.in_contact = False
        """It pushes, or last pushed, against something."""
        self._contact_pose = start
        self._measures = self._scans = True
        wire.subscribe(self._wiring.cmd_vel_topic, TwistMessage, self._on_command)

    def listen_to(self, *, sensors: bool, lidar: bool) -> None:
        """Say which sensors anybody hears; the others are spared. Without any, time passes in longer strides."""
        if sensors and not self._measures:
            self._ticks = int((self.now_s - self.start_s + _SLACK_S) / TICK_S)
            self._yaw_at_tick_rad = self.true_pose.yaw_rad
        self._measures, self._scans = sensors, sensors and lidar

    def add_obstacle(self, name: str, shape: Shape) -> None:
        """Let something appear (a name that is there already is replaced); `shape` in the world's frame."""
        self._added[name] = shape
        self._surroundings.set_added([*self._added.values()])

    def remove_obstacle(self, name: str) -> bool:
        """Remove what was added under `name`; False where nothing of that name was added."""
        if self._added.pop(name, None) is None:
            return False
        self._surroundings.set_added([*self._added.values()])
        self._set_contact(False)
        return True

    def step(self, duration_s: float) -> None:
        """Let `duration_s` pass: the robot moves and its sensors publish what is due, all at its own time."""
        end_s = self.now_s + duration_s
        while True:
            event_s = min(self._next_event_s(), end_s)
            if event_s > self.now_s:
                self._move(event_s - self.now_s)
                self.now_s = event_s
            if not self._publish_due() and event_s >= end_s:
                return

    def skip(self, duration_s: float) -> None:
        """Let time pass in which nothing happens: the machine slept, and physics goes on where it was."""
        self.start_s += duration_s
        self.now_s += duration_s
        self._command_ends_s += duration_s
        self._late = deque((due_s + duration_s, topic, message) for due_s, topic, message in self._late)

    def _on_command(self, message: TwistMessage) -> None:
        self._base.command(Twist(*message))
        if self._wiring.base_timeout_s is not None:
            self._command_ends_s = self.now_s + self._wiring.base_timeout_s

    def _next_event_s(self) -> float:
        tick_s = self.start_s + (self._ticks + 1) * TICK_S if self._measures else math.inf
        late_s = self._late[0][0] if self._late else math.inf
        return min(tick_s, late_s, self._command_ends_s)

    def _publish_due(self) -> bool:
        """Do what is due now; return True where there was anything."""
        due_s = self.now_s + _SLACK_S
        anything = False
        if self._command_ends_s <= due_s:
            self._command_ends_s = math.inf
            self._base.command(ZERO_TWIST)
            anything = True
        if self._measures and self.start_s + (self._ticks + 1) * TICK_S <= due_s:
            self._ticks += 1
            self._measure()
            anything = True
        while self._late and self._late[0][0] <= due_s:
            _, topic, message = self._late.popleft()
            self._wire.publish(topic, message)
            anything = True
        return anything

    def _move(self, duration_s: float) -> None:
        if self._base.is_standing:
            self.true_twist = ZERO_TWIST
            self._odometry.roll(ZERO_TWIST, duration_s)
            return
        for wheels, segment_s in self._base.step(duration_s):
            body = self._slipping(wheels)
            share = self._free_share(body, segment_s)
            self.true_pose = self.true_pose.moved(body, segment_s * share)
            self._travelled_m += body.speed_mps * segment_s * share
            held = share < 1.0
            if held:
                self._contact_pose = self.true_pose
            if held and self._faults.blocked == "stall":
                self._base.stall()
                self._odometry.roll(wheels, segment_s * share)
                self._odometry.roll(ZERO_TWIST, 0.0)
            else:
                self._odometry.roll(wheels, segment_s)
            self.true_twist = ZERO_TWIST if held else self._slipping(self._base.wheel_twist)

    def _free_share(self, body: Twist, duration_s: float) -> float:
        """Return how much of a motion really happens, 0 to 1: until something is in the way or the robot is stuck."""
        share = 1.0
        path_m = body.speed_mps * duration_s
        if self._travelled_m + path_m >= self._faults.stuck_after_m:
            left_m = self._faults.stuck_after_m - self._travelled_m
            share = left_m / path_m if left_m > 0.0 else 0.0
        if not body.is_zero:
            free = self._surroundings.free_share(self.true_pose, body, duration_s * share)
            if free < 1.0:
                self._set_contact(True)
            elif self.in_contact and self._has_left_contact():
                self._set_contact(False)
            share *= free
        return share

    def _has_left_contact(self) -> bool:
        turned_rad = abs(self.true_pose.yaw_rad - self._contact_pose.yaw_rad)
        moved_m = self.true_pose.distance_to(self._contact_pose) + turned_rad * self._track_m / 2.0
        return moved_m > RELEASE_M

    def _slipping(self, wheels: Twist) -> Twist:
        """Return what the body does when the wheels do `wheels`."""
        faults = self._faults
        if faults.one_wheel_slip > 0.0:
            lost_mps = faults.one_wheel_slip * (wheels.vx_mps - wheels.wz_radps * self._track_m / 2.0)
            wheels = Twist(
                wheels.vx_mps - lost_mps / 2.0, wheels.vy_mps, wheels.wz_radps + lost_mps / self._track_m
            )
        return wheels.scaled(1.0 - faults.slip) if faults.slip else wheels

    def _set_contact(self, in_contact: bool) -> None:
        if in_contact == self.in_contact:
            return
        self.in_contact = in_contact
        if self._wiring.bumper_topic:
            self._wire.publish(self._wiring.bumper_topic, Flag(in_contact))

    def _measure(self) -> None:
        stamp_s = self.start_s + self._ticks * TICK_S
        odometry = self._odometry.read(stamp_s, stamp_s - self.start_s)
        if odometry is not None and self._wiring.odom_topic:
            self._send(self._wiring.odom_topic, odometry)
        if self._wiring.imu_topic:
            # The mean over the tick, as the chip's low-pass filter gives it: summed up it is the angle turned.
            rate_radps = (self.true_pose.yaw_rad - self._yaw_at_tick_rad) / TICK_S
            self._send(self._wiring.imu_topic, self._gyro.read(stamp_s, rate_radps))
        self._yaw_at_tick_rad = self.true_pose.yaw_rad
        if self._ticks % _TRUTH_TICKS == 0:
            self._wire.publish(TRUTH_TOPIC, Odometry(stamp_s, *self.true_pose, *self.true_twist))
        scan_topic, lidar = self._wiring.scan_topic, self._lidar
        if lidar is not None and scan_topic and self._scans and self._ticks % lidar.period_ticks == 0:
            self._send(scan_topic, lidar.scan(stamp_s, self.true_pose, self._surroundings))

    def _send(self, topic: str, message: Message) -> None:
        if self._faults.latency_s > 0.0:
            self._late.append((self.now_s + self._faults.latency_s, topic, message))
        else:
            self._wire.publish(topic, message)
