"""A planar lidar: rays from where it is mounted to what stands around."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import Lidar
from chatrobot.sim.contact import Surroundings
from chatrobot.sim.fault_injection import LIDAR_NOISE_M, FaultInjection
from chatrobot.wire.messages import LaserScan

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class SimLidar:
    """Scans all around from -pi on. No return is `inf`, nearer than the lidar can see is `-inf` (REP-117).

    Unless the injected faults say that it is a cheap one, or looks at a part of the circle only.
    """

    def __init__(self, lidar: Lidar, faults: FaultInjection) -> None:
        self._lidar = lidar
        self._faults = faults
        self._mounting = Pose(lidar.x_m, lidar.y_m, lidar.yaw_rad)
        self._increment_rad = math.tau / lidar.beams
        self._unseen = math.ceil(lidar.beams * (360.0 - faults.lidar_fov_deg) / 720.0)
        """Beams that are missing at either end of the circle."""
        self._noise: np.random.Generator | None = None
        self.period_ticks = max(1, round(100.0 / lidar.rate_hz))

    def scan(self, stamp_s: float, robot: Pose, surroundings: Surroundings) -> LaserScan:
        """What it sees from a robot at `robot`; ranges in whole millimetres."""
        if surroundings.is_empty:
            ranges_m = [math.inf] * self._lidar.beams
        else:
            ranges_m = self._ranges(surroundings.raycast(robot.compose(self._mounting), self._lidar.beams))
        if self._faults.lidar_zeros:
            ranges_m = [range_m if math.isfinite(range_m) else 0.0 for range_m in ranges_m]
        lidar, first = self._lidar, self._unseen
        return LaserScan(
            stamp_s,
            -math.pi + first * self._increment_rad,
            self._increment_rad,
            lidar.min_range_m,
            lidar.max_range_m,
            ranges_m[first : max(first + 1, lidar.beams - first + 1)] if first else ranges_m,
        )

    def _ranges(self, true_m: NDArray[np.float64]) -> list[float]:
        import numpy as np

        if self._faults.noise:
            if self._noise is None:
                self._noise = np.random.default_rng(self._faults.seed)
            true_m = true_m + self._noise.normal(0.0, LIDAR_NOISE_M, true_m.shape)
        ranges_m = np.round(true_m, 3)
        ranges_m[true_m > self._lidar.max_range_m] = np.inf
        ranges_m[true_m < self._lidar.min_range_m] = -np.inf
        seen: list[float] = ranges_m.tolist()
        return seen
