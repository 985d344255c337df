"""The simulated robot's sensors: encoders, gyro and a planar lidar."""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING

from chatrobot.core.geometry import Pose, Twist
from chatrobot.robots.profile import Lidar
from chatrobot.sim.contact import Surroundings
from chatrobot.sim.fault_injection import (
    ENCODER_NOISE,
    GYRO_NOISE_RADPS,
    LIDAR_NOISE_M,
    ODOM_JUMP_M,
    FaultInjection,
)
from chatrobot.wire.messages import Imu, LaserScan, Odometry

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class WheelOdometry:
    """Sums up a pose from encoders alone: heading too comes from the wheels."""

    def __init__(self, faults: FaultInjection) -> None:
        self._faults = faults
        self._noise = random.Random(f"encoders {faults.seed}") if faults.noise else None
        self._losses = random.Random(f"dropout {faults.seed}")
        self._forward = -1.0 if faults.odom_wrong == "reversed" else 1.0
        self._left = -1.0 if faults.odom_wrong == "turn_reversed" else 1.0
        self._jumped = False
        self._velocity = Twist()
        self.pose = Pose()

    def roll(self, wheels: Twist, duration_s: float) -> None:
        """Let the wheels turn at a constant `wheels` for `duration_s`."""
        if not wheels.is_zero:
            if self._noise is not None:
                gauss = self._noise.gauss
                wheels = Twist(
                    wheels.vx_mps * gauss(1.0, ENCODER_NOISE),
                    wheels.vy_mps * gauss(1.0, ENCODER_NOISE),
                    wheels.wz_radps * gauss(1.0, ENCODER_NOISE),
                )
            if self._faults.odom_wrong != "right":
                vx, vy, wz = wheels
                wheels = Twist(self._forward * vx, self._forward * vy, self._left * wz)
            self.pose = self.pose.moved(wheels, duration_s)
        self._velocity = wheels

    def read(self, stamp_s: float, elapsed_s: float) -> Odometry | None:
        """Return the message of this moment, its heading in [-pi, pi] as a quaternion gives it; None if it is lost."""
        faults = self._faults
        if elapsed_s >= faults.odom_silent_after_s:
            return None
        if elapsed_s >= faults.odom_jump_after_s and not self._jumped:
            self._jumped = True
            self.pose = self.pose.compose(Pose(0.0, ODOM_JUMP_M, 0.0))
        if faults.dropout > 0.0 and self._losses.random() < faults.dropout:
            return None
        if faults.odom_wrong == "frozen":
            return Odometry(stamp_s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if faults.odom_wrong == "nan":
            return Odometry(stamp_s, math.nan, math.nan, math.nan, math.nan, math.nan, math.nan)
        x_m, y_m, yaw_rad = self.pose
        return Odometry(stamp_s, x_m, y_m, math.remainder(yaw_rad, math.tau), *self._velocity)


class Gyro:
    """Measures the rate of turn of the body, with a bias and noise: blind to what the wheels do."""

    def __init__(self, faults: FaultInjection) -> None:
        self._bias_radps = faults.bias_radps
        self._noise = random.Random(f"gyro {faults.seed}") if faults.noise else None

    def read(self, stamp_s: float, true_rate_radps: float) -> Imu:
        """Return the message of this moment."""
        rate_radps = true_rate_radps + self._bias_radps
        if self._noise is not None:
            rate_radps += self._noise.gauss(0.0, GYRO_NOISE_RADPS)
        return Imu(stamp_s, rate_radps)


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
        """Return what it sees from a robot at `robot`; ranges in whole millimetres."""
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
