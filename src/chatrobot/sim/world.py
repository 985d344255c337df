"""Worlds: what stands around the robot, what places are called, and whether a run can begin there.

A world is expressed in the frame the robot starts in: the robot begins every run at (0, 0, 0), so that here
the frame of the world and `odom` are the same.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from chatrobot.core.errors import UsageError, WorldError
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.shapes import Circle, Point, Polygon, Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from chatrobot.sim.distance_field import DistanceField


@dataclass(frozen=True)
class Obstacle:
    """Something with a name that a robot cannot drive through; `aliases` are its names in other languages."""

    name: str
    shape: Shape
    aliases: tuple[str, ...] = ()
    is_added: bool = False
    """It was put there while a simulation ran."""


@dataclass(frozen=True)
class Bounds:
    """The axis-aligned box that holds a world."""

    min_x_m: float
    min_y_m: float
    max_x_m: float
    max_y_m: float

    def holds(self, x_m: float, y_m: float, margin_m: float) -> bool:
        """Return whether a point is in the box, or no further outside than that."""
        is_in_x = self.min_x_m - margin_m <= x_m <= self.max_x_m + margin_m
        return is_in_x and self.min_y_m - margin_m <= y_m <= self.max_y_m + margin_m


@dataclass(frozen=True)
class World:
    """Obstacles and named places, in the frame of the start.

    `places` maps each place's main name to where a robot stands there. `aliases` maps every name a person may
    say (casefolded; the main names too) to a main name. `allowed_area` is the polygon the
    robot is to stay in, if the world has one; it is a rule, not a wall: neither lidar nor collisions know it.
    `without_heading` are the main names of places whose file says nothing of how a robot looks there.
    `start` is where the robot begins in the axes of the world's file: maps are drawn along them.
    """

    name: str
    obstacles: tuple[Obstacle, ...] = ()
    places: Mapping[str, Pose] = field(default_factory=dict)
    aliases: Mapping[str, str] = field(default_factory=dict)
    allowed_area: Polygon | None = None
    without_heading: frozenset[str] = frozenset()
    start: Pose = ORIGIN

    @property
    def start_yaw_rad(self) -> float:
        """The heading of the start in the axes of the file."""
        return self.start.yaw_rad

    @property
    def is_empty(self) -> bool:
        """Return True where nothing stands."""
        return not self.obstacles

    def with_added(self, added: tuple[Obstacle, ...]) -> World:
        """Return the world with these obstacles, too."""
        return replace(self, obstacles=(*self.obstacles, *added)) if added else self

    def changed(self, name: str, outline: tuple[Point, ...]) -> World:
        """Return the world where an obstacle of that name was put, moved, or taken away (without an outline).

        What its file names stays.
        """
        kept = tuple(one for one in self.obstacles if not (one.is_added and one.name == name))
        added = (Obstacle(name, Polygon(outline), is_added=True),) if outline else ()
        return replace(self, obstacles=(*kept, *added))

    def place(self, name: str) -> Pose | None:
        """Return the pose of a place by any of its names; None where nobody knows it."""
        main_name = self.aliases.get(name.strip().casefold(), name.strip())
        return self.places.get(main_name)

    def names_of(self, name: str) -> tuple[str, ...]:
        """Return the main name of a place, as it is written, and its other names."""
        return (
            name,
            *(alias for alias, main in self.aliases.items() if main == name and alias != name.casefold()),
        )

    def obstacle_names_at(self, x_m: float, y_m: float) -> tuple[str, ...]:
        """Return the names, the main one first, of the obstacle that is there, or nearest; empty for none."""
        if not self.obstacles:
            return ()
        nearest = min(self.obstacles, key=lambda obstacle: obstacle.shape.distance_m(x_m, y_m))
        return (nearest.name, *nearest.aliases) if nearest.name else ()

    def outline(self) -> list[tuple[str, tuple[Point, ...]]]:
        """Return every obstacle as a named polygon, for drawing a map."""
        return [(obstacle.name, obstacle.shape.outline()) for obstacle in self.obstacles]

    @cached_property
    def bounds(self) -> Bounds | None:
        """Return the box that holds all obstacles, places, the allowed area and the start; None in an empty world."""
        points = [point for _, outline in self.outline() for point in outline]
        points += [(pose.x_m, pose.y_m) for pose in self.places.values()]
        points += self.allowed_area.points if self.allowed_area else ()
        if not points:
            return None
        xs, ys = zip(*points, (0.0, 0.0))
        return Bounds(min(xs), min(ys), max(xs), max(ys))

    @cached_property
    def distance_field(self) -> DistanceField:
        """Return how far it is to the nearest obstacle, on a grid; computed once, at the first look."""
        from chatrobot.sim.distance_field import build_distance_field

        return build_distance_field(tuple(obstacle.shape for obstacle in self.obstacles))

    def clearance_m(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return metres from each point to the nearest obstacle, never more than it is (see `DistanceField`).

        Args:
            points: [n, 2], metres, in the world's frame.

        Returns:
            [n]; zero or less inside an obstacle, `FAR_M` everywhere in an empty world.
        """
        return self.distance_field.clearance_m(points)


EMPTY_WORLD = World("empty")


SPACING_M = 0.02
"""Of the points of the outline that are looked at; no obstacle is a bar as thin as this."""


def check_known(world: World, profile: RobotProfile) -> None:
    """Refuse a world for a robot that is driven open loop: where in it the robot is, nobody knows.

    Raises:
        UsageError: it is driven open loop, and the world is not empty.
    """
    if profile.open_loop and not (world.is_empty and world.allowed_area is None):
        raise UsageError(
            "without odometry the place of the robot in it is unknown",
            where=f"world {world.name}",
            allowed="empty",
        )


def frame_of(world: World) -> str:
    """Return a name of the odom frame of a robot that begins at the start of `world`: the same in every run of it."""
    told = repr((world.name, world.start, world.obstacles))
    return f"simulated {world.name} {hashlib.sha256(told.encode()).hexdigest()[:16]}"


def check_start(world: World, profile: RobotProfile, where: str) -> None:
    """Refuse a world in which the robot would begin its run inside an obstacle: it could not move, nor be moved.

    Raises:
        WorldError: names the obstacle; `where` is what the person chose the world by.
    """
    body = Polygon(profile.footprint)
    for obstacle in world.obstacles:
        if obstacle.shape.distance_m(0.0, 0.0) > profile.footprint_radius_m:
            continue
        if _meet(body, obstacle.shape):
            raise WorldError(
                f"the start of the world {world.name!r} lies in the {obstacle.name}",
                where=where,
                allowed=f"a start where the {profile.title} touches nothing{_free_start(world, profile)}",
            )


ROOM_M = 0.25
"""So much more than the robot needs is a good place to begin at."""


def _free_start(world: World, profile: RobotProfile) -> str:
    """What could be written in its file, to begin at the nearest point with room."""
    import numpy as np

    field, around = world.distance_field, world.bounds
    assert around is not None
    has_room = field.values_m >= profile.footprint_radius_m + ROOM_M
    ny, nx = field.values_m.shape
    x_m = field.origin_x_m + field.resolution_m * np.arange(nx)
    y_m = field.origin_y_m + field.resolution_m * np.arange(ny)
    has_room &= ((x_m > around.min_x_m) & (x_m < around.max_x_m))[None, :]
    has_room &= ((y_m > around.min_y_m) & (y_m < around.max_y_m))[:, None]
    if not has_room.any():
        return ""
    away_m = np.where(has_room, np.hypot(x_m[None, :], y_m[:, None]), np.inf)
    i, j = np.unravel_index(int(away_m.argmin()), away_m.shape)
    free = world.start.compose(Pose(float(x_m[j]), float(y_m[i])))
    return f", such as start: {{x_m: {free.x_m:.2f}, y_m: {free.y_m:.2f}}}"


def _meet(body: Polygon, shape: Shape) -> bool:
    if isinstance(shape, Circle):
        return body.distance_m(shape.x_m, shape.y_m) <= shape.radius_m
    return any(shape.distance_m(x, y) <= 0.0 for x, y in _along(body)) or any(
        body.distance_m(x, y) <= 0.0 for x, y in shape.points
    )


def _along(body: Polygon) -> list[Point]:
    found: list[Point] = []
    for (ax, ay), (bx, by) in zip(body.points, body.points[1:] + body.points[:1]):
        count = max(1, math.ceil(math.hypot(bx - ax, by - ay) / SPACING_M))
        found += [(ax + (bx - ax) * i / count, ay + (by - ay) * i / count) for i in range(count)]
    return found
