"""`Face the kitchen`, `turn towards the TV`, 面向沙发: the heading from where the robot stands by then to a place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import rounded_angle
from chatrobot.plan.ring import middle_of
from chatrobot.plan.steps import Arc, Drive, Face, Go, Remember, Repeat, Say, Step, Turn, Wait

_LEAST_M = 0.1
"""Of a place that is nearer nobody can tell on which side it is."""


def facing(place: Go, before: Sequence[Step], context: Context) -> Face:
    """The heading (odom frame) to what the map has at `place`, else to the place, after the steps `before`.

    Raises:
        Unclear: where nobody knows where the robot stands by then, or it stands at the place.
    """
    pose = context.state.pose
    here = _after(pose, before, pose, place.place)
    ring = list(context.rings(Pose(place.x_m, place.y_m))) if context.rings is not None else []
    x_m, y_m = middle_of(ring) if ring else (place.x_m, place.y_m)
    if math.dist((here.x_m, here.y_m), (x_m, y_m)) < _LEAST_M:
        raise Unclear("unclear_motion", place.place)
    return Face(rounded_angle(math.atan2(y_m - here.y_m, x_m - here.x_m), 2), "odom")


def _after(here: Pose, steps: Iterable[Step], start: Pose, name: str) -> Pose:
    for step in steps:
        if isinstance(step, Repeat):
            for _ in range(step.count):
                here = _after(here, step.steps, start, name)
        elif isinstance(step, Go):
            here = _in_frame(Pose(step.x_m, step.y_m, step.yaw_rad or 0.0), step.frame, start)
        elif isinstance(step, Face):
            yaw_rad = _in_frame(Pose(0.0, 0.0, step.yaw_rad), step.frame, start).yaw_rad
            here = Pose(here.x_m, here.y_m, yaw_rad)
        elif isinstance(step, Drive) and step.distance_m is not None and step.until is None:
            along, across = math.cos(step.direction_rad), math.sin(step.direction_rad)
            here = here.compose(Pose(step.distance_m * along, step.distance_m * across))
        elif isinstance(step, Turn) and step.angle_rad is not None:
            here = here.compose(Pose(0.0, 0.0, step.angle_rad if step.left else -step.angle_rad))
        elif isinstance(step, Arc):
            here = here.compose(_arc_end(step))
        elif not isinstance(step, (Wait, Say, Remember)):
            raise Unclear("unclear_motion", name)  # how far it goes is not told
    return here


def _in_frame(pose: Pose, frame: str, start: Pose) -> Pose:
    return start.compose(pose) if frame == "start" else pose


def _arc_end(step: Arc) -> Pose:
    """From its start; the centre is to the side that it bends to."""
    side = 1.0 if step.left else -1.0
    turned = step.angle_rad * (-side if step.backward else side)
    radius_m = step.radius_m * side
    return Pose(radius_m * math.sin(turned), radius_m * (1.0 - math.cos(turned)), turned)
