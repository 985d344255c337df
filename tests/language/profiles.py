"""The robot of FORMAT.md, for tests that need no profile file."""

from __future__ import annotations

import math

from chatrobot.robots.profile import Defaults, Limits, RobotProfile

MECANUM = RobotProfile(
    name="test_mecanum",
    title="Mecanum test robot",
    kinematics="mecanum",
    limits=Limits(1.0, 1.0, 2.0, 1.0, 2.0, 1.0, 0.05),
    defaults=Defaults(0.3, 0.6, 0.5, math.pi / 2),
    footprint=((0.15, 0.12), (-0.15, 0.12), (-0.15, -0.12), (0.15, -0.12)),
)
