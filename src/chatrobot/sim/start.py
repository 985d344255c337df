"""Whether a robot can be where its run begins. Plain Python: every start of the console asks it."""

from __future__ import annotations

import math

from chatrobot.core.errors import UsageError, WorldError
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.shapes import Circle, Point, Polygon, Shape
from chatrobot.sim.world import World

SPACING_M = 0.02
"""Of the points of the outline that are looked at; no obstacle is a bar as thin as this."""


def check_known(world: World, profile: RobotProfile) -> None:
    """Refuse a world for a robot that is driven open loop: where in it the robot is, nobody knows.

    Raises:
        UsageError: it is driven open loop, and the world is not empty.
    """
    if profile.open_loop and not (world.is_empty and world.allowed_area is None):
        raise UsageError(
            "without odometry nobody knows where in it the robot is",
            where=f"world {world.name}",
            allowed="empty",
        )


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
                allowed=f"a start where the {profile.title} touches nothing",
            )


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
