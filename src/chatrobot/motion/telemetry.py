"""What is published of the robot for displays: how it moves, what its lidar sees. After each tick's own work."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from chatrobot.core.events import Event, Limited, Progress, Scan, Telemetry
from chatrobot.execution.sensors import Sensors, scan_points_m
from chatrobot.execution.tracking import nearest_m
from chatrobot.governor.governor import Verdict
from chatrobot.governor.lease import Leases
from chatrobot.motion.governed_motion import is_worth_telling
from chatrobot.robots.profile import Lidar, RobotProfile
from chatrobot.wire.messages import LaserScan

TELEMETRY_S = 0.1


class TelemetryPublisher:
    """Publishes how far the motion is, and where and how fast the robot goes, as it measures it itself.

    Args:
        progress: how far the motion under way is; None where nothing is.
    """

    def __init__(
        self,
        profile: RobotProfile,
        sensors: Sensors,
        progress: Callable[[float], Progress | None],
        emit: Callable[[Event], None],
    ) -> None:
        self._profile = profile
        self._sensors = sensors
        self._progress = progress
        self._emit = emit
        self._next_s = 0.0

    def tick(self, now_s: float) -> None:
        """Publish it every `TELEMETRY_S`, once the robot has said where it is."""
        if now_s < self._next_s:
            return
        self._next_s = now_s + TELEMETRY_S
        estimate, scan = self._sensors.estimate, self._sensors.scan
        if estimate is None:
            return
        progress = self._progress(now_s)
        if progress is not None:
            self._emit(progress)
        self._emit(
            Telemetry(
                progress.turn if progress is not None else 0,
                estimate.pose,
                estimate.twist,
                estimate.path_m,
                self._sensors.battery_percent,
                nearest_m(scan) if scan is not None else None,
                progress is not None,
                self._sensors.estimator.epoch,
                sectors_m(self._profile, scan),
            )
        )


CHANGED_LIMIT_S, SAME_LIMIT_S = 0.25, 2.0
"""How soon after a limit was published another one is, and the same again while it lasts."""


class LimitPublisher:
    """Publishes what limits the velocities that others ask for, as they drive: no plan, no step, whose limit it is."""

    def __init__(self, emit: Callable[[Event], None]) -> None:
        self._emit = emit
        self._rule, self._told_s = "", -math.inf

    def note(self, verdict: Verdict, now_s: float) -> None:
        """Take note of what became of one velocity."""
        due_s = SAME_LIMIT_S if verdict.rule == self._rule else CHANGED_LIMIT_S
        if now_s - self._told_s >= due_s and is_worth_telling(verdict):
            self._rule, self._told_s = verdict.rule, now_s
            self._emit(Limited(0, verdict.rule, verdict.asked, verdict.allowed, verdict.reason))


SCAN_S = 0.2


class ScanPublisher:
    """Publishes what the lidar sees, while somebody watches. Belongs to the control thread.

    A watcher whose lease is over watches no more, whatever became of it.
    """

    def __init__(
        self, lidar: Lidar | None, sensors: Sensors, leases: Leases, emit: Callable[[Event], None]
    ) -> None:
        self._lidar = lidar
        self._sensors = sensors
        self._leases = leases
        self._emit = emit
        self._watchers: set[str] = set()
        self._shown: LaserScan | None = None
        self._next_s = 0.0

    def watch(self, lease: str, *, on: bool) -> None:
        """Publish for that client, or not any more."""
        if on and self._leases.is_known(lease):
            self._watchers.add(lease)
        else:
            self._watchers.discard(lease)

    def tick(self, now_s: float) -> None:
        """Publish a new scan every `SCAN_S`."""
        lidar, scan = self._lidar, self._sensors.scan
        if not self._watchers or lidar is None or now_s < self._next_s or scan is None or scan is self._shown:
            return
        self._watchers = {lease for lease in self._watchers if self._leases.is_valid(lease, now_s)}
        self._next_s, self._shown = now_s + SCAN_S, scan
        pose = self._sensors.estimator.pose_at(scan.stamp_s)
        if pose is not None and self._watchers:
            self._emit(Scan(0, pose, scan_points_m(lidar, scan, pose)))


SECTORS = 8
"""Each 45 degrees wide; the first is centred on straight ahead, the next lie to the left of it, counter-clockwise."""


def sectors_m(profile: RobotProfile, scan: LaserScan | None) -> tuple[float | None, ...]:
    """Return the metres from the footprint's edge to the nearest return in each sector, in the robot's frame.

    None in a sector where nothing is seen; empty where there is no lidar or it has not spoken.
    """
    lidar = profile.lidar
    if lidar is None or scan is None:
        return ()
    ranges_m = np.asarray(scan.ranges_m)
    is_valid = (ranges_m >= scan.range_min_m) & (ranges_m <= scan.range_max_m)
    at_rad = scan.angle_min_rad + np.flatnonzero(is_valid) * scan.angle_increment_rad + lidar.yaw_rad
    x_m = lidar.x_m + ranges_m[is_valid] * np.cos(at_rad)
    y_m = lidar.y_m + ranges_m[is_valid] * np.sin(at_rad)
    off_m = np.maximum(np.hypot(x_m, y_m), 1e-6)
    corners = np.asarray(profile.footprint)
    reach_m = (np.outer(x_m, corners[:, 0]) + np.outer(y_m, corners[:, 1])).max(axis=1, initial=0.0) / off_m
    sector = np.rint(np.arctan2(y_m, x_m) / (2.0 * math.pi) * SECTORS).astype(int) % SECTORS
    nearest_m = np.full(SECTORS, math.inf)
    np.minimum.at(nearest_m, sector, np.maximum(off_m - reach_m, 0.0))
    return tuple(round(float(free_m), 2) if math.isfinite(free_m) else None for free_m in nearest_m)
