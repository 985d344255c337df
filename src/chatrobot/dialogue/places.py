"""Keeps the places a person has named, with the session of each; how far one is, and were we moved?"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.core.events import Finished, Telemetry
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason, one_line
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.dialogue.robot_file import Entry, RobotFile
from chatrobot.language.context import Place, Thing
from chatrobot.link.motion_link import LAPSES_AFTER_M, LAPSES_AFTER_RAD
from chatrobot.plan.base import expanded
from chatrobot.plan.context import Route
from chatrobot.plan.primitives.drive import MAX_PLACE_CHARS
from chatrobot.plan.ring import RING_MARGIN_M, ring_around
from chatrobot.plan.steps import Face, Go, Plan, Say, Wait
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.shapes import Point
from chatrobot.sim.world import World

if TYPE_CHECKING:
    from chatrobot.plan.context import RoutePlanner


_CODES = ("places_not_kept", "places_unreadable")
MOVED = "cannot_undo_moved"
ODOMETRY_ANEW = "cannot_undo_odometry_anew"
UNMEASURED = "cannot_undo_unmeasured"
AT_PLACE_M = 1.0
"""What stands within this of a named place is what the place is named after."""


class Places:
    """Keeps the named places of one robot. Their coordinates hold for one session, and in one world of a simulation.

    A base that ran on between two sessions cannot be told from one whose odometry began anew: its messages say where it
    is and not since when it counts. Coordinates that were kept would lead it to a wrong point, so a later session knows
    the name alone, and asks. A simulated robot begins every session at the start of its world.

    Args:
        folder: where they are kept; None keeps them for this session only.
        robot: profile name; another robot's places mean nothing to this one.
        epoch: names this session, or the frame that it shares with others. Coordinates of another one are remembered
            but not usable.
    """

    def __init__(self, folder: Path | None, robot: str, epoch: str) -> None:
        self._epoch = epoch
        self._file = RobotFile(folder, "places", _CODES, robot, self._place)

    def add(self, name: str, pose: Pose) -> None:
        """Remember `pose` under `name`; an older place of that name is replaced."""
        entry = {"x_m": pose.x_m, "y_m": pose.y_m, "yaw_rad": pose.yaw_rad, "epoch": self._epoch}
        self._file.entries[one_line(name, MAX_PLACE_CHARS)] = entry
        self._file.keep()

    def rename(self, name: str, new: str) -> None:
        """Call a place otherwise, or forget it where `new` is empty; nothing where there is none of that name."""
        entry = self._file.entries.pop(name, None)
        if entry is None:
            return
        if new:
            self._file.entries[one_line(new, MAX_PLACE_CHARS)] = entry
        self._file.keep()

    def take_unkept(self) -> Reason | None:
        """Return why places are remembered for this session only; once, None where they are kept."""
        return self._file.take_unkept()

    def all(self) -> Mapping[str, Place]:
        """Return every place by name."""
        found = self._file.entries.items()
        return {one_line(name, MAX_PLACE_CHARS): self._place(name, entry) for name, entry in found}

    def _place(self, _name: str, entry: Entry) -> Place:
        x, y, yaw = (float(str(entry[key])) for key in ("x_m", "y_m", "yaw_rad"))
        return Place(Pose(x, y, yaw), usable=entry["epoch"] == self._epoch)


class RestWatch:
    """Watches whether the robot still stands where our last turn left it, and in the same odometry.

    Each method returns why what was done before cannot be undone any more: a code, empty while it can.
    """

    def __init__(self) -> None:
        self._rest: Pose | None = None
        self._odometry_epoch: int | None = None

    def hear(self, event: Telemetry, *, is_ours: bool) -> str:
        """Compare where the robot is. `is_ours`: a turn of ours moves it, or may."""
        before, self._odometry_epoch = self._odometry_epoch, event.odometry_epoch
        if before is not None and before != event.odometry_epoch:
            return ODOMETRY_ANEW
        return "" if is_ours else self._displaced(event.pose)

    def begin(self, finished: Finished) -> str:
        """Compare where the robot was when the turn that has ended began."""
        return self._displaced(finished.start) if finished.duration_s else ""

    def end(self, finished: Finished) -> str:
        """Note where a turn has ended, and whether somebody else drives on."""
        if finished.duration_s:  # what never began may end while another one drives
            self._rest = finished.pose
        handed_over = finished.reason is not None and finished.reason.code == "handed_over"
        return MOVED if handed_over else ""

    def _displaced(self, pose: Pose) -> str:
        rest = self._rest
        if rest is None:
            return ""
        off_rad = abs(pose.yaw_rad - rest.yaw_rad)
        return MOVED if pose.distance_to(rest) > LAPSES_AFTER_M or off_rad > LAPSES_AFTER_RAD else ""


class MapWays:
    """Measures ways of one robot in one world. numpy is loaded with the first question, not with the console."""

    def __init__(self, world: World, profile: RobotProfile) -> None:
        self._profile = profile
        self._see(world)

    def _see(self, world: World) -> None:
        self.world = world
        """What is known of the surroundings, with what a person has put there meanwhile."""
        self.any = self if world.obstacles else None
        """None where nothing is known to stand anywhere."""
        named = (one for one in world.obstacles if one.name)
        self.things = tuple(
            Thing((one.name, *one.aliases), one.shape.distance_m, one.is_added) for one in named
        )

    def note_obstacle(self, event: ObstacleChanged) -> None:
        """Take note that an obstacle has come, moved or gone."""
        self._see(self.world.changed(event.obstacle, event.outline_m))
        self.__dict__.pop("_planner", None)

    @cached_property
    def _planner(self) -> RoutePlanner:
        from chatrobot.plan.route import GridRoutePlanner

        return GridRoutePlanner(self.world, self._profile)

    def __call__(self, start: Pose, goal: Pose) -> float | None:
        """Metres; None where there is no free way."""
        way = self._way(start, goal)
        return _length_m(way) if way else None

    def _way(self, start: Pose, goal: Pose) -> list[Point]:
        """The corners of the way, the first and the last point, too; none where there is no free way."""
        here, there = (start.x_m, start.y_m), (goal.x_m, goal.y_m)
        if not self.world.obstacles:
            return [here, there]
        way = self._planner.route(start, there, named_place=True)
        return [here, *way.waypoints] if isinstance(way, Route) else []

    def along(self, start: Pose, goal: Pose, share: float) -> Point | None:
        """Return the point after that share of the way; None where there is no free way."""
        way = self._way(start, goal)
        left_m = share * _length_m(way)
        for (ax, ay), (bx, by) in itertools.pairwise(way):
            leg_m = math.dist((ax, ay), (bx, by))
            if leg_m and leg_m >= left_m:
                return ax + (bx - ax) * left_m / leg_m, ay + (by - ay) * left_m / leg_m
            left_m -= leg_m
        return None

    def ring(self, place: Pose) -> tuple[Point, ...]:
        """Return the corners, counter-clockwise, of the way once around what stands at a place.

        Empty where nothing stands within `AT_PLACE_M` of it.
        """
        by_distance = [
            (one.shape.distance_m(place.x_m, place.y_m), k) for k, one in enumerate(self.world.obstacles)
        ]
        nearest_m, k = min(by_distance, default=(math.inf, 0))
        if nearest_m > AT_PLACE_M:
            return ()
        return ring_around(
            self.world.obstacles[k].shape.outline(), self._profile.footprint_radius_m + RING_MARGIN_M
        )


def ends_alike(plan: Plan) -> bool:
    """Return whether a plan ends alike wherever it begins: it only goes to points of the map, and faces headings."""
    return all(
        isinstance(step, (Face, Wait, Say)) or (isinstance(step, Go) and step.frame == "odom")
        for step in expanded(plan.steps)
    )


def _length_m(way: Sequence[Point]) -> float:
    return sum(math.dist(one, other) for one, other in itertools.pairwise(way))
