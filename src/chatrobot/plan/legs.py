"""Getting to a point: turn to each leg and drive it, reverse where that is shorter, or steer there on a curve.

A curve is the shortest of bounded curvature, forward: an arc, a straight line and, to a pose, another arc. Source:
L. E. Dubins, On curves of minimal length with a constraint on average curvature (1957); the four words
circle-straight-circle, which always suffice when start and goal are more than four radii apart. To a point with a
free final heading circle-straight is enough unless the point lies inside one turning circle; then the other is used.
"""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose, Twist, wrap_angle
from chatrobot.core.reason import Reason
from chatrobot.plan.context import (
    MAX_EXTENT_M,
    Impossible,
    Lowered,
    LoweringContext,
    NoRoute,
    Route,
    choose_arc_speed,
    choose_rate,
    choose_speed,
    max_arc_speed_mps,
    refuse_turn_on_the_spot,
    too_far,
)
from chatrobot.plan.trajectory import CoreMotion, RampedTwist
from chatrobot.robots.profile import Point, RobotProfile

Piece = tuple[float, float]
"""(signed bend in radians, left positive, length in metres); a straight piece has bend 0."""

Curve = tuple[Piece, ...]

_TINY = 1e-9


def _length_m(curve: Curve) -> float:
    return sum(length for _, length in curve)


def curve_to_point(start: Pose, goal: Point, radius_m: float) -> Curve | None:
    """Return the shorter of left-straight and right-straight from `start` to `goal`, or None if neither exists."""
    curves = (_bend_then_straight(start, goal, radius_m, side) for side in (1.0, -1.0))
    return min((curve for curve in curves if curve is not None), key=_length_m, default=None)


def curve_to_pose(start: Pose, goal: Pose, radius_m: float) -> Curve | None:
    """Return the shortest of the four words circle-straight-circle."""
    sides = ((a, b) for a in (1.0, -1.0) for b in (1.0, -1.0))
    curves = (_bend_straight_bend(start, goal, radius_m, *pair) for pair in sides)
    return min((curve for curve in curves if curve is not None), key=_length_m, default=None)


def _center(pose: Pose, radius_m: float, side_sign: float) -> Point:
    """Of the turning circle on the left (side 1) or right (side -1)."""
    return (
        pose.x_m - side_sign * radius_m * math.sin(pose.yaw_rad),
        pose.y_m + side_sign * radius_m * math.cos(pose.yaw_rad),
    )


def _bend(from_rad: float, to_rad: float, side_sign: float, radius_m: float) -> Piece:
    """Turn from one heading to another, going round to `side_sign` only."""
    angle = (side_sign * (to_rad - from_rad)) % (2.0 * math.pi)
    if angle > 2.0 * math.pi - _TINY or angle < _TINY:
        angle = 0.0
    return side_sign * angle, radius_m * angle


def _pieces(*pieces: Piece) -> Curve:
    return tuple(piece for piece in pieces if piece[1] > _TINY)


def _bend_then_straight(start: Pose, goal: Point, radius_m: float, side_sign: float) -> Curve | None:
    cx, cy = _center(start, radius_m, side_sign)
    dx, dy = goal[0] - cx, goal[1] - cy
    distance = math.hypot(dx, dy)
    if distance < radius_m - _TINY:
        return None
    straight = math.sqrt(max(0.0, distance * distance - radius_m * radius_m))
    # seen along the tangent, the centre lies `radius` to the side: this angle turns the line centre-goal into it
    heading = math.atan2(dy, dx) + side_sign * math.atan2(radius_m, straight)
    return _pieces(_bend(start.yaw_rad, heading, side_sign, radius_m), (0.0, straight))


def _bend_straight_bend(
    start: Pose, goal: Pose, radius_m: float, first_sign: float, last_sign: float
) -> Curve | None:
    ax, ay = _center(start, radius_m, first_sign)
    bx, by = _center(goal, radius_m, last_sign)
    dx, dy = bx - ax, by - ay
    distance = math.hypot(dx, dy)
    across = 0.0 if first_sign == last_sign else 2.0 * radius_m
    if distance < across - _TINY:
        return None
    straight = math.sqrt(max(0.0, distance * distance - across * across))
    if straight < _TINY and across == 0.0:
        return _pieces(_bend(start.yaw_rad, goal.yaw_rad, first_sign, radius_m))
    heading = math.atan2(dy, dx) + first_sign * math.atan2(across, straight)
    return _pieces(
        _bend(start.yaw_rad, heading, first_sign, radius_m),
        (0.0, straight),
        _bend(heading, goal.yaw_rad, last_sign, radius_m),
    )


REVERSE_WITHIN_RAD = math.radians(10.0)
REVERSE_AT_MOST_M = 3.0
_THERE_M = 0.01  # nearer than this a robot is there: it does not turn round for a few millimetres
_ALIGNED_RAD = 1e-6


def turn_to(
    profile: RobotProfile, pose: Pose, heading_rad: float, rate_radps: float | None = None
) -> Lowered:
    """Turn the short way round from `pose` to a heading of the same frame. Nothing if it looks there already."""
    angle = wrap_angle(heading_rad - pose.yaw_rad)
    rate = choose_rate(profile, rate_radps)
    if isinstance(rate, Impossible):
        return rate
    if abs(angle) < _ALIGNED_RAD:
        return []
    refused = refuse_turn_on_the_spot(profile, angle)
    if refused is not None:
        return refused
    twist = Twist(0.0, 0.0, math.copysign(rate, angle))
    return [RampedTwist.within(profile.limits, twist, abs(angle) / rate)]


def go_to(
    context: LoweringContext,
    goal: Point,
    heading_rad: float | None,
    *,
    speed_mps: float | None,
    named_place: bool,
) -> Lowered:
    """Lead from `context.pose` to `goal` (odom frame), at the end looking along `heading_rad` if that is given."""
    speed = choose_speed(context.profile, speed_mps)
    if isinstance(speed, Impossible):
        return speed
    distance_m = _distance(context.pose, goal)
    if not distance_m <= MAX_EXTENT_M:
        return Impossible(too_far(distance_m))
    if not context.profile.can_turn_on_the_spot:
        return _steer_to(context, goal, heading_rad, speed_mps)
    route = _route(context, goal, named_place)
    if isinstance(route, NoRoute):
        return Impossible(route.reason)
    walk = _Walk(context.profile, context.pose)
    if len(route.waypoints) == 1 and _lies_behind(context.pose, route.waypoints[0]):
        walk.leg(route.waypoints[0], speed, reverse=True)
    else:
        for waypoint in route.waypoints:
            walk.leg(waypoint, speed)
    if heading_rad is not None:
        walk.turn(heading_rad)
    return walk.motions


def _route(context: LoweringContext, goal: Point, named_place: bool) -> Route | NoRoute:
    if context.route_planner is None or _distance(context.pose, goal) < _THERE_M:
        return Route((goal,))
    return context.route_planner.route(context.pose, goal, named_place=named_place)


def _distance(pose: Pose, point: Point) -> float:
    return math.hypot(point[0] - pose.x_m, point[1] - pose.y_m)


def _lies_behind(pose: Pose, point: Point) -> bool:
    if not _THERE_M <= _distance(pose, point) <= REVERSE_AT_MOST_M:
        return False
    bearing = pose.bearing_to(Pose(*point))
    return abs(wrap_angle(bearing + math.pi - pose.yaw_rad)) <= REVERSE_WITHIN_RAD


class _Walk:
    """Collects turns and legs and keeps the ideal pose they lead to."""

    def __init__(self, profile: RobotProfile, pose: Pose) -> None:
        self.profile = profile
        self.pose = pose
        self.motions: list[CoreMotion] = []

    def _add(self, motion: CoreMotion) -> None:
        self.motions.append(motion)
        self.pose = motion.end(self.pose)

    def turn(self, heading_rad: float) -> None:
        turned = turn_to(self.profile, self.pose, heading_rad)
        if not isinstance(turned, Impossible):  # the base can turn on the spot, at its default rate
            for motion in turned:
                self._add(motion)

    def leg(self, point: Point, speed_mps: float, *, reverse: bool = False) -> None:
        distance = _distance(self.pose, point)
        if distance < _THERE_M:
            return
        bearing = self.pose.bearing_to(Pose(*point))
        self.turn(bearing + math.pi if reverse else bearing)
        twist = Twist(-speed_mps if reverse else speed_mps)
        self._add(RampedTwist.within(self.profile.limits, twist, distance / speed_mps))


def _steer_to(
    context: LoweringContext, goal: Point, heading_rad: float | None, speed_mps: float | None
) -> Lowered:
    """For a base that steers: forward on circles of its turning radius and straight lines."""
    profile, pose = context.profile, context.pose
    if _distance(pose, goal) < _THERE_M:
        return [] if heading_rad is None else turn_to(profile, pose, heading_rad)
    radius = profile.limits.min_turning_radius_m
    if heading_rad is None:
        curve = curve_to_point(pose, goal, radius)
    else:
        curve = curve_to_pose(pose, Pose(*goal, heading_rad), radius)
    if curve is None:
        return Impossible(Reason("no_route", {"min_radius_m": radius}))
    return _curve_motions(profile, curve, radius, speed_mps)


def _curve_motions(profile: RobotProfile, curve: Curve, radius_m: float, speed_mps: float | None) -> Lowered:
    arc_speed = choose_arc_speed(profile, speed_mps, radius_m)
    if isinstance(arc_speed, Impossible):  # the asked speed is fine straight on; slow down where it bends
        arc_speed = max_arc_speed_mps(profile.limits, radius_m)
    straight_speed = choose_speed(profile, speed_mps)
    if isinstance(straight_speed, Impossible):
        return straight_speed
    motions: list[CoreMotion] = []
    for bend_rad, length_m in curve:
        if bend_rad != 0.0:
            rate = arc_speed / radius_m
            twist = Twist(arc_speed, 0.0, math.copysign(rate, bend_rad))
            motions.append(RampedTwist.within(profile.limits, twist, abs(bend_rad) / rate))
        elif length_m > 0.0:
            twist = Twist(straight_speed)
            motions.append(RampedTwist.within(profile.limits, twist, length_m / straight_speed))
    return motions
