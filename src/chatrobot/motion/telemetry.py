"""What is told of the robot: ten times a second where it is, and on request what its lidar sees around it."""

from __future__ import annotations

import math
from collections.abc import Callable

from chatrobot.core.events import Event, Telemetry
from chatrobot.execution.sensors import Sensors
from chatrobot.execution.tracking import nearest_m
from chatrobot.motion.plan_executor import PlanExecutor
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

TELEMETRY_S = 0.1


class TelemetryPublisher:
    """Publishes how far the motion is, and where and how fast the robot goes, as it measures it itself."""

    def __init__(self, sensors: Sensors, executor: PlanExecutor, emit: Callable[[Event], None]) -> None:
        self._sensors = sensors
        self._executor = executor
        self._emit = emit
        self._next_s = 0.0

    def tick(self, now_s: float) -> None:
        """Tell it if it is time, and the robot has said where it is."""
        if now_s < self._next_s:
            return
        self._next_s = now_s + TELEMETRY_S
        estimate, scan = self._sensors.estimate, self._sensors.scan
        if estimate is None:
            return
        progress = self._executor.progress(now_s)
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
            )
        )


SECTORS = 8
"""Each 45 degrees wide; the first is centred on straight ahead, the next lie to the left of it, counter-clockwise."""


def sectors_m(profile: RobotProfile, scan: LaserScan | None) -> tuple[float | None, ...]:
    """Metres from the footprint's edge to the nearest return in each sector, in the robot's frame.

    None in a sector where nothing is seen; empty where there is no lidar or it has not spoken.
    """
    lidar = profile.lidar
    if lidar is None or scan is None:
        return ()
    nearest = [math.inf] * SECTORS
    for count, distance in enumerate(scan.ranges_m):
        if not scan.range_min_m <= distance <= scan.range_max_m:
            continue
        angle = scan.angle_min_rad + count * scan.angle_increment_rad + lidar.yaw_rad
        x, y = lidar.x_m + distance * math.cos(angle), lidar.y_m + distance * math.sin(angle)
        sector = round(math.atan2(y, x) / (2.0 * math.pi) * SECTORS) % SECTORS
        free_m = math.hypot(x, y) - _reach_m(profile, x, y)
        nearest[sector] = min(nearest[sector], max(0.0, free_m))
    return tuple(round(d, 2) if math.isfinite(d) else None for d in nearest)


def _reach_m(profile: RobotProfile, x_m: float, y_m: float) -> float:
    """How far the footprint reaches towards that point."""
    distance = math.hypot(x_m, y_m)
    if distance == 0.0:
        return 0.0
    return max(0.0, max((x * x_m + y * y_m) / distance for x, y in profile.footprint))
