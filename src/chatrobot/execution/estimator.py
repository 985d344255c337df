"""Pose estimation from wheel odometry and, where there is one, a gyro.

Wheels that slip overstate both how far and how much the robot turned; a gyro only has a bias, and that can be
measured while the robot is at rest. So distances come from the wheels and headings from the gyro.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from chatrobot.core.geometry import Pose, Twist, wrap_angle
from chatrobot.core.reason import Reason
from chatrobot.execution.heading import Heading
from chatrobot.robots.profile import Calibration, Limits
from chatrobot.wire.messages import Imu, Odometry

STANDING_SPEED_MPS = 0.005
STANDING_RATE_RADPS = 0.02
SETTLED_S = 0.15
"""A robot that was told to stand has braked and rocks no more after so long."""
UNROLLED_S = 0.06
"""Wheels stand when several messages in a row have said so."""


class Rest:
    """Tells since when the robot has been at rest: told to stand, and seen not to roll.

    A gyro's bias may only be learned then. That the wheels look slow is not enough: a robot that is told to creep
    does. `note_command` may come from another thread than `see`.
    """

    def __init__(self) -> None:
        self.told_since_s = -math.inf
        """Since when it is told to stand; infinite where it was told to move, minus infinity if never."""
        self._still_since_s = math.inf

    def note_command(self, *, is_zero: bool, now_s: float) -> None:
        """Note that the robot has just been told to stand, or to move."""
        if not is_zero:
            self.told_since_s = math.inf
        elif self.told_since_s == math.inf:
            self.told_since_s = now_s

    def see(self, message: Odometry) -> None:
        """Take what its wheels do."""
        speed_mps = math.hypot(message.vx_mps, message.vy_mps)
        if speed_mps >= STANDING_SPEED_MPS or abs(message.wz_radps) >= STANDING_RATE_RADPS:
            self._still_since_s = math.inf
        elif self._still_since_s == math.inf:
            self._still_since_s = message.stamp_s

    @property
    def since_s(self) -> float:
        """Return since when it has been at rest, once the body was still, too; infinite where it moves."""
        return max(self.told_since_s + SETTLED_S, self._still_since_s + UNROLLED_S)


HISTORY = 100
"""Estimates kept to tell where a scan was made: a second of them."""

JUMP_MARGIN_M = 0.15
JUMP_MARGIN_RAD = math.radians(25.0)
GAP_S = 0.5
"""After this long without a word the robot may have been switched off and on, and count from zero again."""

CREEPING_MPS, CREEPING_RADPS = 0.03, 0.1
"""Slower than this it goes nowhere in a gap; noise of a standing robot is below."""

_GAP_POINTS = 50


def stands(twist: Twist) -> bool:
    """Tell whether it is too slow to be seen moving."""
    return twist.speed_mps < STANDING_SPEED_MPS and abs(twist.wz_radps) < STANDING_RATE_RADPS


class Estimate(NamedTuple):
    """The robot at `stamp_s` of the sender's clock: pose in `odom` (yaw unwrapped), velocity in `base_link`."""

    stamp_s: float
    pose: Pose
    twist: Twist
    path_m: float

    @property
    def is_standing(self) -> bool:
        """Return True where it moves too slowly to be seen moving."""
        return stands(self.twist)


class PoseEstimator:
    """Fuses odometry and gyro, corrected as a person measured.

    Feed it messages as they come, on one thread; on any, read `pose_at`, `estimate`, `fault`, `wheel_yaw_rad`.
    """

    def __init__(self, limits: Limits, calibration: Calibration = Calibration()) -> None:  # noqa: B008
        self._limits = limits
        self._distance_scale, self._turn_scale = calibration.distance_scale, calibration.turn_scale
        self._last: Odometry | None = None
        self.rest = Rest()
        self._heading = Heading(self._turn_scale)
        self._turned_rad = 0.0
        self.estimate: Estimate | None = None
        self._history: tuple[Estimate, ...] = ()
        """Made anew with each sample: it is read on another thread than the one that hears odometry."""
        self.wheel_yaw_rad = 0.0
        """Total turn by the wheels alone: where it parts from the gyro's, wheels slip."""
        self.fault: Reason | None = None
        """Set when odometry says what cannot be (it jumped); the caller clears it once it has acted."""
        self.epoch = 0
        """Counts the times odometry began anew: coordinates of an older epoch mean nothing any more."""

    def pose_at(self, stamp_s: float) -> Pose | None:
        """Return where the robot was at `stamp_s`, to one odometry sample; None before the first."""
        history = self._history
        for estimate in reversed(history):
            if estimate.stamp_s <= stamp_s:
                return estimate.pose
        return history[0].pose if history else None

    def on_imu(self, message: Imu) -> None:
        """Take a gyro sample; it counts with the next odometry."""
        self._heading.on_imu(message)

    def on_odometry(self, message: Odometry) -> None:
        """Take a wheel odometry sample."""
        if not all(map(math.isfinite, message)):
            self.fault = Reason("odometry_not_finite")
            return
        last, self._last = self._last, message
        if last is None or self.estimate is None:
            self._begin(message)
            return
        dt = message.stamp_s - last.stamp_s
        if dt <= 0.0:
            self._last = last
            return
        self.rest.see(message)
        step = Pose(*message[1:4]).relative_to(Pose(*last[1:4]))
        jump = self._jump(step, Twist(*last[4:7]), dt)
        if jump is not None:
            self.fault = jump
            self.epoch += 1
            self._turn(message)
            return
        self._advance(message, step)

    def _jump(self, step: Pose, before: Twist, dt_s: float) -> Reason | None:
        """Return why a robot that did `before` cannot have made that step in `dt_s`; None where it can."""
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
        self.rest.see(message)
        self._turn(message)
        self.estimate = Estimate(message.stamp_s, Pose(*message[1:4]), Twist(*message[4:7]), 0.0)
        self._history = (*self._history[1 - HISTORY :], self.estimate)

    def _turn(self, message: Odometry) -> float:
        """Return how much it has turned since the message before."""
        before_rad = self._turned_rad
        self._turned_rad = self._heading.at(message.stamp_s, self.wheel_yaw_rad, self.rest.since_s)
        return self._turned_rad - before_rad

    def _advance(self, message: Odometry, step: Pose) -> None:
        assert self.estimate is not None
        wheel_turn = wrap_angle(step.yaw_rad)
        self.wheel_yaw_rad += wheel_turn
        turn = self._turn(message)
        rate = self._heading.rate_radps(message.stamp_s, message.wz_radps)
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
        self._history = (*self._history[1 - HISTORY :], self.estimate)


def _off_course(step: Pose, before: Twist, limits: Limits, gap_s: float) -> tuple[float, float]:
    """Return how far, in metres and radians, `step` is from all that the robot may have done in a gap of `gap_s`.

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
