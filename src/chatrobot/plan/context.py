"""The context in which a primitive is lowered to core motions: the speed it gets, and why it may be impossible.

A speed that somebody asked for in words is refused when it is beyond the limits, with the number that is possible.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, Union

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.plan.base import Frame, Step
from chatrobot.plan.trajectory import CoreMotion
from chatrobot.robots.profile import Limits, Point, RobotProfile

MAX_DURATION_S = 3600.0
MAX_EXTENT_M = 1000.0


@dataclass(frozen=True)
class Impossible:
    """Says that a step cannot be done by this robot, or not from here. `index` is the path of the step in its plan.

    `number` counts steps with repeats done, from 1; `instead` could be done in its place.
    """

    reason: Reason
    index: tuple[int, ...] = ()
    number: int = 1
    instead: Step | None = None


def too_long(duration_s: float) -> Reason:
    """Refuse what lasts longer than an hour; the number may be beyond what floats (and JSON) hold."""
    return Reason("lasts_too_long", {"duration_s": _sayable(duration_s), "max_s": MAX_DURATION_S})


def too_far(distance_m: float) -> Reason:
    """Refuse what leads farther than a kilometre from where it began."""
    return Reason("too_far", {"distance_m": _sayable(distance_m), "max_m": MAX_EXTENT_M})


def _sayable(value: float) -> float:
    return value if value < 1e9 else 1e9


@dataclass(frozen=True)
class Route:
    """Points to drive straight between, without the start; the last one is where the route ends."""

    waypoints: tuple[Point, ...]


@dataclass(frozen=True)
class NoRoute:
    """Says why there is no way: `no_route` or `target_blocked`."""

    reason: Reason


class RoutePlanner(Protocol):
    """Finds a way around what is known. Deterministic: rehearsal and execution ask alike and get the same."""

    def route(self, start: Pose, goal: Point, *, named_place: bool) -> Route | NoRoute:
        """Find a way, both ends in the odom frame. At a named place a free point right beside it will do, too."""
        ...


@dataclass(frozen=True)
class LoweringContext:
    """Tells where the robot stands when the step begins, and what it is. Poses in the odom frame.

    `pose` is the predicted one (the ideal end of what came before), `plan_start` what the frame `start` means.
    Without a route planner, `go` drives straight.
    """

    profile: RobotProfile
    pose: Pose = ORIGIN
    plan_start: Pose = ORIGIN
    route_planner: RoutePlanner | None = None

    def frame_pose(self, frame: Frame) -> Pose:
        """Return the origin of `frame`, in the odom frame."""
        return self.plan_start if frame == "start" else ORIGIN


Lowered = Union[Sequence[CoreMotion], Impossible]


Severity = Literal["refuse", "warn", "note"]


@dataclass(frozen=True)
class Finding:
    """Something to know about a plan before it runs; one `refuse` and it does not run.

    `index` is the path of the step in the plan that was rehearsed, from 0; `t_s` is counted from the start of the
    plan.
    """

    severity: Severity
    reason: Reason
    index: tuple[int, ...] = ()
    t_s: float = 0.0


_SLACK = 1.0 + 1e-9  # a limit said in other units (36 km/h) must not fail by rounding
_STRAIGHT_RAD = 1e-9
_ABSURD = 1e6


def max_speed_mps(limits: Limits, direction_rad: float) -> float:
    """Return the largest linear speed, m/s, in a direction of the robot's frame: overall, sideways and wheel limits."""
    ahead, sideways = abs(math.cos(direction_rad)), abs(math.sin(direction_rad))
    if sideways < _STRAIGHT_RAD:
        return limits.max_speed_mps
    by_wheels = limits.max_wheel_speed_mps / (ahead + sideways)
    return min(limits.max_speed_mps, limits.max_sideways_mps / sideways, by_wheels)


def max_arc_speed_mps(limits: Limits, radius_m: float) -> float:
    """Return the largest linear speed, m/s, on an arc that the turning rate and the outer wheel allow."""
    share = radius_m / (radius_m + limits.wheel_reach_m) if limits.wheel_reach_m > 0.0 else 1.0
    return min(limits.max_rate_radps * radius_m, limits.max_wheel_speed_mps * share)


def choose_speed(
    profile: RobotProfile, asked_mps: float | None, direction_rad: float = 0.0
) -> float | Impossible:
    """Return the linear speed for a direction of travel, m/s, or `sideways_impossible` / `speed_above_limit`."""
    if not profile.can_go_sideways and abs(math.sin(direction_rad)) > _STRAIGHT_RAD:
        return Impossible(Reason("sideways_impossible", {"turn_first_rad": direction_rad}))
    most = max_speed_mps(profile.limits, direction_rad)
    if asked_mps is None:
        return min(profile.defaults.speed_mps, most)
    if asked_mps > most * _SLACK:
        return Impossible(Reason("speed_above_limit", {"asked_mps": asked_mps, "max_mps": most}))
    return min(asked_mps, most)


def choose_rate(profile: RobotProfile, asked_radps: float | None) -> float | Impossible:
    """Return the turning rate on the spot, rad/s, or `rate_above_limit`."""
    most = profile.limits.max_rate_radps
    if asked_radps is None:
        return min(profile.defaults.rate_radps, most)
    if asked_radps > most * _SLACK:
        return Impossible(Reason("rate_above_limit", {"asked_radps": asked_radps, "max_radps": most}))
    return min(asked_radps, most)


def choose_arc_speed(profile: RobotProfile, asked_mps: float | None, radius_m: float) -> float | Impossible:
    """Return the linear speed on an arc, m/s: its turning rate speed / radius has a limit too."""
    limits = profile.limits
    if radius_m * _SLACK < limits.min_turning_radius_m:
        values = {"radius_m": radius_m, "min_radius_m": limits.min_turning_radius_m}
        return Impossible(Reason("turning_radius_too_small", values))
    speed = choose_speed(profile, asked_mps)
    if isinstance(speed, Impossible):
        return speed
    most = max_arc_speed_mps(limits, radius_m)
    if asked_mps is not None and speed > most * _SLACK:
        values = {
            "asked_radps": speed / radius_m,
            "max_radps": most / radius_m,
            "asked_mps": asked_mps,
            "max_mps": most,
        }
        return Impossible(Reason("rate_above_limit", values))
    return min(speed, most)


def refuse_turn_on_the_spot(profile: RobotProfile, angle_rad: float) -> Impossible | None:
    """Refuse to turn a base that steers; `angle_rad` is signed, left positive."""
    if profile.can_turn_on_the_spot:
        return None
    values = {"angle_rad": angle_rad, "min_radius_m": profile.limits.min_turning_radius_m}
    return Impossible(Reason("cannot_turn_on_the_spot", values))


def scale_into_limits(limits: Limits, twist: Twist) -> Twist:
    """Return the largest twist of the same direction (all three components in proportion) within the speed limits."""
    largest = max(abs(value) for value in twist)
    if largest > _ABSURD:  # so that no sum of squares is infinite
        twist = twist.scaled(_ABSURD / largest)
    factor = 1.0
    for value, most in (
        (twist.speed_mps, limits.max_speed_mps),
        (abs(twist.vy_mps), limits.max_sideways_mps),
        (abs(twist.wz_radps), limits.max_rate_radps),
        (limits.wheel_speed_mps(*twist), limits.max_wheel_speed_mps),
    ):
        if value > most:
            factor = min(factor, most / value)
    return twist if factor == 1.0 else twist.scaled(factor)
