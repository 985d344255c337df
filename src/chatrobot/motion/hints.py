"""A robot that is on the wire under other names than its profile has: what was found, and what a person can type.

Values named `…_args` are what stands behind `--ros-args`; they are no words of a language.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from chatrobot.core.reason import Reason
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import Endpoint

ODOMETRY, TURTLE_POSE = "nav_msgs/msg/Odometry", "turtlesim/msg/Pose"
TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
TURTLE = "turtle1"
FullName = Callable[[str], str]
"""A topic of the profile as the wire lists it: absolute, with the robot's namespace."""


def hints(wiring: Wiring, endpoints: Iterable[Endpoint], full_name: FullName) -> list[Reason]:
    """What to know of a robot whose velocities nobody takes, or whose odometry nobody tells; nothing where it is there.

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
    """Why no odometry comes, as far as the wire shows it."""
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
    """A sensor is told, but not where the profile says, and which one is this robot's nobody can tell."""
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
