"""A simulated robot on a bench: one call commands it, one call lets time pass, and all it says is kept."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.clock import VirtualClock
from chatrobot.robots.profile import Defaults, Kinematics, Lidar, Limits, RobotProfile, Wiring
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.robot import TRUTH_TOPIC, SimRobot
from chatrobot.sim.shapes import Shape
from chatrobot.sim.world import EMPTY_WORLD, Obstacle, World
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Flag, Imu, LaserScan, Odometry, TwistMessage

STEP_S = 0.01

PROFILE = RobotProfile(
    name="bench",
    title="A robot for tests",
    kinematics="mecanum",
    limits=Limits(
        max_speed_mps=1.0,
        max_sideways_mps=1.0,
        max_rate_radps=2.0,
        acceleration_mps2=1.0,
        angular_acceleration_radps2=2.0,
        deceleration_mps2=2.0,
        latency_s=0.05,
    ),
    defaults=Defaults(speed_mps=0.3, rate_radps=0.6, distance_m=0.5, turn_rad=1.57),
    footprint=((0.15, -0.1), (0.15, 0.1), (-0.15, 0.1), (-0.15, -0.1)),
    wiring=Wiring(imu_topic="imu", scan_topic="scan", bumper_topic="bumper"),
    lidar=Lidar(x_m=0.0, y_m=0.0, yaw_rad=0.0, beams=360, min_range_m=0.05, max_range_m=12.0, rate_hz=10.0),
)


def with_kinematics(kinematics: Kinematics, turning_radius_m: float = 0.0) -> RobotProfile:
    limits = replace(PROFILE.limits, min_turning_radius_m=turning_radius_m)
    return replace(PROFILE, kinematics=kinematics, limits=limits)


def world_of(*shapes: Shape) -> World:
    return World("test", tuple(Obstacle(f"thing {i}", shape) for i, shape in enumerate(shapes)))


class Rig:
    def __init__(
        self,
        faults: str = "",
        world: World = EMPTY_WORLD,
        profile: RobotProfile = PROFILE,
        start_s: float = 0.0,
    ) -> None:
        hub = MemoryHub()
        self.clock = VirtualClock(start_s)
        self.wire = hub.connect()
        self.odometry: list[Odometry] = []
        self.gyro: list[Imu] = []
        self.scans: list[LaserScan] = []
        self.bumps: list[bool] = []
        self.truth: list[Odometry] = []
        self.heard_at_s: list[float] = []
        self.wire.subscribe("odom", Odometry, self.odometry.append)
        self.wire.subscribe("odom", Odometry, lambda _: self.heard_at_s.append(self.robot.now_s))
        self.wire.subscribe("imu", Imu, self.gyro.append)
        self.wire.subscribe("scan", LaserScan, self.scans.append)
        self.wire.subscribe("bumper", Flag, lambda flag: self.bumps.append(flag.data))
        self.wire.subscribe(TRUTH_TOPIC, Odometry, self.truth.append)
        self.robot = SimRobot(
            profile, world, FaultInjection.parse(faults), wire=hub.connect(), clock=self.clock
        )

    def command(self, vx_mps: float = 0.0, vy_mps: float = 0.0, wz_radps: float = 0.0) -> None:
        self.wire.publish("cmd_vel", TwistMessage(vx_mps, vy_mps, wz_radps))

    def run(self, duration_s: float, step_s: float = STEP_S) -> None:
        for _ in range(round(duration_s / step_s)):
            self.clock.advance(step_s)
            self.robot.step(step_s)

    def tour(self) -> None:
        """A bit of everything: forward, a curve, sideways, a turn."""
        for twist, duration_s in (
            ((0.5, 0.0, 0.0), 1.0),
            ((0.4, 0.0, 0.7), 1.5),
            ((0.0, 0.3, 0.0), 1.0),
            ((0.0, 0.0, -1.0), 1.0),
            ((0.0, 0.0, 0.0), 0.5),
        ):
            self.command(*twist)
            self.run(duration_s)
