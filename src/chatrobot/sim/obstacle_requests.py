"""Obstacles that come and go while a simulation runs: the request, as JSON on a topic of the simulated robot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from chatrobot.sim.shapes import Circle, Shape, polygon

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
