"""Who else is on a robot's ROS graph, as the robot's `rosapi` node tells it over rosbridge."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Literal

from chatrobot.wire.wire import Endpoint

Call = Callable[[str, dict[str, Any]], "dict[str, Any] | None"]
"""Calls a service with arguments: its answer, {} where it failed, None where nobody answered."""

BRIDGES = ("rosbridge_websocket", "rosbridge_server")
"""The bridge's own node stands for everybody who comes over it, ourselves included."""

ASK_AGAIN_S = 30.0
"""A robot without `rosapi` is asked again after this long, not with every look."""

_OF_INTEREST = ("Twist", "TwistStamped", "Odometry", "Pose", "Imu", "LaserScan")
"""Only topics of these types are looked into: every topic costs two questions."""


class RosApi:
    """Asks when it is asked; blocks for as long as `call` does."""

    def __init__(self, call: Call) -> None:
        self._call = call
        self._silent_until_s = 0.0

    def survey(self) -> list[Endpoint]:
        """Everybody's endpoints on topics of velocities and odometry; none where no `rosapi` runs."""
        answer = self._ask("/rosapi/topics", {})
        found = []
        for topic, type_name in zip(_texts(answer, "topics"), _texts(answer, "types")):
            if type_name.rpartition("/")[2] in _OF_INTEREST:
                if self.publishers_of(topic):
                    found.append(Endpoint(topic, _with_msg(type_name), "publishes"))
                if self._nodes("subscribers", topic):
                    found.append(Endpoint(topic, _with_msg(type_name), "listens"))
        return found

    def publishers_of(self, topic: str) -> list[str]:
        """The nodes that publish on it, by their full names, without the bridge."""
        return self._nodes("publishers", topic)

    def _nodes(self, role: Literal["publishers", "subscribers"], topic: str) -> list[str]:
        names = _texts(self._ask(f"/rosapi/{role}", {"topic": topic}), role)
        return sorted(name for name in names if name.rpartition("/")[2] not in BRIDGES)

    def _ask(self, service: str, arguments: dict[str, Any]) -> dict[str, Any]:
        if time.monotonic() < self._silent_until_s:
            return {}
        answer = self._call(service, arguments)
        if answer is None:
            self._silent_until_s = time.monotonic() + ASK_AGAIN_S
        return answer or {}


def _texts(answer: dict[str, Any], name: str) -> list[str]:
    values = answer.get(name)
    return [value for value in values if isinstance(value, str)] if isinstance(values, list) else []


def _with_msg(type_name: str) -> str:
    """`nav_msgs/Odometry`, as ROS 1 has it, is `nav_msgs/msg/Odometry`."""
    package, _, short = type_name.partition("/")
    return type_name if short.startswith("msg/") else f"{package}/msg/{short}"
