"""Planar geometry, in the conventions of REP-103 and REP-105, stated once for the whole project.

Metres, radians and seconds. x points forward, y to the left, yaw grows counter-clockwise. Velocities are in the
robot's own frame (`base_link`), poses in the frame odometry began in (`odom`), whose origin is where the robot
stood, looking along +x, when odometry started.
"""

from __future__ import annotations

import math
from typing import NamedTuple


def wrap_angle(angle_rad: float) -> float:
    """The same heading in (-pi, pi]."""
    wrapped = math.fmod(angle_rad + math.pi, 2.0 * math.pi)
    return wrapped + math.pi if wrapped <= 0.0 else wrapped - math.pi


class Twist(NamedTuple):
    """A planar velocity in the robot's frame: m/s forward, m/s to the left, rad/s counter-clockwise."""

    vx_mps: float = 0.0
    vy_mps: float = 0.0
    wz_radps: float = 0.0

    @property
    def speed_mps(self) -> float:
        """Linear speed, whatever its direction."""
        return math.hypot(self.vx_mps, self.vy_mps)

    @property
    def is_zero(self) -> bool:
        """Exactly zero, in all three."""
        return self.vx_mps == 0.0 and self.vy_mps == 0.0 and self.wz_radps == 0.0

    @property
    def is_finite(self) -> bool:
        """No part of it is NaN or infinite."""
        return math.isfinite(self.vx_mps) and math.isfinite(self.vy_mps) and math.isfinite(self.wz_radps)

    def scaled(self, factor: float) -> Twist:
        """Scale all three by one dimensionless factor: the path stays."""
        return Twist(self.vx_mps * factor, self.vy_mps * factor, self.wz_radps * factor)


ZERO_TWIST = Twist()


class Pose(NamedTuple):
    """A position and heading in the plane. `yaw_rad` is not wrapped: two full turns left are 4 pi."""

    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0

    def compose(self, other: Pose) -> Pose:
        """`other`, given in this pose's frame, expressed in the frame this pose is given in."""
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return Pose(
            self.x_m + cos * other.x_m - sin * other.y_m,
            self.y_m + sin * other.x_m + cos * other.y_m,
            self.yaw_rad + other.yaw_rad,
        )

    def relative_to(self, origin: Pose) -> Pose:
        """This pose as seen from `origin` (the inverse of `origin.compose`)."""
        dx, dy = self.x_m - origin.x_m, self.y_m - origin.y_m
        cos, sin = math.cos(origin.yaw_rad), math.sin(origin.yaw_rad)
        return Pose(cos * dx + sin * dy, -sin * dx + cos * dy, self.yaw_rad - origin.yaw_rad)

    def moved(self, twist: Twist, duration_s: float) -> Pose:
        """Return where a constant `twist` leads in `duration_s`: the exact screw motion, not an Euler step."""
        return self.compose(displacement(twist, duration_s))

    def distance_to(self, other: Pose) -> float:
        """Metres between the two positions."""
        return math.hypot(other.x_m - self.x_m, other.y_m - self.y_m)

    def bearing_to(self, other: Pose) -> float:
        """The heading, in this pose's parent frame, that looks from here to `other`, in (-pi, pi]."""
        return math.atan2(other.y_m - self.y_m, other.x_m - self.x_m)


ORIGIN = Pose()


def displacement(twist: Twist, duration_s: float) -> Pose:
    """The pose reached from the origin by a constant twist: the exponential map of SE(2).

    Source: Lynch and Park, Modern Robotics (2017), section 3.3; the series for small angles avoids 0/0.
    """
    angle = twist.wz_radps * duration_s
    if abs(angle) < 1e-6:
        sin_over, cos_over = 1.0 - angle * angle / 6.0, angle / 2.0
    else:
        sin_over, cos_over = math.sin(angle) / angle, (1.0 - math.cos(angle)) / angle
    dx, dy = twist.vx_mps * duration_s, twist.vy_mps * duration_s
    return Pose(sin_over * dx - cos_over * dy, cos_over * dx + sin_over * dy, angle)
