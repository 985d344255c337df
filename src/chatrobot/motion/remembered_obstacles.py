"""What the lidar has seen, for rehearsals: measured with the governor's own footprint and margin.

A plan that passes here keeps every seen point at the distance that the governor demands along the whole path.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.governor.contact import Floats, Footprint
from chatrobot.governor.obstacle_memory import LidarView, ObstacleMemory
from chatrobot.governor.rule import NOTHING_SENSED, Sensed, Situation
from chatrobot.governor.space_rules import MARGIN_M, NEARER_M, BlindRule
from chatrobot.plan import rehearsal
from chatrobot.plan.known_world import Contact
from chatrobot.robots.profile import Lidar, RobotProfile
from chatrobot.sim.shapes import Circle
from chatrobot.sim.world import Obstacle, World

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
    """How much the governor allows where the lidar does not see, by its own rule.


    Args:
        look: where the lidar looked last; None where it shows nothing, not even that nothing is there.
    """

    def __init__(self, profile: RobotProfile, lidar: Lidar, look: LidarView | None) -> None:
        self._mounting = Pose(lidar.x_m, lidar.y_m, lidar.yaw_rad)
        self._look = look
        self._seen = ObstacleMemory(lidar)
        self._seen.coverage.note(
            LidarView(ORIGIN, 0.0, math.tau, 1)
        )  # all around: what it comes by has been seen before
        self._rule = BlindRule(profile, self._seen)

    def allowed_share(self, twist: Twist, pose: Pose) -> float:
        """Of a twist at that pose, from where the lidar looks as it does now."""
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
        """How much the governor will allow of a twist at that pose."""
        return self._sight.allowed_share(twist, pose) if self._sight is not None else 1.0

    def free_ahead_m(self, pose: Pose, direction_rad: float) -> float:
        """How far the strip that the footprint sweeps straight on is free; infinite where nothing was seen in it."""
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
        """The first of [n, 3] poses, from where the robot stands, that comes nearer to a seen point than is allowed.

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
        """The points [n, 2] that a robot at `pose` does not touch."""
        clearance = self._clearance_m(np.array([pose]), self.points)[0]
        found: Floats = self.points[clearance > TOUCHES_M]
        return found

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
    """The world with small obstacles where points [n, 2] were seen that it does not know."""
    unknown = seen_but_unknown(world, points)
    cells = np.unique(np.rint(unknown / APART_IN_WORLD_M), axis=0) * APART_IN_WORLD_M
    added = (Obstacle("", Circle(x, y, TOUCHES_M / 2.0)) for x, y in cells.tolist())
    return replace(world, obstacles=(*world.obstacles, *added)) if len(cells) else world


def seen_but_unknown(world: World, points: Floats) -> Floats:
    """Those of the seen points [n, 2] that are no obstacle of the map."""
    if world.is_empty or not len(points):
        return points
    return points[world.clearance_m(points) >= rehearsal.KNOWN_WITHIN_M]
