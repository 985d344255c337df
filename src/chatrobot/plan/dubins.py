"""Shortest forward curves of bounded curvature made of an arc, a straight line and, to a pose, another arc.

Source: L. E. Dubins, On curves of minimal length with a constraint on average curvature (1957); the four words
circle-straight-circle, which always suffice when start and goal are more than four radii apart. To a point with a
free final heading circle-straight is enough unless the point lies inside the turning circle; then the other circle
is used.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import Point

Piece = tuple[float, float]
"""(signed bend in radians, left positive, length in metres); a straight piece has bend 0."""

Curve = tuple[Piece, ...]

_TINY = 1e-9


def length_m(curve: Curve) -> float:
    return sum(length for _, length in curve)


def curve_to_point(start: Pose, goal: Point, radius_m: float) -> Curve | None:
    """The shorter of left-straight and right-straight from `start` to `goal`, or None if neither exists."""
    curves = [
        curve
        for side in (1.0, -1.0)
        if (curve := _bend_then_straight(start, goal, radius_m, side)) is not None
    ]
    return min(curves, key=length_m, default=None)


def curve_to_pose(start: Pose, goal: Pose, radius_m: float) -> Curve | None:
    """The shortest of the four words circle-straight-circle."""
    sides = [(a, b) for a in (1.0, -1.0) for b in (1.0, -1.0)]
    curves = [
        curve for a, b in sides if (curve := _bend_straight_bend(start, goal, radius_m, a, b)) is not None
    ]
    return min(curves, key=length_m, default=None)


def _center(pose: Pose, radius_m: float, side: float) -> Point:
    """Of the turning circle on the left (side 1) or right (side -1)."""
    return (
        pose.x_m - side * radius_m * math.sin(pose.yaw_rad),
        pose.y_m + side * radius_m * math.cos(pose.yaw_rad),
    )


def _bend(from_rad: float, to_rad: float, side: float, radius_m: float) -> Piece:
    """Turn from one heading to another, going round to `side` only."""
    angle = (side * (to_rad - from_rad)) % (2.0 * math.pi)
    if angle > 2.0 * math.pi - _TINY or angle < _TINY:
        angle = 0.0
    return side * angle, radius_m * angle


def _pieces(*pieces: Piece) -> Curve:
    return tuple(piece for piece in pieces if piece[1] > _TINY)


def _bend_then_straight(start: Pose, goal: Point, radius_m: float, side: float) -> Curve | None:
    cx, cy = _center(start, radius_m, side)
    dx, dy = goal[0] - cx, goal[1] - cy
    distance = math.hypot(dx, dy)
    if distance < radius_m - _TINY:
        return None
    straight = math.sqrt(max(0.0, distance * distance - radius_m * radius_m))
    # seen along the tangent, the centre lies `radius` to the side: this angle turns the line centre-goal into it
    heading = math.atan2(dy, dx) + side * math.atan2(radius_m, straight)
    return _pieces(_bend(start.yaw_rad, heading, side, radius_m), (0.0, straight))


def _bend_straight_bend(start: Pose, goal: Pose, radius_m: float, first: float, last: float) -> Curve | None:
    ax, ay = _center(start, radius_m, first)
    bx, by = _center(goal, radius_m, last)
    dx, dy = bx - ax, by - ay
    distance = math.hypot(dx, dy)
    across = 0.0 if first == last else 2.0 * radius_m
    if distance < across - _TINY:
        return None
    straight = math.sqrt(max(0.0, distance * distance - across * across))
    if straight < _TINY and across == 0.0:
        return _pieces(_bend(start.yaw_rad, goal.yaw_rad, first, radius_m))
    heading = math.atan2(dy, dx) + first * math.atan2(across, straight)
    return _pieces(
        _bend(start.yaw_rad, heading, first, radius_m),
        (0.0, straight),
        _bend(heading, goal.yaw_rad, last, radius_m),
    )
