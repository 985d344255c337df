"""A plan as a standard rclpy program that a person would write and any ROS 2 runs.

It republishes every 0.1 s, so that bases which stop by themselves go on, says floats where floats are due, and stops
the robot whatever ends it. Timed steps are timed, conditions and points are steered by what the sensors say.
"""

from __future__ import annotations

import keyword
import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.context import Impossible, LoweringContext, RoutePlanner
from chatrobot.plan.shown import runs
from chatrobot.plan.steps import Block, Go, Plan, Repeat, Step
from chatrobot.programs.writing import helpers
from chatrobot.programs.writing.lines import Body, number, write_lines
from chatrobot.robots.profile import RobotProfile

PERIOD_S = 0.1
FEEDBACK_PERIOD_S = 0.05
SENTENCE_CHARS = 700
_WIDTH = 100


def write_program(plan: Plan, profile: RobotProfile, wanted: Wanted) -> str | Impossible:
    """Return the source of a program that does `plan`, or why this robot cannot."""
    context = LoweringContext(
        profile, pose=wanted.start, plan_start=wanted.start, route_planner=wanted.routes
    )
    body = write_lines(Plan(folded(plan.steps)), context)
    if isinstance(body, Impossible):
        return body
    return _Program(body, profile, wanted).text()


class _Program:
    """One program in its pieces."""

    def __init__(self, body: Body, profile: RobotProfile, wanted: Wanted) -> None:
        self._body = body
        self._profile = profile
        self._wanted = wanted
        self._uses = body.uses
        self._kind = "TwistStamped" if profile.wiring.cmd_vel_type == "TwistStamped" else "Twist"
        self._has_scan = "move_until_near" in body.uses
        self._has_turtle = profile.wiring.odom_type == "turtlesim/Pose"
        self._listens = body.needs_pose or self._has_scan
        self._names = [
            name for name in ("linear_x", "linear_y", "angular_z") if name != "linear_y" or name in self._uses
        ]

    def text(self) -> str:
        parts = [self._docstring(), self._imports(), self._constants(), self._class(), self._main()]
        head, rest = parts[:3], parts[3:]
        return "\n".join([*(f"{part.strip()}\n" for part in head), *(f"\n{part.strip()}\n" for part in rest)])

    def _docstring(self) -> str:
        sentence = " ".join(self._wanted.sentence.replace("\\", "/").replace('"""', "'''").split())
        if len(sentence) > SENTENCE_CHARS:
            sentence = sentence[:SENTENCE_CHARS] + "…"
        title = self._wanted.name.replace("\\", "/").replace('"', "'") or "Program"
        asked = "\n".join(textwrap.wrap(f"Asked for: {sentence}", _WIDTH)) + "\n" if sentence else ""
        lead = f'"""{title[:1].upper()}{title[1:]}.'
        return f'{lead}\n\n{asked}"""' if asked else f'{lead}"""'

    def _imports(self) -> str:
        lines = {
            "import math": self._listens or "math" in self._uses,
            "import time": True,
            "": True,
            "import rclpy": True,
            f"from geometry_msgs.msg import {self._kind}": True,
            "from nav_msgs.msg import Odometry": self._body.needs_pose and not self._has_turtle,
            "from rclpy.node import Node": True,
            "from rclpy.qos import qos_profile_sensor_data": self._has_scan,
            "from rclpy.signals import SignalHandlerOptions": True,
            "from sensor_msgs.msg import LaserScan": self._has_scan,
            "from turtlesim.msg import Pose": self._body.needs_pose and self._has_turtle,
        }
        return "\n".join(line for line, is_needed in lines.items() if is_needed)

    def _constants(self) -> str:
        lines = [f"PERIOD = {number(FEEDBACK_PERIOD_S if self._listens else PERIOD_S)}  # s"]
        lidar = self._profile.lidar
        if self._has_scan and lidar is not None:
            corners = ", ".join(f"({number(x)}, {number(y)})" for x, y in self._profile.footprint)
            lines.append(f"FOOTPRINT = [{corners}]  # m")
            where = ", ".join(map(number, (lidar.x_m, lidar.y_m, lidar.yaw_rad)))
            lines.append(f"LIDAR = ({where})  # x, y in m, yaw in rad")
        return "\n".join(lines) + "\n"

    def _class(self) -> str:
        methods = [self._init(), self._run(), *self._methods()]
        return f"class {class_name(self._wanted.name)}(Node):\n" + "\n".join(methods)

    def _init(self) -> str:
        wiring = self._profile.wiring
        topic = self._wanted.topic or wiring.cmd_vel_topic
        lines = [
            "    def __init__(self):",
            f"        super().__init__({node_name(self._wanted.name)!r})",
            f"        self.publisher = self.create_publisher({self._kind}, {topic!r}, 10)",
        ]
        if self._body.needs_pose:
            odom = "Pose" if self._has_turtle else "Odometry"
            lines += [
                "        self.pose = None",
                f"        self.create_subscription({odom}, {wiring.odom_topic!r}, self.on_odom, 10)",
            ]
        if self._has_scan:
            lines += [
                "        self.scan = None",
                f"        topic, qos = {wiring.scan_topic!r}, qos_profile_sensor_data",
                "        self.create_subscription(LaserScan, topic, self.on_scan, qos)",
            ]
        return "\n".join(lines) + "\n"

    def _run(self) -> str:
        lines = ["    def run(self):"]
        if self._body.needs_pose:
            lines.append("        self.wait_for_pose()")
        if "from_start" in self._uses:
            lines.append("        self.start = self.pose")
        lines += [f"        {line}" for line in self._body.lines]
        return "\n".join(lines if len(lines) > 1 else [*lines, "        pass"]) + "\n"

    def _methods(self) -> list[str]:
        rate = number(min(self._profile.defaults.rate_radps, self._profile.limits.max_rate_radps))
        defaults = ", ".join(f"{name}=0.0" for name in self._names)
        fields = {"linear_x": "linear.x", "linear_y": "linear.y", "angular_z": "angular.z"}
        filled = {
            "signature": defaults,
            "passed": ", ".join(self._names),
            "assignments": "\n".join(f"        twist.{fields[name]} = {name}" for name in self._names),
            "rest": number(self._wanted.rest_s),
            "rate": rate,
        }
        # `seconds` has no default: it stands before those that have one, and is always named.
        calls = {**filled, "signature": f"{defaults}, *, "}
        direction = (
            "math.atan2(linear_y, linear_x)" if "linear_y" in self._uses else "math.atan2(0.0, linear_x)"
        )
        uses, has_pose = self._uses, self._body.needs_pose
        pause = helpers.PAUSE_SLEEPING if self._wanted.uses_sleep else helpers.PAUSE_LISTENING
        publish = helpers.PUBLISH_STAMPED if self._kind == "TwistStamped" else helpers.PUBLISH
        methods = {
            helpers.MOVE.format(**calls): "move" in uses or "rest" in uses,
            helpers.REST.format(rest=number(self._settle_s())): "rest" in uses,
            helpers.GO_TO.format(**filled): "go_to" in uses,
            helpers.FACE.format(**filled): has_pose,
            helpers.FROM_START: "from_start" in uses,
            helpers.MOVE_UNTIL_NEAR.format(direction=direction, **calls): self._has_scan,
            helpers.FREE_AHEAD: self._has_scan,
            helpers.ON_SCAN: self._has_scan,
            helpers.ON_TURTLE_POSE if self._has_turtle else helpers.ON_ODOM: has_pose,
            helpers.WAIT_FOR_POSE: has_pose,
            pause if self._listens else helpers.PAUSE: True,
            publish.format(**filled): True,
            helpers.STOP.format(**filled): True,
        }
        return [method for method, is_needed in methods.items() if is_needed]

    def _settle_s(self) -> float:
        """As long as the ramps down from the default speeds take, and a little."""
        limits, defaults = self._profile.limits, self._profile.defaults
        ramp_s = max(
            defaults.speed_mps / min(limits.acceleration_mps2, limits.deceleration_mps2),
            defaults.rate_radps / limits.angular_acceleration_radps2,
        )
        return round(ramp_s + 0.2, 1)

    def _main(self) -> str:
        return f"""
def main(args=None):
    # Ctrl-C must not close the context before the robot has been told to stop.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = {class_name(self._wanted.name)}()
    try:
        node.run()
    except KeyboardInterrupt:
        pass
    finally:
        node.stop()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
"""


def node_name(name: str) -> str:
    """Return a name that ROS takes for a node: letters, digits and underscores."""
    slug = re.sub(r"[^a-z0-9]+", "_", name.casefold()).strip("_")
    if not slug or not re.match(r"[a-z]", slug):
        slug = f"program_{slug}".rstrip("_")
    return f"{slug}_node" if keyword.iskeyword(slug) else slug


def class_name(name: str) -> str:
    """Return the same for the class: `square dance` becomes SquareDance."""
    found = "".join(part.capitalize() for part in node_name(name).split("_"))
    return (
        f"{found}Node"
        if found in ("Node", "Twist", "TwistStamped", "Odometry", "LaserScan", "Pose")
        else found
    )


def folded(steps: Sequence[Step]) -> tuple[Step, ...]:
    """Return the same steps with loops for what repeats. Ways to places are left alone: each begins somewhere else."""
    found: list[Step] = []
    for count, block in runs(
        steps,
        longest_count=len(steps),
        least_saved_count=1,
        may_repeat=lambda step: not isinstance(step, (Go, Block)),
    ):
        found += [Repeat(count, tuple(block))] if count > 1 else block
    return tuple(found)


@dataclass(frozen=True)
class Wanted:
    """The wishes for a program.

    Args:
        name: of the program and its node, in words of any language.
        sentence: what the person said, for the program's docstring.
        topic: where velocities go as the person wrote it; "" for the robot's own.
        uses_sleep: time passes by time.sleep, also where sensors are heard.
        rest_s: how long it stands at its end.
        start: where the robot stands, in `odom`.
        routes: finds ways around what is known; without it, `go` drives straight.
    """

    name: str
    sentence: str = ""
    topic: str = ""
    uses_sleep: bool = False
    rest_s: float = 1.0
    start: Pose = ORIGIN
    routes: RoutePlanner | None = None
