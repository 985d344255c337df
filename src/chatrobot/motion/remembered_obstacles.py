"""Obstacles that the lidar has seen, for rehearsals and routes: measured with the governor's own footprint and margin.

A plan that passes here keeps every seen point at the distance that the governor demands along the whole path.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.governor.contact import Floats, Footprint
from chatrobot.governor.obstacle_memory import LidarView, ObstacleMemory
from chatrobot.governor.rule import NOTHING_SENSED, Sensed, Situation
from chatrobot.governor.space_rules import MARGIN_M, NEARER_M, BlindRule
from chatrobot.plan import rehearsal
from chatrobot.plan.context import NoRoute, Route, RoutePlanner
from chatrobot.plan.known_world import Contact
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.robots.profile import Lidar, Point, RobotProfile
from chatrobot.sim.shapes import Circle, Polygon
from chatrobot.sim.world import Bounds, Obstacle, World

APART_M = 0.01
"""Poses of a path that are nearer to each other than this are looked at once."""

APART_IN_WORLD_M = 0.02
"""As near to each other as obstacles are that stand for seen points."""

CHUNK = 200
POINT_RADIUS_M = 0.03
"""What was seen is at least so large: the gaps between beams are nothing to drive through."""


TOUCHES_M = 0.02
"""A point that is no farther from the footprint than this may be of what the robot stands at."""


class Sight:
    """Tells how much the governor allows where the lidar does not see, by its own rule.

    Args:
        look: where the lidar looked last; None where it shows nothing, not even that nothing is there.
    """

    def __init__(self, profile: RobotProfile, lidar: Lidar, look: LidarView | None) -> None:
        self._mounting = Pose(lidar.x_m, lidar.y_m, lidar.yaw_rad)
        self._look = look
        self._seen = ObstacleMemory(lidar)
        # All around: what it comes by has been seen before.
        self._seen.coverage.note(LidarView(ORIGIN, 0.0, math.tau, 1))
        self._rule = BlindRule(profile, self._seen)

    def allowed_share(self, twist: Twist, pose: Pose) -> float:
        """Return the share of a twist that is allowed at that pose, from where the lidar looks as it does now."""
        sensed = NOTHING_SENSED
        if self._look is not None:
            self._seen.coverage.latest = replace(self._look, lidar=pose.compose(self._mounting))
            sensed = Sensed({"scan": 0.0})
        return self._rule.judge(twist, Situation(pose, sensed)).factor


class RememberedObstacles:
    """Points [n, 2] in odom, as they were at one moment, and how the lidar looked. Implements `SeenWorld`.

    Args:
        sight: None where the lidar looks all around.
    """

    def __init__(self, profile: RobotProfile, points: Floats, sight: Sight | None = None) -> None:
        self._sight = sight
        self._footprint = Footprint(profile.footprint)
        self._corners = np.array(profile.footprint)
        self.points = points

    def allowed_share(self, twist: Twist, pose: Pose) -> float:
        """Return how much the governor will allow of a twist at that pose."""
        return self._sight.allowed_share(twist, pose) if self._sight is not None else 1.0

    def free_ahead_m(self, pose: Pose, direction_rad: float) -> float:
        """Return how far the strip that the footprint sweeps straight on is free; infinite where nothing was seen."""
        forward = np.array([math.cos(direction_rad), math.sin(direction_rad)])
        front_m = (self._corners @ forward).max()
        sides_m = self._corners @ np.array([-forward[1], forward[0]])
        heading_rad = pose.yaw_rad + direction_rad
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        x, y = self.points[:, 0] - pose.x_m, self.points[:, 1] - pose.y_m
        ahead_m, side_m = cos * x + sin * y - front_m, cos * y - sin * x
        inside = (side_m > sides_m.min() - POINT_RADIUS_M) & (side_m < sides_m.max() + POINT_RADIUS_M)
        return float(ahead_m[inside & (ahead_m > 0.0)].min(initial=math.inf))

    def first_contact(self, poses: Floats) -> Contact | None:
        """Return the first of [n, 3] poses along a path that comes nearer to a seen point than is allowed.

        Where the robot is nearer than the margin of a rehearsal already, the governor's own counts; where it is in
        contact, it may come no nearer than it was.
        """
        rows = _apart(poses, self._footprint.radius_m)
        most_m = -math.inf
        for begin in range(0, len(rows), CHUNK):
            chunk = rows[begin : begin + CHUNK]
            near = self.points[self._near(poses[chunk])]
            clearance = self._clearance_m(poses[chunk], near)
            least = clearance.min(axis=1, initial=math.inf)
            most = np.maximum(np.maximum.accumulate(least), most_m)
            most_m = float(most[-1])
            hits = np.flatnonzero(least < _needed_m(most))
            if len(hits):
                x_m, y_m = near[int(clearance[hits[0]].argmin())]
                return Contact(int(chunk[hits[0]]), float(x_m), float(y_m))
        return None

    def clear_of(self, pose: Pose) -> Floats:
        """Return the points [n, 2] that a robot at `pose` does not touch."""
        clearance = self._clearance_m(np.array([pose]), self.points)[0]
        return np.asarray(self.points[clearance > TOUCHES_M])

    def _near(self, poses: Floats) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
        """The points that the footprint may come near to on these poses."""
        reach_m = self._footprint.radius_m + 2.0 * rehearsal.MARGIN_M
        low, high = poses[:, :2].min(axis=0) - reach_m, poses[:, :2].max(axis=0) + reach_m
        return np.flatnonzero(((self.points >= low) & (self.points <= high)).all(axis=1))

    def _clearance_m(self, poses: Floats, points: Floats) -> Floats:
        """[poses, points]: of each point from the footprint at each pose."""
        cos, sin = np.cos(poses[:, 2:3]), np.sin(poses[:, 2:3])
        x, y = points[:, 0] - poses[:, 0:1], points[:, 1] - poses[:, 1:2]
        return self._footprint.clearance_m(cos * x + sin * y, cos * y - sin * x)


def _needed_m(most: Floats) -> Floats:
    """What a robot has to keep that has been so far from everything, at most, since the path began."""
    in_contact = np.where(most <= MARGIN_M, most - NEARER_M, MARGIN_M)
    return np.where(most <= rehearsal.MARGIN_M, in_contact, rehearsal.MARGIN_M)


def _apart(poses: Floats, radius_m: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """The rows where some point of the footprint has moved `APART_M` since the row before them, and the last."""
    moved = np.hypot(*np.diff(poses[:, :2], axis=0).T) + radius_m * np.abs(np.diff(poses[:, 2]))
    square = np.floor(np.append(0.0, np.cumsum(moved)) / APART_M)
    return np.unique(np.append(np.flatnonzero(np.diff(square, prepend=-1.0)), len(poses) - 1))


def with_seen(world: World, points: Floats) -> World:
    """Return the world with small obstacles where points [n, 2] were seen that it does not know."""
    unknown = seen_but_unknown(world, points)
    cells = np.unique(np.rint(unknown / APART_IN_WORLD_M), axis=0) * APART_IN_WORLD_M
    added = (Obstacle("", Circle(x, y, TOUCHES_M / 2.0)) for x, y in cells.tolist())
    return replace(world, obstacles=(*world.obstacles, *added)) if len(cells) else world


def seen_but_unknown(world: World, points: Floats) -> Floats:
    """Return those of the seen points [n, 2] that are no obstacle of the map."""
    if world.is_empty or not len(points):
        return points
    return points[world.clearance_m(points) >= rehearsal.KNOWN_WITHIN_M]


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
        return np.asarray(self.clearance_m[np.clip(i, 0, ny - 1), np.clip(j, 0, nx - 1)])


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

    def obstacle_names_at(self, x_m: float, y_m: float) -> tuple[str, ...]:
        here = np.array([[x_m, y_m]])
        if self._world.is_empty or self._field.at(here)[0] < self._world.clearance_m(here)[0]:
            return ()
        return self._world.obstacle_names_at(x_m, y_m)


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
        """Return the way to `goal` (odom frame), or why there is none."""
        if self._around is None:
            self._around = GridRoutePlanner(_KnownAndSeen(self._world, self._unknown), self._profile)
        found = self._around.route(start, goal, named_place=named_place)
        if isinstance(found, Route) or found.reason.code != "no_route":
            return found
        return self._known.route(start, goal, named_place=named_place) if self._known else Route((goal,))
