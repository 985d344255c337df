"""What the robot tells: the newest of each sensor, when it came, and what that says of what it was told to do."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from chatrobot.core.clock import Clock
from chatrobot.core.geometry import Pose, Twist
from chatrobot.execution.estimator import Estimate, PoseEstimator
from chatrobot.execution.response import Response
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import Flag, Imu, LaserScan, Number, Odometry
from chatrobot.wire.wire import Wire, subscribe_sensors

OLD_NEWS_S = 0.5
"""What was measured longer ago is as old as that, however lately it came."""


NO_RETURN_M = 0.001
"""Zero is how cheap lidars say "no return", also those whose drivers call zero their minimum range."""


class Sensors:
    """Listens to one robot. `attach` subscribes; the rest is reading. Ages are by the receiver's clock."""

    def __init__(self, profile: RobotProfile, clock: Clock) -> None:
        self._profile = profile
        self._clock = clock
        self.estimator = PoseEstimator(profile.limits, profile.calibration)
        self.response = Response()
        self.scan: LaserScan | None = None
        self.bumped = False
        self.battery_percent: float | None = None
        self._attached_at_s = math.inf
        self._has_scanned = False
        self._odometry_at_s = -math.inf
        self._imu_at_s = -math.inf
        self._scan_at_s = -math.inf

    def attach(self, wire: Wire) -> None:
        """Subscribe to what the profile says the robot has."""
        self._attached_at_s = self._clock.now_s()
        hear: dict[str, Callable[[Any], None]] = {
            "odom": self._on_odometry,
            "imu": self._on_imu,
            "scan": self._on_scan,
            "bumper": self._on_bumper,
            "battery": self._on_battery,
        }
        subscribe_sensors(wire, self._profile.wiring, hear)

    def awaits_first_scan(self, due_s: float) -> bool:
        """No scan has come yet, nor would it have to: it has listened for less than `due_s`."""
        return not self._has_scanned and self._clock.now_s() - self._attached_at_s <= due_s

    @property
    def has_odometry(self) -> bool:
        """True where the profile says that the robot measures its motion."""
        return bool(self._profile.wiring.odom_topic)

    @property
    def estimate(self) -> Estimate | None:
        return self.estimator.estimate

    def odometry_age_s(self) -> float:
        """How old the newest odometry is, seconds; infinite before the first."""
        made_s = self.estimate.stamp_s if self.estimate is not None else -math.inf
        return self._age_s(self._odometry_at_s, made_s)

    def ages_s(self) -> dict[str, float]:
        """How old the newest word of each sensor is, seconds, by name; infinite before the first word."""
        made_s = self.scan.stamp_s if self.scan is not None else -math.inf
        return {
            "odom": self.odometry_age_s(),
            "imu": self._clock.now_s() - self._imu_at_s,
            "scan": self._age_s(self._scan_at_s, made_s),
        }

    def _age_s(self, came_s: float, made_s: float) -> float:
        """Since it came; but fresh mail with old news (a wire that is late, a clock that was set back) is no news."""
        now_s = self._clock.now_s()
        return now_s - (came_s if now_s - made_s <= OLD_NEWS_S else min(came_s, made_s))

    def pose_now(self) -> Pose | None:
        """Where the robot is by now, if it went on as odometry last saw it; None before the first."""
        estimate = self.estimate
        if estimate is None:
            return None
        late_s = max(0.0, min(self._clock.now_s() - estimate.stamp_s, OLD_NEWS_S))
        return estimate.pose.moved(estimate.twist, late_s)

    def note_sent(self, twist: Twist) -> None:
        """The robot has been sent `twist`, or is about to be."""
        now_s, estimate = self._clock.now_s(), self.estimate
        self.estimator.rest.note_command(is_zero=twist.is_zero, now_s=now_s)
        if estimate is not None:
            rolled_m = estimate.path_m / self._profile.calibration.distance_scale
            turned_rad = self.estimator.wheel_yaw_rad
            self.response.see(estimate.stamp_s, rolled_m, turned_rad)
            self.response.tell(twist, now_s, rolled_m, turned_rad)

    def _on_imu(self, message: Imu) -> None:
        self._imu_at_s = self._clock.now_s()
        self.estimator.on_imu(message)

    def _on_odometry(self, message: Odometry) -> None:
        self._odometry_at_s = self._clock.now_s()
        self.estimator.on_odometry(message)

    def _on_scan(self, message: LaserScan) -> None:
        self._has_scanned = True
        scan = _usable(message)
        if scan is not None:  # one that shows nothing is as good as silence
            self._scan_at_s = self._clock.now_s()
            self.scan = scan

    def _on_bumper(self, message: Flag) -> None:
        self.bumped = message.data

    def _on_battery(self, message: Number) -> None:
        self.battery_percent = message.data


def _usable(scan: LaserScan) -> LaserScan | None:
    """The scan, or None where no beam shows anything: a lidar that is covered or broken, a driver that fills in none
    of its limits. Plus infinity does show something: that nothing is there (REP-117)."""
    near_m, far_m = max(scan.range_min_m, NO_RETURN_M), scan.range_max_m
    shows = near_m < far_m and any(
        near_m <= range_m <= far_m or range_m == math.inf for range_m in scan.ranges_m
    )
    return scan._replace(range_min_m=near_m) if shows else None
