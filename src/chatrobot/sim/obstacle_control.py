"""Obstacles that come and go while a simulation runs: requests, as JSON on a topic of the simulated robot."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from chatrobot.sim.shapes import Circle, Shape, polygon
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.sim.robot import SimRobot

CONTROL_TOPIC = "chatrobot/sim/control"
"""`Text` with JSON: {"add": NAME, "polygon": [[x, y], …]}, {"add": NAME, "circle": [x, y, radius]} or
{"remove": NAME}; metres, in the frame of the start."""
REPLY_TOPIC = "chatrobot/sim/control_reply"
"""`Text` with JSON: {"done": NAME}, or {"error": what was wrong}."""


def read_request(request: Mapping[str, Any]) -> tuple[str, Shape | None]:
    """Return the name, and the shape that is to stand there; None where it is to be taken away.

    Raises:
        ValueError, TypeError, KeyError: it is no such request.
    """
    if "remove" in request:
        return str(request["remove"]), None
    name = str(request["add"])
    if "circle" in request:
        x_m, y_m, radius_m = (_finite(value) for value in request["circle"])
        if radius_m <= 0.0:
            raise ValueError("a radius is above zero")
        return name, Circle(x_m, y_m, radius_m)
    return name, polygon(tuple((_finite(x), _finite(y)) for x, y in request["polygon"]))


def _finite(value: Any) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{value} is not finite")
    return number


class SimControl:
    """Lets obstacles come and go in a running simulation, as messages on `CONTROL_TOPIC` say."""

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
        name, shape = read_request(request)
        if shape is not None:
            self._robot.add_obstacle(name, shape)
        elif not self._robot.remove_obstacle(name):
            raise ValueError(f"nothing named {name!r} was added")
        return name
