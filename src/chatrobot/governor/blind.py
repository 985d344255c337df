"""Where its lidar does not look, a robot that has one goes at the profile's blind speed, or not at all."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.governor.sensors_due import silent_after_s
from chatrobot.robots.profile import Point, RobotProfile

LOOK_AHEAD_S = 0.5
LOOK_AHEAD_M = 0.2
"""How far before the moving parts of the outline the lidar has to look: this long at their speed, and at least this."""

SHARES = np.linspace(0.2, 1.0, 5)
"""Of the way there, where it must have looked: what swings out may come by what was never seen."""

OUTWARDS_MPS = 0.02
OUTWARDS_M = 0.03
"""A side that comes out slower, or less far, needs no look: feedback swings the tail a little on any straight way."""


class BlindRule:
    """Slows a twist whose way lies, even in part, in a sector without beams, or whose lidar has fallen silent."""

    name = "blind"

    def __init__(self, profile: RobotProfile, seen: ObstacleMemory) -> None:
        self._speed_mps = profile.safety.blind_speed_mps
        points, normals = zip(*_outline(profile.footprint))
        self._x, self._y = np.array(points).T
        self._out_x, self._out_y = np.array(normals).T
        self._radius_m = profile.footprint_radius_m
        self._silent_s = silent_after_s(profile, "scan")
        self._obstacle_memory = seen

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        fastest_mps = asked.speed_mps + abs(asked.wz_radps) * self._radius_m
        if fastest_mps <= self._speed_mps:
            return FREE
        # A scan says nothing without the pose it was made at.
        is_fresh = situation.sensed.ages_s.get("scan", math.inf) <= self._silent_s
        if is_fresh and situation.pose is not None and self._is_seen(asked, situation.pose):
            return FREE
        return Ruling(self._speed_mps / fastest_mps, Reason("not_seen", {"speed_mps": self._speed_mps}))

    def _is_seen(self, asked: Twist, pose: Pose) -> bool:
        """Whether the lidar looks at the floor before every corner and every side that moves outwards.

        Where it leads to it must look now; at what lies before that it may have looked a moment ago.
        """
        coverage = self._obstacle_memory.coverage
        if coverage.latest is not None and coverage.latest.is_all_around:
            return True
        vx, vy = asked.vx_mps - asked.wz_radps * self._y, asked.vy_mps + asked.wz_radps * self._x
        out_mps = vx * self._out_x + vy * self._out_y
        moves = out_mps > OUTWARDS_MPS
        ahead_s = np.maximum(LOOK_AHEAD_S, LOOK_AHEAD_M / np.hypot(vx, vy)[moves])
        in_s = ahead_s[:, None] * SHARES
        x, y = self._x[moves, None] + vx[moves, None] * in_s, self._y[moves, None] + vy[moves, None] * in_s
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        ways = np.stack([pose.x_m + cos * x - sin * y, pose.y_m + sin * x + cos * y], axis=-1)
        comes_out = out_mps[moves, None] * in_s > OUTWARDS_M
        ends, before = ways[:, -1][comes_out[:, -1]], ways[:, :-1][comes_out[:, :-1]]
        return bool(coverage.covers_now(ends).all() and coverage.covered_lately(before).all())


def _outline(corners: Sequence[Point]) -> list[tuple[Point, Point]]:
    """Of every side its ends and its middle, each with the side's normal (of length 1) that looks outwards."""
    found = []
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]]):
        length = math.hypot(bx - ax, by - ay)
        normal = ((by - ay) / length, (ax - bx) / length)
        found += [(point, normal) for point in ((ax, ay), ((ax + bx) / 2.0, (ay + by) / 2.0), (bx, by))]
    return found
