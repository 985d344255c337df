"""Who hears what the program publishes: its own nodes and services, and its robot, whose sensors it hears."""

from __future__ import annotations

import math
from array import array
from collections import defaultdict
from collections.abc import Callable, Mapping
from copy import deepcopy
from typing import Any

from chatrobot.programs.inside.interfaces import kind
from chatrobot.programs.inside.link import get_link

subscriptions: defaultdict[str, list[Any]] = defaultdict(list)
publishers: defaultdict[str, list[Any]] = defaultdict(list)
"""By their topics, publishers as their handles."""
services: dict[str, Any] = {}
nodes: list[Any] = []


def add_subscription(subscription: Any) -> None:
    """Add it; what was published before comes to it if both sides keep it (transient local)."""
    subscriptions[subscription.handle.name].append(subscription)
    for publisher in publishers[subscription.handle.name]:
        for message in publisher.kept_for(subscription):
            subscription._receive(deepcopy(message))


def publish(publisher: Any, message: Any) -> None:
    """Hand `message` to every subscription of that topic and type, each with a copy of its own."""
    for subscription in tuple(subscriptions[publisher.name]):
        if subscription.msg_type is publisher.msg_type:
            subscription._receive(deepcopy(message))


def topic_types() -> list[tuple[str, list[str]]]:
    """Return every topic with the types that go over it, sorted."""
    found: dict[str, dict[str, None]] = {}
    for ends in (publishers, subscriptions):
        for topic, entities in list(ends.items()):
            for entity in entities:
                found.setdefault(topic, {})[entity.msg_type._type_name] = None
    return sorted((topic, list(types)) for topic, types in found.items())


def find_service(name: str, srv_type: Any) -> Any:
    """Return the handle of that service; None where nobody serves it."""
    service = services.get(name)
    return service if service is not None and service.srv_type is srv_type else None


def service_types() -> list[tuple[str, list[str]]]:
    """Return every service with its type, sorted."""
    return sorted((name, [served.srv_type._type_name]) for name, served in services.items())


Twist, TwistStamped = kind("geometry_msgs/Twist"), kind("geometry_msgs/TwistStamped")
Odometry, TurtlePose = kind("nav_msgs/Odometry"), kind("turtlesim/Pose")
BatteryState, Imu, LaserScan = (kind(f"sensor_msgs/{name}") for name in ("BatteryState", "Imu", "LaserScan"))
Bool, Float64, Time = kind("std_msgs/Bool"), kind("std_msgs/Float64"), kind("builtin_interfaces/Time")

Values = list[Any]
"""The sensor's stamp and its numbers, as `wire.messages` has them."""


def sender(topic: str, kind: type[Any]) -> Callable[[Any], None] | None:
    """Return what takes what is published on `topic` to the robot; None where that is no velocity of it."""
    if topic != get_link().settings.topics.get("cmd_vel"):
        return None
    if kind is Twist:
        return _send
    return (lambda message: _send(message.twist)) if kind is TwistStamped else None


def _send(twist: Any) -> None:
    linear, angular = twist.linear, twist.angular
    planar = linear.z == 0.0 and angular.x == 0.0 and angular.y == 0.0
    get_link().twist(linear.x, linear.y, angular.z, planar)


def sensor_of(topic: str, kind: type[Any]) -> tuple[str, Callable[[Values], Any]] | None:
    """Return the robot's sensor behind `topic`, and what makes a message of type `kind` of its words."""
    for sensor, name in get_link().settings.topics.items():
        converter = CONVERTERS.get((sensor, kind))
        if name == topic and converter is not None:
            return sensor, converter
    return None


def _stamp(stamp_s: float) -> Any:
    total_ns = get_link().settings.start_ns + int(stamp_s * 1e9)
    return Time(sec=total_ns // 1_000_000_000, nanosec=total_ns % 1_000_000_000)


def _set_heading(quaternion: Any, yaw_rad: float) -> None:
    quaternion.z, quaternion.w = math.sin(yaw_rad / 2.0), math.cos(yaw_rad / 2.0)


def _odometry(values: Values) -> Any:
    stamp_s, x, y, yaw, vx, vy, wz = values
    message = Odometry(child_frame_id="base_link")
    message.header.stamp, message.header.frame_id = _stamp(stamp_s), "odom"
    pose, twist = message.pose.pose, message.twist.twist
    pose.position.x, pose.position.y = x, y
    _set_heading(pose.orientation, yaw)
    twist.linear.x, twist.linear.y, twist.angular.z = vx, vy, wz
    return message


def _turtle_pose(values: Values) -> Any:
    _, x, y, yaw, vx, _vy, wz = values
    return TurtlePose(x=x, y=y, theta=yaw, linear_velocity=vx, angular_velocity=wz)


def _imu(values: Values) -> Any:
    stamp_s, rate, yaw = values
    message = Imu()
    message.header.stamp, message.header.frame_id = _stamp(stamp_s), "base_link"
    message.angular_velocity.z = rate
    message.linear_acceleration.z = 9.81
    _set_heading(message.orientation, yaw)
    return message


def _scan(values: Values) -> Any:
    stamp_s, angle_min, increment, range_min, range_max, ranges = values
    message = LaserScan(
        angle_min=angle_min, angle_increment=increment, range_min=range_min, range_max=range_max
    )
    message.header.stamp, message.header.frame_id = _stamp(stamp_s), "laser"
    message.angle_max = angle_min + increment * max(0, len(ranges) - 1)
    message.ranges = array("f", ranges)
    return message


def _battery(values: Values) -> Any:
    return BatteryState(percentage=values[1] / 100.0, present=True)


CONVERTERS: Mapping[tuple[str, type[Any]], Callable[[Values], Any]] = {
    ("odom", Odometry): _odometry,
    ("odom", TurtlePose): _turtle_pose,
    ("imu", Imu): _imu,
    ("scan", LaserScan): _scan,
    ("battery", BatteryState): _battery,
    ("battery", Float64): lambda values: Float64(data=values[1]),
    ("bumper", Bool): lambda values: Bool(data=values[1]),
}
