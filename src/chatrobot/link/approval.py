"""A person's yes binds one plan, from one pose, for a short while."""

from __future__ import annotations

import math
from dataclasses import dataclass

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason

LAPSES_AFTER_S = 30.0
LAPSES_AFTER_M = 0.05
LAPSES_AFTER_RAD = math.radians(5.0)
"""Over a metre it is the same as 9 cm aside; a gyro at rest drifts far less."""


@dataclass(frozen=True)
class Approval:
    """What a yes would be good for."""

    asked_s: float
    start: Pose

    def lapsed(self, now_s: float, pose: Pose) -> Reason | None:
        """Why a yes is worth nothing any more, or None."""
        if now_s - self.asked_s > LAPSES_AFTER_S:
            return Reason("approval_too_late", {"limit_s": LAPSES_AFTER_S})
        if pose.distance_to(self.start) > LAPSES_AFTER_M:
            return Reason("approval_robot_moved", {"limit_m": LAPSES_AFTER_M})
        if abs(pose.yaw_rad - self.start.yaw_rad) > LAPSES_AFTER_RAD:
            return Reason("approval_robot_moved", {"limit_deg": round(math.degrees(LAPSES_AFTER_RAD))})
        return None
