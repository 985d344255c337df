"""Where steps lead, by what they tell: to go on from there, to face something, or to see that they lead back."""

from __future__ import annotations

import math
from collections.abc import Iterable

from chatrobot.core.geometry import Pose
from chatrobot.plan.steps import Arc, Drive, Face, Go, Remember, Repeat, Say, Step, Turn, Wait


def pose_after(steps: Iterable[Step], start: Pose) -> Pose | None:
    """Where an ideal robot stands after `steps` from `start`, in the frame of `start`; None where they do not tell."""
    here = start
    for step in _one_by_one(steps):
        if isinstance(step, Go):
            here = _in_frame(Pose(step.x_m, step.y_m, step.yaw_rad or 0.0), step.frame, start)
        elif isinstance(step, Face):
            here = here._replace(yaw_rad=_in_frame(Pose(0.0, 0.0, step.yaw_rad), step.frame, start).yaw_rad)
        elif isinstance(step, Drive) and step.distance_m is not None and step.until is None:
            along, across = math.cos(step.direction_rad), math.sin(step.direction_rad)
            here = here.compose(Pose(step.distance_m * along, step.distance_m * across))
        elif isinstance(step, Turn) and step.angle_rad is not None:
            here = here.compose(Pose(0.0, 0.0, step.angle_rad if step.left else -step.angle_rad))
        elif isinstance(step, Arc):
            here = here.compose(_arc_end(step))
        elif not isinstance(step, (Wait, Say, Remember)):
            return None  # how far it goes is not told
    return here


def _one_by_one(steps: Iterable[Step]) -> Iterable[Step]:
    for step in steps:
        if isinstance(step, Repeat):
            for _ in range(step.count):
                yield from _one_by_one(step.steps)
        else:
            yield step


def _in_frame(pose: Pose, frame: str, start: Pose) -> Pose:
    return start.compose(pose) if frame == "start" else pose


def _arc_end(step: Arc) -> Pose:
    """From its start; the centre is to the side that it bends to."""
    side = 1.0 if step.left else -1.0
    turned_rad = step.angle_rad * (-side if step.backward else side)
    radius_m = step.radius_m * side
    return Pose(radius_m * math.sin(turned_rad), radius_m * (1.0 - math.cos(turned_rad)), turned_rad)
