"""What is asked of a written program besides its motion."""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.plan.context import RoutePlanner


@dataclass(frozen=True)
class Wanted:
    """How the program is to be.

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
