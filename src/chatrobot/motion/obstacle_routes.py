"""Routes around what the lidar has seen and the map does not know, besides what it knows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from chatrobot.core.geometry import Pose
from chatrobot.motion.remembered_obstacles import POINT_RADIUS_M
from chatrobot.plan.context import NoRoute, Route, RoutePlanner
from chatrobot.plan.known_world import Floats
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.robots.profile import Point, RobotProfile
from chatrobot.sim.shapes import Polygon
from chatrobot.sim.world import Bounds, World

CELL_M = 0.02
MOST_CELLS = 2_000_000
ENOUGH_M = 0.8
"""More clearance than this is worth nothing to a route."""


@dataclass(frozen=True)
class _Field:
    """How far it is to the nearest seen point, at most `ENOUGH_M`, on a grid [ny, nx] that reaches beyond all."""

    low: Floats
    cell_m: float
    clearance_m: Floats

    @classmethod
    def of(cls, points: Floats) -> _Field:
        low, high = points.min(axis=0) - 2.0 * ENOUGH_M, points.max(axis=0) + 2.0 * ENOUGH_M
        cell_m = max(CELL_M, math.sqrt(float(np.prod(high - low)) / MOST_CELLS))
        nx, ny = (math.ceil(extent_m / cell_m) + 1 for extent_m in (high - low).tolist())
        # A seen point, and a place that is asked about, are each at most half a cell's diagonal from their cells.
        less_m = math.sqrt(2.0) * cell_m + POINT_RADIUS_M
        reach = math.ceil((ENOUGH_M + less_m) / cell_m)
        around = cell_m * np.arange(-reach, reach + 1)
        disc = np.hypot(around[:, None], around[None, :]) - less_m
        field = np.full((ny, nx), ENOUGH_M)
        cells = np.unique(np.rint((points - low) / cell_m).astype(np.intp), axis=0)
        for j, i in cells.tolist():
            window = field[i - reach : i + reach + 1, j - reach : j + reach + 1]
            np.minimum(window, disc, out=window)
        return cls(low, cell_m, field)

    def at(self, points: Floats) -> Floats:
        """Of points [n, 2]: [n]."""
        ny, nx = self.clearance_m.shape
        j, i = np.rint((points - self.low) / self.cell_m).astype(np.intp).T
        # Whatever lies outside the grid is farther from all points than its edge.
        found: Floats = self.clearance_m[np.clip(i, 0, ny - 1), np.clip(j, 0, nx - 1)]
        return found


class _KnownAndSeen:
    """The map together with seen points that it does not know. Implements `KnownWorld`."""

    is_empty = False

    def __init__(self, world: World, points: Floats) -> None:
        self._world = world
        self._points = points
        self._field = _Field.of(points)

    @property
    def allowed_area(self) -> Polygon | None:
        return self._world.allowed_area

    @property
    def bounds(self) -> Bounds:
        low, high = self._points.min(axis=0), self._points.max(axis=0)
        known = self._world.bounds
        if known is not None:
            low = np.minimum(low, (known.min_x_m, known.min_y_m))
            high = np.maximum(high, (known.max_x_m, known.max_y_m))
        return Bounds(float(low[0]), float(low[1]), float(high[0]), float(high[1]))

    def clearance_m(self, points: Floats) -> Floats:
        seen = self._field.at(points)
        return seen if self._world.is_empty else np.minimum(seen, self._world.clearance_m(points))

    def obstacle_name_at(self, x_m: float, y_m: float) -> str:
        here = np.array([[x_m, y_m]])
        if self._world.is_empty or self._field.at(here)[0] < self._world.clearance_m(here)[0]:
            return ""
        return self._world.obstacle_name_at(x_m, y_m)


class RoutesAroundObstacles:
    """Plans in the world of one moment for one robot. Implements `RoutePlanner`.

    Where what was seen leaves no way it plans by the map alone: the rehearsal then says what is in that way.

    Args:
        unknown: what was seen and is not in the world; at least one point [n, 2].
        known: plans by the map alone; None where nothing is known.
    """

    def __init__(
        self, profile: RobotProfile, world: World, unknown: Floats, known: RoutePlanner | None
    ) -> None:
        self._profile = profile
        self._world = world
        self._unknown = unknown
        self._known = known
        self._around: GridRoutePlanner | None = None

    def route(self, start: Pose, goal: Point, *, named_place: bool) -> Route | NoRoute:
        if self._around is None:
            self._around = GridRoutePlanner(_KnownAndSeen(self._world, self._unknown), self._profile)
        found = self._around.route(start, goal, named_place=named_place)
        if isinstance(found, Route) or found.reason.code != "no_route":
            return found
        return self._known.route(start, goal, named_place=named_place) if self._known else Route((goal,))
