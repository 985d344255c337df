"""Obstacles that come and go in a running simulation, by messages: for tests and demonstrations."""

from __future__ import annotations

import json
import math
from typing import Any

from chatrobot.sim.robot import SimRobot
from chatrobot.sim.shapes import Circle, Shape, polygon
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

CONTROL_TOPIC = "chatrobot/sim/control"
"""`Text` with JSON: {"add": NAME, "polygon": [[x, y], …]}, {"add": NAME, "circle": [x, y, radius]} or
{"remove": NAME}; metres, in the frame of the start."""
REPLY_TOPIC = "chatrobot/sim/control_reply"
"""`Text` with JSON: {"done": NAME}, or {"error": what was wrong}."""


class SimControl:
    """Listens on `CONTROL_TOPIC` and does what it says to the robot's surroundings."""

    def __init__(self, robot: SimRobot, wire: Wire) -> None:
        self._robot = robot
        self._wire = wire
        wire.subscribe(CONTROL_TOPIC, Text, self._on_request)

    def _on_request(self, message: Text) -> None:
        try:
            reply = {"done": self._apply(json.loads(message.data))}
        except (ValueError, TypeError, KeyError) as error:
            reply = {"error": f"not understood: {error}"}
        self._wire.publish(REPLY_TOPIC, Text(json.dumps(reply)))

    def _apply(self, request: dict[str, Any]) -> str:
        if "remove" in request:
            name = str(request["remove"])
            if not self._robot.remove_obstacle(name):
                raise ValueError(f"nothing named {name!r} was added")
            return name
        name = str(request["add"])
        self._robot.add_obstacle(name, _shape(request))
        return name


def _shape(request: dict[str, Any]) -> Shape:
    if "circle" in request:
        x_m, y_m, radius_m = (_finite(value) for value in request["circle"])
        return Circle(x_m, y_m, radius_m)
    return polygon(tuple((_finite(x), _finite(y)) for x, y in request["polygon"]))


def _finite(value: Any) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{value} is not finite")
    return number
