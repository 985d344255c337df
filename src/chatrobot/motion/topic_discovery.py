"""Finds the robot's topics where they are not as its profile says, or proposes a remapping that a person can type."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Literal

from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.wire.wire import Endpoint

IMU, SCAN = "sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"
TWISTS = TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
ODOMETRY, TURTLE_POSE = "nav_msgs/msg/Odometry", "turtlesim/msg/Pose"
TURTLE = "turtle1"
FullName = Callable[[str], str]
"""A topic of the profile as the wire lists it: absolute, with the robot's namespace."""


def is_complete(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> bool:
    """Return whether the robot is there as its profile says: velocities, odometry, gyro and scan."""
    odom_type = TURTLE_POSE if wiring.odom_type == "turtlesim/Pose" else ODOMETRY
    told = ((wiring.odom_topic, odom_type), (wiring.imu_topic, IMU), (wiring.scan_topic, SCAN))
    wanted = {Endpoint(full_name(topic), type_name, "publishes") for topic, type_name in told if topic}
    wanted.add(Endpoint(full_name(wiring.cmd_vel_topic), _cmd_vel_type(wiring), "listens"))
    return wanted <= set(endpoints)


def fit(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> tuple[Wiring, list[Reason]]:
    """Return the wiring as the wire shows it, and what a person should know of the differences.

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
            if end.role == "listens" and end.type_name in TWISTS and end.topic != cmd_vel
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


def hints(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> list[Reason]:
    """Return what to know of a robot whose velocities nobody takes, or whose odometry nobody publishes.

    Args:
        endpoints: of others.
    """
    seen = list(endpoints)
    listens = {end.topic for end in seen if end.role == "listens" and end.type_name in TWISTS}
    tells = {end.topic: end.type_name for end in seen if end.role == "publishes"}
    is_measured = bool(wiring.odom_topic) and full_name(wiring.odom_topic) in tells
    cmd_vel = full_name(wiring.cmd_vel_topic)
    if is_measured and cmd_vel in listens:
        return []
    turtles = [] if is_measured else list(_turtles(tells, listens, cmd_vel))
    if turtles:
        return turtles
    found = sorted(listens)
    return [_velocities_elsewhere(wiring, found, cmd_vel)] if found and cmd_vel not in listens else []


def why_unheard(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> Reason | None:
    """Return why no odometry comes, as far as the wire shows it."""
    seen = list(endpoints)
    found = hints(wiring, seen, full_name)
    if found or not wiring.odom_topic:
        return found[0] if found else None
    topic = full_name(wiring.odom_topic)
    told = sorted({end.topic for end in seen if end.role == "publishes" and end.type_name == ODOMETRY})
    if topic in told:
        return None
    if told:
        return unclear(topic, told)
    if any(end.topic == full_name(wiring.cmd_vel_topic) and end.role == "listens" for end in seen):
        return Reason("no_odometry_told", {"topic": topic})
    return None


def unclear(topic: str, told: list[str]) -> Reason:
    """Return the reason of a sensor that is published elsewhere, where nobody can tell which is this robot's."""
    return Reason(
        "sensor_unclear", {"topic": topic, "found": ", ".join(told), "ros_args": _remap(topic, told[0])}
    )


def _remap(topic: str, found: str) -> str:
    """`-r odom:=/wheel/odometry`; in a namespace the topic is named in full."""
    return f"-r {topic.removeprefix('/') if topic.count('/') == 1 else topic}:={found}"


def _turtles(tells: dict[str, str], listens: set[str], cmd_vel: str) -> Iterator[Reason]:
    for pose in sorted(topic for topic, type_name in tells.items() if type_name == TURTLE_POSE):
        before, _, last = pose.rpartition("/")
        if last != "pose":
            continue
        namespace, _, turtle = before.rpartition("/")
        own = f"{before}/cmd_vel"
        takes = own if own in listens else cmd_vel if cmd_vel in listens else ""
        args = ["-p robot:=turtlesim"]
        args += [f"-r __ns:={namespace}"] if namespace else []
        args += [f"-r {TURTLE}/pose:={pose}"] if turtle != TURTLE else []
        if takes and (takes != own or turtle != TURTLE):
            args.append(f"-r {TURTLE}/cmd_vel:={takes}")
        is_plain = turtle == TURTLE and takes in ("", own)
        code = "turtlesim_found" if is_plain else "turtlesim_remapped"
        about = {"namespace": namespace.strip("/")} if namespace else {}
        yield Reason(code, {"found": pose, "cmd_vel": takes, "ros_args": " ".join(args), **about})


def _velocities_elsewhere(wiring: Wiring, found: list[str], cmd_vel: str) -> Reason:
    """The robot may be in a namespace; otherwise its topic has another name."""
    values = {"topic": cmd_vel, "found": ", ".join(found), "ros_args": _remap(cmd_vel, found[0])}
    suffix = f"/{wiring.cmd_vel_topic.lstrip('/')}"
    namespace = found[0].removesuffix(suffix).strip("/") if found[0].endswith(suffix) else ""
    if namespace:
        values |= {"namespace": namespace, "ros_args": f"-r __ns:=/{namespace}"}
    return Reason("cmd_vel_elsewhere", dict(values))
