"""Where the robot's topics are not as its profile says: what the wire shows is taken where it is plain, and said."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Literal

from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import Endpoint

ODOMETRY, TURTLE_POSE = "nav_msgs/msg/Odometry", "turtlesim/msg/Pose"
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
FullName = Callable[[str], str]
"""A topic of the profile as the wire lists it: absolute, with the robot's namespace."""


def is_complete(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> bool:
    """The robot is there as its profile says: it listens for velocities, and tells its odometry."""
    seen = set(endpoints)
    return Endpoint(full_name(wiring.cmd_vel_topic), _cmd_vel_type(wiring), "listens") in seen and (
        Endpoint(full_name(wiring.odom_topic), _odom_type(wiring), "publishes") in seen
    )


def fit(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> tuple[Wiring, list[Reason]]:
    """The wiring as the wire shows it, and what a person should know of the differences.

    Args:
        endpoints: of others.
    """
    seen = list(endpoints)
    fitted, said = _fit_velocities(wiring, seen, full_name(wiring.cmd_vel_topic))
    fitted, more = _fit_odometry(fitted, seen, full_name(wiring.odom_topic))
    return fitted, [*said, *more]


def _fit_velocities(wiring: Wiring, seen: list[Endpoint], topic: str) -> tuple[Wiring, list[Reason]]:
    types = {end.type_name for end in seen if end.topic == topic and end.role == "listens"}
    if _cmd_vel_type(wiring) in types:
        return wiring, []
    other: Literal["Twist", "TwistStamped"] = "TwistStamped" if wiring.cmd_vel_type == "Twist" else "Twist"
    if _cmd_vel_type(replace(wiring, cmd_vel_type=other)) in types:
        said = Reason("cmd_vel_type_found", {"topic": topic, "type": other, "instead": wiring.cmd_vel_type})
        return replace(wiring, cmd_vel_type=other), [said]
    elsewhere = sorted(
        {end.topic for end in seen if end.role == "listens" and end.type_name in (TWIST, TWIST_STAMPED)}
    )
    if elsewhere:
        return wiring, [Reason("cmd_vel_elsewhere", {"topic": topic, "found": ", ".join(elsewhere)})]
    return wiring, []


def _fit_odometry(wiring: Wiring, seen: list[Endpoint], topic: str) -> tuple[Wiring, list[Reason]]:
    told = {end.topic: end.type_name for end in seen if end.role == "publishes" and end.type_name == ODOMETRY}
    poses = {end.topic for end in seen if end.role == "publishes" and end.type_name == TURTLE_POSE}
    if topic in (told if wiring.odom_type == "Odometry" else poses):
        return wiring, []
    if topic in poses or topic in told:
        kind: Literal["Odometry", "turtlesim/Pose"] = "turtlesim/Pose" if topic in poses else "Odometry"
        said = Reason("odom_type_found", {"topic": topic, "type": kind, "instead": wiring.odom_type})
        return replace(wiring, odom_type=kind), [said]
    if len(told) == 1:
        found = next(iter(told))
        said = Reason("odom_found", {"topic": topic, "found": found})
        return replace(wiring, odom_topic=found, odom_type="Odometry"), [said]
    if told:
        return wiring, [Reason("odom_unclear", {"topic": topic, "found": ", ".join(sorted(told))})]
    return wiring, []


def _cmd_vel_type(wiring: Wiring) -> str:
    return TWIST_STAMPED if wiring.cmd_vel_type == "TwistStamped" else TWIST


def _odom_type(wiring: Wiring) -> str:
    return TURTLE_POSE if wiring.odom_type == "turtlesim/Pose" else ODOMETRY
