"""The true poses of a simulated robot, and what they show in numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

MOVING_MPS = 0.01
MOVING_RADPS = 0.02
"""Slower than this is standing: well below the slowest thing anybody asks for, well above rounding."""
PAUSE_S = 0.1
"""A robot comes to rest for a moment between two steps; only what lasts longer is a pause."""
TREMBLE_M = 0.005
TREMBLE_RAD = math.radians(0.5)
"""What a robot that "does not move at all" may still move by."""


class Sample(NamedTuple):
    """One true pose, in the frame of the start, and velocity, in the robot's own. Yaw is not wrapped."""

    t_s: float
    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    wz_radps: float

    @property
    def is_moving(self) -> bool:
        """It does not stand."""
        return self.speed_mps > MOVING_MPS or abs(self.wz_radps) > MOVING_RADPS

    @property
    def speed_mps(self) -> float:
        """Of the translation."""
        return math.hypot(self.vx_mps, self.vy_mps)


@dataclass(frozen=True)
class Measured:
    """A whole trace in numbers, named as the format names them: metres, degrees, seconds, m/s, rad/s.

    `rotation_deg` counts turns to either side as positive.
    """

    x: float = 0.0
    y: float = 0.0
    turned_deg: float = 0.0
    rotation_deg: float = 0.0
    path_m: float = 0.0
    duration_s: float = 0.0
    pause_s: float = 0.0
    max_speed: float = 0.0
    max_turn_rate: float = 0.0
    farthest_m: float = 0.0
    has_moved: bool = False

    @property
    def yaw_deg(self) -> float:
        """The final heading, in (-180, 180]."""
        return 180.0 - (180.0 - self.turned_deg) % 360.0

    @property
    def distance_m(self) -> float:
        """From the start to the end."""
        return math.hypot(self.x, self.y)


def measure(trace: Sequence[Sample]) -> Measured:
    """Return the numbers of a trace that begins at the origin."""
    if not trace:
        return Measured()
    end = trace[-1]
    farthest_m = max(math.hypot(sample.x_m, sample.y_m) for sample in trace)
    duration_s, pause_s = _times(trace)
    return Measured(
        x=end.x_m,
        y=end.y_m,
        turned_deg=math.degrees(end.yaw_rad),
        rotation_deg=math.degrees(sum(abs(b.yaw_rad - a.yaw_rad) for a, b in itertools.pairwise(trace))),
        path_m=sum(math.hypot(b.x_m - a.x_m, b.y_m - a.y_m) for a, b in itertools.pairwise(trace)),
        duration_s=duration_s,
        pause_s=pause_s,
        max_speed=max(sample.speed_mps for sample in trace),
        max_turn_rate=max(abs(sample.wz_radps) for sample in trace),
        farthest_m=farthest_m,
        has_moved=has_moved(trace),
    )


def has_moved(trace: Sequence[Sample]) -> bool:
    """Tell whether the robot left the pose in which the trace begins, be it for a moment."""
    if not trace:
        return False
    start = trace[0]
    return any(
        math.hypot(sample.x_m - start.x_m, sample.y_m - start.y_m) > TREMBLE_M
        or abs(sample.yaw_rad - start.yaw_rad) > TREMBLE_RAD
        for sample in trace
    )


def _times(trace: Sequence[Sample]) -> tuple[float, float]:
    """(seconds in motion, seconds standing between motions). A rest shorter than `PAUSE_S` counts as motion."""
    motion_s = pause_s = rest_s = 0.0
    for before, after in itertools.pairwise(trace):
        step_s = after.t_s - before.t_s
        if not after.is_moving:
            rest_s += step_s
            continue
        if motion_s > 0.0:  # a rest before the first motion is no pause
            if rest_s >= PAUSE_S:
                pause_s += rest_s
            else:
                motion_s += rest_s
        motion_s += step_s
        rest_s = 0.0
    return motion_s, pause_s
