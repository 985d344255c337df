"""What a primitive may know when it is lowered to core motions, and how it says that it cannot be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Union

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.plan.base import Frame, Step
from chatrobot.plan.core_motion import CoreMotion
from chatrobot.robots.profile import Point, RobotProfile

MAX_DURATION_S = 3600.0
MAX_EXTENT_M = 1000.0


@dataclass(frozen=True)
class Impossible:
    """This step cannot be done by this robot, or not from here. `index` is the path of the step in its plan.

    `number` counts steps with repeats done, from 1; `instead` could be done in its place.
    """

    reason: Reason
    index: tuple[int, ...] = ()
    number: int = 1
    instead: Step | None = None


def too_long(duration_s: float) -> Reason:
    """Longer than an hour; the number may be beyond what floats (and JSON) hold."""
    return Reason("lasts_too_long", {"duration_s": _sayable(duration_s), "max_s": MAX_DURATION_S})


def too_far(distance_m: float) -> Reason:
    """Farther than a kilometre from where it began."""
    return Reason("too_far", {"distance_m": _sayable(distance_m), "max_m": MAX_EXTENT_M})


def _sayable(value: float) -> float:
    return value if value < 1e9 else 1e9


@dataclass(frozen=True)
class Route:
    """Points to drive straight between, without the start; the last one is where the route ends."""

    waypoints: tuple[Point, ...]


@dataclass(frozen=True)
class NoRoute:
    """There is no way, and why: `no_route` or `target_blocked`."""

    reason: Reason


class RoutePlanner(Protocol):
    """Finds a way around what is known. Deterministic: rehearsal and execution ask alike and get the same."""

    def route(self, start: Pose, goal: Point, *, named_place: bool) -> Route | NoRoute:
        """Both in the odom frame. At a named place a free point right beside it will do, elsewhere only the goal."""
        ...


@dataclass(frozen=True)
class LoweringContext:
    """Where the robot stands when the step begins, and what it is. Poses in the odom frame.

    `pose` is the predicted one (the ideal end of what came before), `plan_start` what the frame `start` means.
    Without a route planner, `go` drives straight.
    """

    profile: RobotProfile
    pose: Pose = ORIGIN
    plan_start: Pose = ORIGIN
    route_planner: RoutePlanner | None = None

    def frame_pose(self, frame: Frame) -> Pose:
        """The origin of `frame`, in the odom frame."""
        return self.plan_start if frame == "start" else ORIGIN


Lowered = Union[Sequence[CoreMotion], Impossible]
