"""A way around what is known: grid search where the robot's circle fits, then as few straight legs as it allows.

The search is A* (Hart, Nilsson and Raphael, 1968) on cells of the clearance map, eight neighbours each. A step costs
more the nearer it passes to something, so that the way goes through the middle of doors; legs are then pulled
straight wherever that comes no nearer to anything than the way did.
"""

from __future__ import annotations

import heapq
import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.plan.context import NoRoute, Route
from chatrobot.plan.known_world import Floats, KnownWorld, obstacle_values
from chatrobot.robots.profile import Point, RobotProfile

RESOLUTION_M = 0.05
MAX_CELLS = 250_000
BORDER_M = 1.0
"""How far beyond everything known, and beyond start and goal, a way may lead."""

MARGIN_M = 0.05
COMFORT_M = 0.3
"""Clearance beyond the robot's own circle above which more of it is worth nothing."""

CLOSE_COST = 3.0
"""Dimensionless: a cell at the very edge of fitting costs this much more than one with comfort."""

AT_PLACE_M = 0.1
"""So far from a named place a robot still is there."""

TIGHT_END_M = 0.6
"""How far from start and goal their own tightness is excused."""

NEAREST_WITHIN_M = 2.0
"""A free point that is farther from a blocked goal than this is not worth a question."""

OWN_SIDE = 0.05
"""A metre on the way from the start counts as so many metres from the goal."""

LEG_SPACING_M = 0.025
MAX_ANSWERS = 256


@dataclass(frozen=True)
class _Grid:
    """Clearance [ny, nx] at cell (i, j), which is the point (x0 + j * size, y0 + i * size)."""

    x0_m: float
    y0_m: float
    size_m: float
    clearance_m: Floats

    def cell(self, x_m: float, y_m: float) -> tuple[int, int]:
        ny, nx = self.clearance_m.shape
        j = min(nx - 1, max(0, round((x_m - self.x0_m) / self.size_m)))
        i = min(ny - 1, max(0, round((y_m - self.y0_m) / self.size_m)))
        return i, j

    def point(self, i: int, j: int) -> Point:
        return self.x0_m + j * self.size_m, self.y0_m + i * self.size_m

    def distance_to(self, x_m: float, y_m: float) -> Floats:
        """Return metres from every cell to a point, [ny, nx]."""
        ny, nx = self.clearance_m.shape
        dx = self.x0_m + self.size_m * np.arange(nx) - x_m
        dy = self.y0_m + self.size_m * np.arange(ny) - y_m
        distance: Floats = np.hypot(dx[None, :], dy[:, None])
        return distance


class GridRoutePlanner:
    """Plans in one world for one robot.

    Args:
        world: what is known.
        profile: whose footprint has to fit. Its whole circle does, so that the robot can turn anywhere on its way.
        before: plans in the world before something was put there, and so knows what stands where there was a way.
    """

    def __init__(
        self, world: KnownWorld, profile: RobotProfile, before: GridRoutePlanner | None = None
    ) -> None:
        self._world, self._before = world, before
        self._needed_m = profile.footprint_radius_m + MARGIN_M
        self._inner_m = _inscribed_radius(profile.footprint)
        self._grids: dict[tuple[int, int, int, int], _Grid] = {}
        self._answers: dict[tuple[Pose, Point, bool], Route | NoRoute] = {}

    def route(self, start: Pose, goal: Point, *, named_place: bool) -> Route | NoRoute:
        """Return waypoints from `start` to `goal`, both in the odom frame.

        At a named place that is a little too tight, the route ends at the free point within 0.1 m. Otherwise
        `target_blocked` or `no_route` is the answer. Answers are remembered: what rehearsal asked, the executor gets
        without a search.
        """
        question = (start, goal, named_place)
        if question not in self._answers:
            if len(self._answers) >= MAX_ANSWERS:
                self._answers.clear()
            self._answers[question] = self._find(start, goal, named_place)
        return self._answers[question]

    def _find(self, start: Pose, goal: Point, named_place: bool) -> Route | NoRoute:
        if self._world.is_empty:
            return Route((goal,))
        goal_m = self._clearance_at(goal)
        is_tight = goal_m < (self._needed_m if named_place else self._inner_m)
        if not is_tight and self._leg_fits((start.x_m, start.y_m), goal):
            return Route((goal,))
        if not self._is_searchable(start, goal):
            return NoRoute(Reason("no_route", {"distance_m": _length((start.x_m, start.y_m), goal)}))
        grid = self._grid(start, goal)
        if is_tight:
            free = self._nearest_free(grid, goal, start)
            if free is None or not named_place or _length(free, goal) > AT_PLACE_M:
                is_reached = free is not None and self._search(grid, start, free) is not None
                return self._blocked(goal, goal_m, free if is_reached else None)
            goal = free
        cells = self._search(grid, start, goal)
        if cells is None:
            distance_m = _length((start.x_m, start.y_m), goal)
            return NoRoute(Reason("no_route", {"distance_m": distance_m, **self._in_the_way(start, goal)}))
        points = [(start.x_m, start.y_m), *(grid.point(*cell) for cell in cells[1:-1]), goal]
        return Route(tuple(self._pulled_straight(points)[1:]))

    def _in_the_way(self, start: Pose, goal: Point) -> dict[str, str]:
        """What was put where there was a way before."""
        way = self._before.route(start, goal, named_place=True) if self._before is not None else None
        if not isinstance(way, Route) or self._before is None:
            return {}
        for leg in itertools.pairwise(((start.x_m, start.y_m), *way.waypoints)):
            points = _points(*leg)
            room_m, room_before_m = (
                world.clearance_m(points) for world in (self._world, self._before._world)
            )
            blocked = np.flatnonzero((room_m < self._needed_m) & (room_m < room_before_m))
            if len(blocked):
                return obstacle_values(self._world.obstacle_names_at(*points[blocked[0]].tolist()))
        return {}

    def _clearance_at(self, point: Point) -> float:
        return float(self._world.clearance_m(np.array([point]))[0])

    def _is_searchable(self, start: Pose, goal: Point) -> bool:
        """Return False where a grid over start and goal would have cells larger than the robot."""
        span_m = _length((start.x_m, start.y_m), goal) + 2.0 * BORDER_M
        return span_m * span_m / MAX_CELLS < self._needed_m**2 / 4.0

    def _grid(self, start: Pose, goal: Point) -> _Grid:
        """Over everything within a border of start, goal and what is known; kept for the next question."""
        low, high = self._extent
        box = (
            math.floor(min(low[0], start.x_m, goal[0]) - BORDER_M),
            math.floor(min(low[1], start.y_m, goal[1]) - BORDER_M),
            math.ceil(max(high[0], start.x_m, goal[0]) + BORDER_M),
            math.ceil(max(high[1], start.y_m, goal[1]) + BORDER_M),
        )
        if box not in self._grids:
            self._grids.clear()
            self._grids[box] = self._build(box)
        return self._grids[box]

    @cached_property
    def _extent(self) -> tuple[Point, Point]:
        bounds = self._world.bounds
        if bounds is None:
            return (math.inf, math.inf), (-math.inf, -math.inf)
        return (bounds.min_x_m, bounds.min_y_m), (bounds.max_x_m, bounds.max_y_m)

    def _build(self, box: tuple[int, int, int, int]) -> _Grid:
        x0, y0, x1, y1 = box
        size_m = max(RESOLUTION_M, math.sqrt((x1 - x0) * (y1 - y0) / MAX_CELLS))
        xs, ys = np.arange(x0, x1 + size_m, size_m), np.arange(y0, y1 + size_m, size_m)
        points = np.stack(np.meshgrid(xs, ys), axis=2)
        clearance = self._world.clearance_m(points.reshape(-1, 2)).reshape(len(ys), len(xs))
        return _Grid(float(x0), float(y0), size_m, clearance)

    def _blocked(self, goal: Point, goal_m: float, free: Point | None) -> NoRoute:
        """Say what stands at the goal, how much room there is, and the free point that is `short_m` from it."""
        values: dict[str, float | int | str] = {"clearance_m": max(0.0, goal_m), "needed_m": self._needed_m}
        values |= obstacle_values(self._world.obstacle_names_at(*goal))
        if free is not None:
            nearest = round(free[0], 2), round(free[1], 2)
            values |= {
                "short_m": _length(nearest, goal),
                "nearest_x_m": nearest[0],
                "nearest_y_m": nearest[1],
            }
        return NoRoute(Reason("target_blocked", values))

    def _nearest_free(self, grid: _Grid, goal: Point, start: Pose) -> Point | None:
        """The free point nearest to the goal; of those that are about as near, one on the robot's side."""
        away_m = grid.distance_to(*goal)
        cost = np.where(grid.clearance_m >= self._needed_m, away_m, np.inf)
        cost += OWN_SIDE * grid.distance_to(start.x_m, start.y_m)
        i, j = np.unravel_index(int(cost.argmin()), cost.shape)
        is_near = cost[i, j] < np.inf and away_m[i, j] <= NEAREST_WITHIN_M
        return grid.point(int(i), int(j)) if is_near else None

    def _search(self, grid: _Grid, start: Pose, goal: Point) -> list[tuple[int, int]] | None:
        """Cells from start to goal. Around both the robot may be as tight as it is there, but not tighter."""
        fits = grid.clearance_m >= self._needed_m
        for point in ((start.x_m, start.y_m), goal):
            tight_m = min(self._needed_m, self._clearance_at(point)) - 0.5 * grid.size_m
            fits |= (grid.distance_to(*point) <= TIGHT_END_M) & (grid.clearance_m >= tight_m)
        spare = np.clip((grid.clearance_m - self._needed_m) / COMFORT_M, 0.0, 1.0)
        cost = np.where(fits, 1.0 + CLOSE_COST * (1.0 - spare), np.inf)
        ends = [grid.cell(start.x_m, start.y_m), grid.cell(*goal)]
        for i, j in ends:
            cost[i, j] = min(cost[i, j], 1.0 + CLOSE_COST)
        return _a_star(cost, ends[0], ends[1])

    def _leg_fits(self, start: Point, end: Point, least_m: float | None = None) -> bool:
        """The robot's circle passes from `start` to `end` (near both, as tight as it is there)."""
        needed_m = self._needed_m if least_m is None else least_m
        along, clearance = self._along(start, end)
        first, last = clearance[0], clearance[-1]
        length = along[-1]
        needed = np.full(len(along), needed_m)
        needed[along <= TIGHT_END_M] = min(needed_m, first - 0.01)
        near_end = length - along <= TIGHT_END_M
        needed[near_end] = np.minimum(needed[near_end], min(needed_m, last - 0.01))
        return bool((clearance >= needed).all())

    def _along(self, start: Point, end: Point) -> tuple[Floats, Floats]:
        """Return distances from `start` and clearances, each [n], along a straight leg."""
        points = _points(start, end)
        along = np.linspace(0.0, _length(start, end), len(points))
        return along, self._world.clearance_m(points)

    def _pulled_straight(self, points: list[Point]) -> list[Point]:
        """From each point on to the farthest one that a leg reaches without coming nearer to anything."""
        clearance = self._world.clearance_m(np.array(points))
        comfort_m = self._needed_m + COMFORT_M
        pulled = [points[0]]
        at = 0
        while at < len(points) - 1:
            low, high = at + 1, len(points) - 1
            for candidate in _candidates(low, high):
                tightest_m = min(comfort_m, float(clearance[at : candidate + 1].min()))
                least_m = max(self._needed_m, tightest_m - 0.02)
                if self._leg_fits(points[at], points[candidate], least_m):
                    low = candidate
                    break
            pulled.append(points[low])
            at = low
        return pulled


def _points(start: Point, end: Point) -> Floats:
    """Points of a straight leg, [n, 2], at most `LEG_SPACING_M` apart."""
    count = min(MAX_CELLS, max(2, math.ceil(_length(start, end) / LEG_SPACING_M) + 1))
    points: Floats = np.linspace(start, end, count)
    return points


def _candidates(low: int, high: int) -> list[int]:
    """Indices to try, farthest first, in steps that shrink towards `low`."""
    found, gap = [], high - low
    while gap > 0:
        found.append(low + gap)
        gap = min(gap - 1, int(gap * 0.9))
    return found


def _length(start: Point, end: Point) -> float:
    return math.hypot(end[0] - start[0], end[1] - start[1])


def _inscribed_radius(footprint: tuple[Point, ...]) -> float:
    """Return the radius, metres, of the largest circle about (0, 0) inside a convex polygon."""
    edges = zip(footprint, footprint[1:] + footprint[:1])
    return min(abs(ax * by - ay * bx) / math.hypot(bx - ax, by - ay) for (ax, ay), (bx, by) in edges)


def _a_star(cost: Floats, start: tuple[int, int], goal: tuple[int, int]) -> list[tuple[int, int]] | None:
    """Return the cheapest way over cells of [ny, nx] costs (infinite: closed), or None. Costs are at least 1 a cell."""
    width = cost.shape[1] + 2
    padded = np.full((cost.shape[0] + 2, width), np.inf)
    padded[1:-1, 1:-1] = cost
    costs: list[float] = padded.ravel().tolist()
    diagonal = math.sqrt(2.0)
    moves = (
        (1, 1.0), (-1, 1.0), (width, 1.0), (-width, 1.0),
        (width + 1, diagonal), (width - 1, diagonal), (-width + 1, diagonal), (-width - 1, diagonal),
    )  # fmt: skip
    rows, columns = np.indices(padded.shape)
    away_i, away_j = np.abs(rows - goal[0] - 1), np.abs(columns - goal[1] - 1)
    to_go: list[float] = (
        (np.maximum(away_i, away_j) + (diagonal - 1.0) * np.minimum(away_i, away_j)).ravel().tolist()
    )
    first, last = (start[0] + 1) * width + start[1] + 1, (goal[0] + 1) * width + goal[1] + 1
    came_from = [-1] * len(costs)
    best = [math.inf] * len(costs)
    best[first] = 0.0
    queue = [(to_go[first], first)]
    done = bytearray(len(costs))
    while queue:
        _, here = heapq.heappop(queue)
        if here == last:
            return _trace(came_from, last, width)
        if done[here]:
            continue
        done[here] = 1
        so_far = best[here]
        for offset, length in moves:
            there = here + offset
            total = so_far + length * costs[there]
            if total < best[there]:
                best[there] = total
                came_from[there] = here
                heapq.heappush(queue, (total + to_go[there], there))
    return None


def _trace(came_from: list[int], last_index: int, columns: int) -> list[tuple[int, int]]:
    cells = []
    here = last_index
    while here >= 0:
        cells.append((here // columns - 1, here % columns - 1))
        here = came_from[here]
    return cells[::-1]
