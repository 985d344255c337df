"""What runs just now, and what is left of it: by the step that Motion is at, and how far the robot came in it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from chatrobot.core.events import Event, Progress, Started
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.language.phrases import describe_steps, say
from chatrobot.plan.base import expanded
from chatrobot.plan.steps import Drive, Step, Turn

_LEAST = 0.05
"""Metres or radians: less of a step is not worth naming."""


class UnderWay:
    """It hears the events of the session's own turns. Used by the pumping thread."""

    def __init__(self) -> None:
        self._turn = 0
        self._step = 0
        self._began_at = ORIGIN
        self._pose = ORIGIN
        self._turned_rad = 0.0

    def hear(self, event: Event) -> None:
        if isinstance(event, Started):
            self._turn, self._step = event.turn, 0
            self._at(event.pose)
        elif isinstance(event, Progress):
            if (event.turn, event.step) != (self._turn, self._step):
                self._turn, self._step = event.turn, event.step
                self._at(event.pose)
            turned_rad = math.remainder(event.pose.yaw_rad - self._pose.yaw_rad, 2 * math.pi)
            self._turned_rad += turned_rad
            self._pose = event.pose

    def _at(self, pose: Pose) -> None:
        self._began_at = self._pose = pose
        self._turned_rad = 0.0

    def told(self, turn: int, steps: Sequence[Step], language: str, speed_mps: float) -> str:
        """The step that runs, with what is left of it and after it; an empty string where that is not known."""
        flat = list(expanded(steps))
        if turn != self._turn or not 0 < self._step <= len(flat):
            return ""
        now, after = flat[self._step - 1], flat[self._step :]
        left = [step for step in (self._left(now), *after) if step is not None]
        plan = describe_steps(left, language) if left else say(language, "nothing_left")
        return say(
            language, "answer_under_way", now=describe_steps([now], language), plan=plan, speed_mps=speed_mps
        )

    def _left(self, step: Step) -> Step | None:
        if isinstance(step, Drive) and step.distance_m is not None:
            moved = self._pose.relative_to(self._began_at)
            left_m = round(step.distance_m - math.hypot(moved.x_m, moved.y_m), 2)
            return dataclasses.replace(step, distance_m=left_m) if left_m >= _LEAST else None
        if isinstance(step, Turn) and step.angle_rad is not None:
            left_rad = math.radians(round(math.degrees(step.angle_rad - abs(self._turned_rad))))
            return dataclasses.replace(step, angle_rad=left_rad) if left_rad >= _LEAST else None
        return step
