"""What the simulated robot's encoders and gyro report of what its wheels and its body do."""

from __future__ import annotations

import math
import random

from chatrobot.core.geometry import Pose, Twist
from chatrobot.sim.fault_injection import ENCODER_NOISE, GYRO_NOISE_RADPS, ODOM_JUMP_M, FaultInjection
from chatrobot.wire.messages import Imu, Odometry


class WheelOdometry:
    """A pose summed up from encoders alone: heading too comes from the wheels."""

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
        """The wheels turn at a constant `wheels` for `duration_s`."""
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
        """The message of this moment, its heading in [-pi, pi] as a quaternion gives it; None if it is
        lost."""
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
    """The rate of turn of the body, with a bias and noise: blind to what the wheels do."""

    def __init__(self, faults: FaultInjection) -> None:
        self._bias_radps = faults.bias_radps
        self._noise = random.Random(f"gyro {faults.seed}") if faults.noise else None

    def read(self, stamp_s: float, true_rate_radps: float) -> Imu:
        """The message of this moment."""
        rate_radps = true_rate_radps + self._bias_radps
        if self._noise is not None:
            rate_radps += self._noise.gauss(0.0, GYRO_NOISE_RADPS)
        return Imu(stamp_s, rate_radps)
