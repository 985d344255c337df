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
REORDERED_S = 1.0
HISTORY = 100
"""Estimates kept to tell where a scan was made: a second of them."""

JUMP_MARGIN_M = 0.15
JUMP_MARGIN_RAD = math.radians(25.0)
GAP_S = 0.5
"""After this long without a word the robot may have been switched off and on, and count from zero again."""

CREEPING_MPS, CREEPING_RADPS = 0.03, 0.1
"""Slower than this it goes nowhere in a gap; noise of a standing robot is below."""

_GAP_POINTS = 50


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
        if -REORDERED_S < dt <= 0.0:
            return  # overtaken on its way: its time has been counted
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
        jump = self._jump(step, Twist(*last[4:7]), dt)
        if jump is not None:
            self.fault = jump
            self.epoch += 1
            self._gyro_yaw_at_odometry = self._gyro_yaw
            return
        self._advance(message, step)

    def _jump(self, step: Pose, before: Twist, dt_s: float) -> Reason | None:
        """Why a robot that did `before` cannot have made that step in `dt_s`; None where it can."""
        limits = self._limits
        if dt_s <= GAP_S:
            off_m = math.hypot(step.x_m, step.y_m) - 2.0 * limits.max_speed_mps * dt_s
            off_rad = abs(wrap_angle(step.yaw_rad)) - 2.0 * limits.max_rate_radps * dt_s
        else:
            off_m, off_rad = _off_course(step, before, limits, dt_s)
        if off_m > JUMP_MARGIN_M:
            return Reason("odometry_jumped", {"jump_m": round(math.hypot(step.x_m, step.y_m), 2)})
        if off_rad > JUMP_MARGIN_RAD:
            return Reason("odometry_swung", {"jump_deg": round(math.degrees(wrap_angle(step.yaw_rad)))})
        return None

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


def _off_course(step: Pose, before: Twist, limits: Limits, gap_s: float) -> tuple[float, float]:
    """How far, in metres and radians, `step` is from all that the robot may have done in a gap of `gap_s`.

    It stood, or went on along the course it was on, for a while and at any speed up to its limit.
    """
    moves = before.speed_mps >= CREEPING_MPS or abs(before.wz_radps) >= CREEPING_RADPS
    gain = math.inf
    if before.speed_mps > 0.0:
        gain = limits.max_speed_mps / before.speed_mps
    if before.wz_radps:
        gain = min(gain, limits.max_rate_radps / abs(before.wz_radps))
    fastest = before.scaled(max(1.0, gain)) if moves else Twist()
    offs = []
    for i in range(_GAP_POINTS + 1):
        there = Pose().moved(fastest, gap_s * i / _GAP_POINTS)
        # Between two points, and 10 % for wheels that slip.
        slack_m = fastest.speed_mps * gap_s * (0.5 / _GAP_POINTS + 0.1 * i / _GAP_POINTS)
        turn_rad = abs(wrap_angle(step.yaw_rad - there.yaw_rad))
        slack_rad = abs(fastest.wz_radps) * gap_s * (0.5 / _GAP_POINTS + 0.1 * i / _GAP_POINTS)
        offs.append((there.distance_to(step) - slack_m, turn_rad - slack_rad))
    return min(offs, key=lambda off: max(off[0] / JUMP_MARGIN_M, off[1] / JUMP_MARGIN_RAD))
