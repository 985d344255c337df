"""Robots to test with: what the built-in profiles will look like, without reading any file."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.robots.profile import Defaults, Lidar, Limits, RobotProfile

MECANUM = RobotProfile(
    name="mecanum",
    title="a mecanum base",
    kinematics="mecanum",
    limits=Limits(
        max_speed_mps=1.0,
        max_sideways_mps=0.6,
        max_rate_radps=2.0,
        acceleration_mps2=1.0,
        angular_acceleration_radps2=2.0,
        deceleration_mps2=1.5,
        latency_s=0.05,
    ),
    defaults=Defaults(speed_mps=0.3, rate_radps=0.6, distance_m=0.5, turn_rad=1.5707963267948966),
    footprint=((0.2, -0.15), (0.2, 0.15), (-0.2, 0.15), (-0.2, -0.15)),
    lidar=Lidar(x_m=0.1, y_m=0.0, yaw_rad=0.0, beams=360, min_range_m=0.1, max_range_m=8.0, rate_hz=10.0),
)
DIFFERENTIAL = replace(MECANUM, name="differential", kinematics="differential", lidar=None)
ACKERMANN = replace(
    MECANUM,
    name="ackermann",
    kinematics="ackermann",
    limits=replace(MECANUM.limits, min_turning_radius_m=0.4, max_sideways_mps=0.0),
)
