"""Where its lidar does not look, a robot that has one goes at the profile's blind speed, or not at all."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.governor.rule import FREE, Ruling, Situation
from chatrobot.governor.seen import Seen
from chatrobot.governor.sensors_due import silent_after_s
from chatrobot.robots.profile import Point, RobotProfile

LOOK_AHEAD_S = 0.5
LOOK_AHEAD_M = 0.2
"""How far before the moving parts of the outline the lidar has to look: this long at their speed, and at least this."""

OUTWARDS_MPS = 0.02
"""A side that moves outwards slower than this hardly does: feedback swings the tail a little on any straight way."""


class BlindRule:
    """Slows a twist whose way lies, even in part, in a sector without beams, or whose lidar has fallen silent."""

    name = "blind"

    def __init__(self, profile: RobotProfile, seen: Seen) -> None:
        self._speed_mps = profile.safety.blind_speed_mps
        self._outline = _outline(profile.footprint)
        self._radius_m = profile.footprint_radius_m
        self._silent_s = silent_after_s(profile, "scan")
        self._seen = seen

    def judge(self, asked: Twist, situation: Situation) -> Ruling:
        fastest_mps = asked.speed_mps + abs(asked.wz_radps) * self._radius_m
        if fastest_mps <= self._speed_mps:
            return FREE
        # A scan says nothing without the pose it was made at.
        is_fresh = situation.sensed.ages_s.get("scan", math.inf) <= self._silent_s
        if is_fresh and situation.pose is not None and (self._seen.covers_all or self._is_seen(asked)):
            return FREE
        return Ruling(self._speed_mps / fastest_mps, Reason("not_seen", {"speed_mps": self._speed_mps}))

    def _is_seen(self, asked: Twist) -> bool:
        """Whether the lidar looks at the floor before every corner and every side that moves outwards."""
        lidar = self._seen.lidar
        for (x, y), (out_x, out_y) in self._outline:
            vx, vy = asked.vx_mps - asked.wz_radps * y, asked.vy_mps + asked.wz_radps * x
            if vx * out_x + vy * out_y <= OUTWARDS_MPS:
                continue
            ahead_s = max(LOOK_AHEAD_S, LOOK_AHEAD_M / math.hypot(vx, vy))
            bearing = math.atan2(y + vy * ahead_s - lidar.y_m, x + vx * ahead_s - lidar.x_m)
            if not self._seen.covers(bearing):
                return False
        return True


def _outline(corners: Sequence[Point]) -> list[tuple[Point, Point]]:
    """Of every side its ends and its middle, each with the side's normal (of length 1) that looks outwards."""
    found = []
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]]):
        length = math.hypot(bx - ax, by - ay)
        normal = ((by - ay) / length, (ax - bx) / length)
        found += [(point, normal) for point in ((ax, ay), ((ax + bx) / 2.0, (ay + by) / 2.0), (bx, by))]
    return found
