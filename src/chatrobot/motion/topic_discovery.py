"""Where the robot's topics are not as its profile says: what the wire shows is taken where it is plain, and said."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Literal

from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.motion.hints import ODOMETRY, TURTLE_POSE, FullName, hints, unclear
from chatrobot.wire.connect import Endpoint

IMU, SCAN = "sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def is_complete(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> bool:
    """The robot is there as its profile says: it listens for velocities, and tells odometry, gyro and scan."""
    wanted = [
        Endpoint(full_name(wiring.cmd_vel_topic), _cmd_vel_type(wiring), "listens"),
    ]
    told = ((wiring.odom_topic, _odom_type(wiring)), (wiring.imu_topic, IMU), (wiring.scan_topic, SCAN))
    for topic, type_name in told:
        if topic:
            wanted.append(Endpoint(full_name(topic), type_name, "publishes"))
    return set(wanted) <= set(endpoints)


def fit(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> tuple[Wiring, list[Reason]]:
    """The wiring as the wire shows it, and what a person should know of the differences.

    Args:
        endpoints: of others.
    """
    seen = list(endpoints)
    cmd_vel = full_name(wiring.cmd_vel_topic)
    fitted, said = _fit_velocities(wiring, seen, cmd_vel)
    sensors = _Sensors(seen, full_name("x")[:-1], cmd_vel)
    more: list[Reason] = []
    if wiring.odom_topic:  # a robot without odometry gets none from somewhere else
        fitted, more = _fit_odometry(fitted, sensors, full_name(wiring.odom_topic))
    said += [*hints(fitted, seen, full_name), *more]
    if wiring.imu_topic:
        found, more = sensors.elsewhere(full_name(wiring.imu_topic), IMU)
        fitted, said = replace(fitted, imu_topic=found or wiring.imu_topic), [*said, *more]
    if wiring.scan_topic:
        found, more = sensors.elsewhere(full_name(wiring.scan_topic), SCAN)
        fitted, said = replace(fitted, scan_topic=found or wiring.scan_topic), [*said, *more]
    return fitted, said


class _Sensors:
    """What is told, and what of it may be this robot's: in its namespace, and in none where another robot listens."""

    def __init__(self, seen: list[Endpoint], prefix: str, cmd_vel: str) -> None:
        self._told = [end for end in seen if end.role == "publishes"]
        others = {
            f"{end.topic.rpartition('/')[0]}/"
            for end in seen
            if end.role == "listens" and end.type_name in (TWIST, TWIST_STAMPED) and end.topic != cmd_vel
        }
        self._prefix = prefix
        self._others = tuple(other for other in others if not prefix.startswith(other))

    def topics(self, type_name: str) -> list[str]:
        """Where messages of that type are told, by whomever."""
        return sorted({end.topic for end in self._told if end.type_name == type_name})

    def elsewhere(self, topic: str, type_name: str) -> tuple[str, list[Reason]]:
        """Where a sensor is that `topic` does not tell; empty where it is there, or nothing is plain."""
        told = self.topics(type_name)
        if topic in told or not told:
            return "", []
        ours = [at for at in told if at.startswith(self._prefix) and not at.startswith(self._others)]
        if len(ours) == 1:
            return ours[0], [Reason("sensor_found", {"topic": topic, "found": ours[0]})]
        return "", [unclear(topic, told)]


def _fit_velocities(wiring: Wiring, seen: list[Endpoint], topic: str) -> tuple[Wiring, list[Reason]]:
    types = {end.type_name for end in seen if end.topic == topic and end.role == "listens"}
    if _cmd_vel_type(wiring) in types:
        return wiring, []
    other: Literal["Twist", "TwistStamped"] = "TwistStamped" if wiring.cmd_vel_type == "Twist" else "Twist"
    if _cmd_vel_type(replace(wiring, cmd_vel_type=other)) in types:
        said = Reason("cmd_vel_type_found", {"topic": topic, "type": other, "instead": wiring.cmd_vel_type})
        return replace(wiring, cmd_vel_type=other), [said]
    return wiring, []


def _fit_odometry(wiring: Wiring, sensors: _Sensors, topic: str) -> tuple[Wiring, list[Reason]]:
    told, poses = sensors.topics(ODOMETRY), sensors.topics(TURTLE_POSE)
    if topic in (told if wiring.odom_type == "Odometry" else poses):
        return wiring, []
    if topic in poses or topic in told:
        kind: Literal["Odometry", "turtlesim/Pose"] = "turtlesim/Pose" if topic in poses else "Odometry"
        said = Reason("odom_type_found", {"topic": topic, "type": kind, "instead": wiring.odom_type})
        return replace(wiring, odom_type=kind), [said]
    found, more = sensors.elsewhere(topic, ODOMETRY)
    if found:
        return replace(wiring, odom_topic=found, odom_type="Odometry"), more
    return wiring, more


def _cmd_vel_type(wiring: Wiring) -> str:
    return TWIST_STAMPED if wiring.cmd_vel_type == "TwistStamped" else TWIST


def _odom_type(wiring: Wiring) -> str:
    return TURTLE_POSE if wiring.odom_type == "turtlesim/Pose" else ODOMETRY
