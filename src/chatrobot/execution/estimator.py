"""Where the robot is, from wheel odometry and, where there is one, a gyro.

Wheels that slip overstate both how far and how much the robot turned; a gyro only has a bias, and that can be
measured whenever the robot stands. So distances come from the wheels and headings from the gyro.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from chatrobot.core.geometry import Pose, Twist, wrap_angle
from chatrobot.core.reason import Reason
from chatrobot.robots.profile import Calibration, Limits
from chatrobot.wire.messages import Imu, Odometry

STANDING_SPEED_MPS = 0.005
STANDING_RATE_RADPS = 0.02
BIAS_WINDOW = 300
"""Gyro samples the bias is averaged over (3 s at 100 Hz); more would follow a warming gyro too slowly."""

PUSHED_RATE_RADPS = 0.06
"""Above this a "standing" robot is being turned by hand, and that is motion, not bias."""

IMU_SILENT_S = 0.2
HISTORY = 100
"""Estimates kept to tell where a scan was made: a second of them."""

JUMP_MARGIN_M = 0.15


@dataclass(frozen=True)
class Estimate:
    """The robot at `stamp_s` of the sender's clock: pose in `odom` (yaw unwrapped), velocity in `base_link`."""

    stamp_s: float
    pose: Pose
    twist: Twist
    path_m: float

    @property
    def is_standing(self) -> bool:
        return self.twist.speed_mps < STANDING_SPEED_MPS and abs(self.twist.wz_radps) < STANDING_RATE_RADPS


class PoseEstimator:
    """Fuses odometry and gyro, corrected as a person measured.

    Feed it messages as they come; read `estimate`, `fault`, `wheel_yaw_rad`.
    """

    def __init__(self, limits: Limits, calibration: Calibration = Calibration()) -> None:  # noqa: B008
        self._limits = limits
        self._distance_scale, self._turn_scale = calibration.distance_scale, calibration.turn_scale
        self._last: Odometry | None = None
        self._imu_at_s = -math.inf
        self._gyro_yaw = 0.0
        self._gyro_yaw_at_odometry = 0.0
        self._gyro_rate = 0.0
        self._bias = 0.0
        self._bias_samples = 0
        self._standing_since_s = math.inf
        self._doubtful: list[tuple[float, float]] = []
        self.estimate: Estimate | None = None
        self._history: deque[Estimate] = deque(maxlen=HISTORY)
        self.wheel_yaw_rad = 0.0
        """Total turn by the wheels alone: where it parts from the gyro's, wheels slip."""
        self.fault: Reason | None = None
        """Set when odometry says what cannot be (it jumped); the caller clears it once it has acted."""
        self.epoch = 0
        """Counts the times odometry began anew: coordinates of an older epoch mean nothing any more."""

    @property
    def has_gyro(self) -> bool:
        return self._bias_samples > 0

    def pose_at(self, stamp_s: float) -> Pose | None:
        """Where the robot was at `stamp_s`, to one odometry sample; None before the first."""
        for estimate in reversed(self._history):
            if estimate.stamp_s <= stamp_s:
                return estimate.pose
        return self._history[0].pose if self._history else None

    def on_imu(self, message: Imu) -> None:
        """A gyro sample: integrated while moving, averaged into the bias while standing."""
        dt = message.stamp_s - self._imu_at_s
        self._imu_at_s = message.stamp_s
        if not math.isfinite(message.wz_radps):
            return
        rate = message.wz_radps - self._bias
        resting = self._is_resting(message.stamp_s)
        if resting and (self._bias_samples < 20 or abs(rate) < PUSHED_RATE_RADPS):
            self._gyro_rate = 0.0
            self._doubtful.append((message.wz_radps, dt))
        else:
            self._integrate(message.wz_radps, dt)

    def _integrate(self, rate_radps: float, dt_s: float) -> None:
        if 0.0 < dt_s < IMU_SILENT_S:
            self._gyro_rate = (rate_radps - self._bias) * self._turn_scale
            self._gyro_yaw += self._gyro_rate * dt_s

    def _settle_doubtful(self, still: bool) -> None:
        """Gyro samples of a robot at rest: bias if the wheels were still after them too, else the first of a turn."""
        for rate_radps, dt_s in self._doubtful:
            if still:
                self._bias_samples = min(self._bias_samples + 1, BIAS_WINDOW)
                self._bias += (rate_radps - self._bias) / self._bias_samples
            else:
                self._integrate(rate_radps, dt_s)
        self._doubtful.clear()

    def on_odometry(self, message: Odometry) -> None:
        """A wheel odometry sample."""
        if not all(map(math.isfinite, message)):
            self.fault = Reason("odometry_not_finite")
            return
        self._settle_doubtful(_is_still(message))
        last, self._last = self._last, message
        if last is None or self.estimate is None:
            self._begin(message)
            return
        dt = message.stamp_s - last.stamp_s
        if dt <= 0.0:
            self._last = last
            return
        step = Pose(*message[1:4]).relative_to(Pose(*last[1:4]))
        if math.hypot(step.x_m, step.y_m) > 2.0 * self._limits.max_speed_mps * dt + JUMP_MARGIN_M:
            self.fault = Reason("odometry_jumped", {"jump_m": round(math.hypot(step.x_m, step.y_m), 2)})
            self.epoch += 1
            self._gyro_yaw_at_odometry = self._gyro_yaw
            return
        self._advance(message, step)

    def _begin(self, message: Odometry) -> None:
        self._gyro_yaw_at_odometry = self._gyro_yaw
        self.estimate = Estimate(message.stamp_s, Pose(*message[1:4]), Twist(*message[4:7]), 0.0)
        self._history.append(self.estimate)
        self._note_standing(message)

    def _advance(self, message: Odometry, step: Pose) -> None:
        assert self.estimate is not None
        wheel_turn = wrap_angle(step.yaw_rad)
        self.wheel_yaw_rad += wheel_turn
        turn = wheel_turn * self._turn_scale
        rate = message.wz_radps * self._turn_scale
        if self.has_gyro and message.stamp_s - self._imu_at_s < IMU_SILENT_S:
            # Odometry may come a sample before the gyro of the same moment: carry the heading on to its stamp.
            gyro_yaw = self._gyro_yaw + self._gyro_rate * (message.stamp_s - self._imu_at_s)
            turn = gyro_yaw - self._gyro_yaw_at_odometry
            rate = self._gyro_rate
            self._gyro_yaw_at_odometry = gyro_yaw
        else:
            self._gyro_yaw_at_odometry = self._gyro_yaw
        # The wheels' chord is seen at half their own turn; put it at half of the turn that really happened.
        swing = (turn - wheel_turn) / 2.0
        cos, sin = math.cos(swing), math.sin(swing)
        scale = self._distance_scale
        moved = Pose(
            scale * (cos * step.x_m - sin * step.y_m), scale * (sin * step.x_m + cos * step.y_m), turn
        )
        before = self.estimate
        self.estimate = Estimate(
            message.stamp_s,
            before.pose.compose(moved),
            Twist(scale * message.vx_mps, scale * message.vy_mps, rate),
            before.path_m + scale * math.hypot(step.x_m, step.y_m),
        )
        self._history.append(self.estimate)
        self._note_standing(message)

    def _note_standing(self, message: Odometry) -> None:
        if not _is_still(message):
            self._standing_since_s = math.inf
        elif self._standing_since_s == math.inf:
            self._standing_since_s = message.stamp_s

    def _is_resting(self, stamp_s: float) -> bool:
        """Standing for a moment already: what the gyro shows now is bias."""
        return stamp_s - self._standing_since_s > 0.06


def _is_still(message: Odometry) -> bool:
    """The wheels do not turn."""
    speed_mps = math.hypot(message.vx_mps, message.vy_mps)
    return speed_mps < STANDING_SPEED_MPS and abs(message.wz_radps) < STANDING_RATE_RADPS
