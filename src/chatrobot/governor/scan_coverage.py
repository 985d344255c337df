"""Which directions the lidar has scanned. A robot whose lidar does not look all around knows what it comes by
from a moment ago."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chatrobot.core.geometry import Pose, wrap_angle

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
    """What one scan covers: `beams` beams, each `step_rad` on from the first, of a lidar at `lidar` (in `odom`)."""

    lidar: Pose
    first_rad: float
    step_rad: float
    beams: int

    @property
    def is_all_around(self) -> bool:
        """True where no gap is wider than two beams."""
        return abs(self.step_rad) * (self.beams + 2) >= 2.0 * math.pi

    def covers(self, points: Floats) -> Flags:
        """Which of the points [n, 2] (in `odom`) lie in its sector."""
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
        """Of a new scan."""
        self.latest = look
        self._scans += 1
        while self._earlier and self._scans - self._earlier[0][0] >= SCANS_VALID:
            self._earlier.popleft()
        if not self._earlier or _are_apart(self._earlier[-1][1].lidar, look.lidar):
            self._earlier.append((self._scans, look))

    def forget(self) -> None:
        """It looks no more, or nobody knows where from."""
        self.latest = None
        self._earlier.clear()

    def covers_now(self, points: Floats) -> Flags:
        """Which of the points [n, 2] (in `odom`) the latest look takes in."""
        return (
            self.latest.covers(points) if self.latest is not None else np.zeros(len(points), dtype=np.bool_)
        )

    def covered_lately(self, points: Floats) -> Flags:
        """Which of them the latest or an earlier look took in."""
        covered = self.covers_now(points)
        for _, look in reversed(self._earlier):  # the newest have most likely seen them
            if covered.all():
                break
            covered |= look.covers(points)
        return covered


def _are_apart(a: Pose, b: Pose) -> bool:
    return a.distance_to(b) >= APART_M or abs(wrap_angle(a.yaw_rad - b.yaw_rad)) >= APART_RAD
