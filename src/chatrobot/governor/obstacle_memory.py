"""Obstacle memory and scan coverage: what the lidar has seen, in `odom`, and where it has looked.

A point that it can no longer see may still be there. A robot whose lidar does not look all around knows what it comes
by from a moment ago.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.robots.profile import Lidar
from chatrobot.wire.messages import LaserScan

SCANS_KEPT = 3
NEAR_M = 0.15
"""A return that was this little beyond the minimum range and vanishes has most likely come nearer, not gone."""

SEEN_THROUGH_M = 0.10
FORGET_AFTER_M = 1.0
SLACK_M = 0.2
NO_POINTS: Floats = np.empty((0, 2))


class ObstacleMemory:
    """Points [n, 2] in `odom`: the last scan's, and those that came too near to be seen.

    Plus infinity means that nothing is there (REP-117). A cheap lidar says zero or NaN for what is too far and for
    what is too near alike; what was near the minimum range a moment ago is therefore remembered until its beam sees
    farther. A point counts for `SCANS_KEPT` scans: one noisy scan does not clear the way.
    """

    def __init__(self, lidar: Lidar) -> None:
        self.lidar = lidar
        self._scans: deque[Floats] = deque(maxlen=SCANS_KEPT)
        self.points: Floats = NO_POINTS
        """All that counts, [n, 2] in `odom`."""
        self._near = self._near_of = NO_POINTS
        self._near_circle = (0.0, 0.0, -math.inf)
        self.coverage = ScanCoverage()

    def near(self, x_m: float, y_m: float, within_m: float) -> Floats:
        """Return of `points` those within `within_m` of there, and some that are little farther.

        They are picked out once for all ticks of a robot that goes no farther than `SLACK_M` until the next scan.
        """
        about_x_m, about_y_m, picked_m = self._near_circle
        is_within = math.hypot(x_m - about_x_m, y_m - about_y_m) + within_m <= picked_m
        if not is_within or self._near_of is not self.points:
            self._near_of, picked_m = self.points, within_m + SLACK_M
            away = self.points - (x_m, y_m)
            self._near = self.points[np.einsum("ij,ij->i", away, away) <= picked_m * picked_m]
            self._near_circle = (x_m, y_m, picked_m)
        return self._near

    def take(self, scan: LaserScan, pose: Pose) -> None:
        """Take a scan made where the robot stood at `pose` (of `odom`)."""
        ranges = np.asarray(scan.ranges_m, dtype=np.float64)
        if not (_makes_sense(scan) and all(map(math.isfinite, pose))):
            self.coverage.forget()
            return
        lidar = pose.compose(Pose(self.lidar.x_m, self.lidar.y_m, self.lidar.yaw_rad))
        self.coverage.note(LidarView(lidar, scan.angle_min_rad, scan.angle_increment_rad, len(ranges)))
        with np.errstate(invalid="ignore"):
            valid = (ranges >= scan.range_min_m) & (ranges <= scan.range_max_m)
            sees = valid | (ranges == math.inf)
        vanished = self._still_there(scan, ranges, sees, lidar)
        angles = lidar.yaw_rad + scan.angle_min_rad + scan.angle_increment_rad * np.flatnonzero(valid)
        seen = ranges[valid]
        points = np.empty((len(seen), 2))
        points[:, 0] = lidar.x_m + seen * np.cos(angles)
        points[:, 1] = lidar.y_m + seen * np.sin(angles)
        self._scans.append(points)
        self.points = np.concatenate([*self._scans, vanished])

    def _still_there(self, scan: LaserScan, ranges: Floats, sees: Flags, lidar: Pose) -> Floats:
        """Return, of all points known so far, those that the lidar cannot see now because they are too near."""
        away = self.points - (lidar.x_m, lidar.y_m)
        distance = np.hypot(away[:, 0], away[:, 1])
        too_near_m = scan.range_min_m + NEAR_M
        near = distance < max(too_near_m, FORGET_AFTER_M)
        known, distance = self.points[near], distance[near]
        if len(known) == 0:
            return NO_POINTS
        dx, dy = away[near].T
        bearing = np.arctan2(dy, dx) - lidar.yaw_rad - scan.angle_min_rad
        onwards = bearing * math.copysign(1.0, scan.angle_increment_rad)  # many lidars turn clockwise
        whole = max(len(ranges), round(2.0 * math.pi / abs(scan.angle_increment_rad)))
        beam = np.rint((onwards % (2.0 * math.pi)) / abs(scan.angle_increment_rad)).astype(int) % whole
        inside = beam < len(ranges)
        beam = np.where(inside, beam, 0)
        # Seen through, or seen anew in about the same place: then the new return tells.
        told_anew = inside & sees[beam] & (ranges[beam] >= distance - SEEN_THROUGH_M)
        too_near = distance < too_near_m
        out_of_view = ~inside & (distance < FORGET_AFTER_M)
        return np.asarray(known[(too_near | out_of_view) & ~told_anew])


def _makes_sense(scan: LaserScan) -> bool:
    """Return True where its beams have directions at all."""
    return (
        len(scan.ranges_m) > 0
        and math.isfinite(scan.angle_min_rad)
        and math.isfinite(scan.angle_increment_rad)
        and scan.angle_increment_rad != 0.0
    )


Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

APART_M = 0.05
APART_RAD = 0.1
"""So far from the last one that was kept, the next view is kept."""

VIEWS_KEPT = 20
SCANS_VALID = 50
"""An earlier view counts for so many scans (5 s at 10 Hz): somebody may have come since."""


@dataclass(frozen=True)
class LidarView:
    """The sector of one scan: `beams` beams, each `step_rad` on from the first, of a lidar at `lidar` (in `odom`)."""

    lidar: Pose
    first_rad: float
    step_rad: float
    beams: int

    @property
    def is_all_around(self) -> bool:
        """Return True where no gap is wider than two beams."""
        return abs(self.step_rad) * (self.beams + 2) >= 2.0 * math.pi

    def covers(self, points: Floats) -> Flags:
        """Return which of the points [n, 2] (in `odom`) lie in its sector."""
        if self.is_all_around:
            return np.ones(len(points), dtype=np.bool_)
        bearings = np.arctan2(points[:, 1] - self.lidar.y_m, points[:, 0] - self.lidar.x_m)
        # Many lidars turn clockwise.
        onwards = (bearings - self.lidar.yaw_rad - self.first_rad) * math.copysign(1.0, self.step_rad)
        return np.asarray(onwards % (2.0 * math.pi) <= abs(self.step_rad) * (self.beams - 1))


class ScanCoverage:
    """The latest view, and earlier ones that still count."""

    def __init__(self) -> None:
        self.latest: LidarView | None = None
        self._earlier: deque[tuple[int, LidarView]] = deque(maxlen=VIEWS_KEPT)
        self._scans = 0

    def note(self, look: LidarView) -> None:
        """Take the view of a new scan."""
        self.latest = look
        self._scans += 1
        while self._earlier and self._scans - self._earlier[0][0] >= SCANS_VALID:
            self._earlier.popleft()
        if not self._earlier or _are_apart(self._earlier[-1][1].lidar, look.lidar):
            self._earlier.append((self._scans, look))

    def forget(self) -> None:
        """Forget all views: it looks no more, or nobody knows where from."""
        self.latest = None
        self._earlier.clear()

    def covers_now(self, points: Floats) -> Flags:
        """Return which of the points [n, 2] (in `odom`) the latest view takes in."""
        return (
            self.latest.covers(points) if self.latest is not None else np.zeros(len(points), dtype=np.bool_)
        )

    def covered_lately(self, points: Floats) -> Flags:
        """Return which of them the latest or an earlier view took in."""
        covered = self.covers_now(points)
        for _, look in reversed(self._earlier):  # the newest have most likely seen them
            if covered.all():
                break
            covered |= look.covers(points)
        return covered


def _are_apart(a: Pose, b: Pose) -> bool:
    return a.distance_to(b) >= APART_M or abs(wrap_angle(a.yaw_rad - b.yaw_rad)) >= APART_RAD
