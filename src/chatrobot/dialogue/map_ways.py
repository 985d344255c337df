"""How long the way between two poses is on the map: for answers, not for driving.

What only the lidar has seen is known to Motion alone: a way that is blocked by it is longer than the answer says.
"""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import TYPE_CHECKING

from chatrobot.core.geometry import Pose
from chatrobot.plan.context import Route
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.world import World

if TYPE_CHECKING:
    from chatrobot.plan.context import RoutePlanner


class MapWays:
    """Ways of one robot in one world. numpy is loaded with the first question, not with the console."""

    def __init__(self, world: World, profile: RobotProfile) -> None:
        self._world = world
        self._profile = profile

    @cached_property
    def _planner(self) -> RoutePlanner:
        from chatrobot.plan.route import GridRoutePlanner

        return GridRoutePlanner(self._world, self._profile)

    def __call__(self, start: Pose, goal: Pose) -> float | None:
        """Metres; None where there is no free way."""
        way = self._planner.route(start, (goal.x_m, goal.y_m), named_place=True)
        if not isinstance(way, Route):
            return None
        points = [(start.x_m, start.y_m), *way.waypoints]
        return sum(math.dist(one, other) for one, other in itertools.pairwise(points))
