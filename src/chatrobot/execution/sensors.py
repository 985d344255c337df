"""The robot's sensors: the newest of each sensor, how old it is, and how the robot does what it is told.

A base that follows late makes good at the end of a motion what it owed at the start. Where feedback takes that debt
for an error and drives it, the robot goes too far by just as much; so feedback has to know how late the base is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from chatrobot.core.clock import Clock
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.execution.estimator import Estimate, PoseEstimator
from chatrobot.robots.profile import Lidar, RobotProfile
from chatrobot.wire.messages import Flag, Imu, LaserScan, Number, Odometry
from chatrobot.wire.wire import Wire, subscribe_sensors

STEADY_SHARE = 0.1
STEADY_S = 0.15
"""A base has caught up with a velocity that has been held for so long, give or take that share of it."""
GAINING_S = 0.15
"""While it still gains speed, so long after its start, there is a first guess; none before."""
LONGEST_S = 1.5
"""Later after its start it may owe for other reasons."""
LEAST_MPS, LEAST_RADPS = 0.1, 0.2
"""From slower motion nothing can be told."""
LATEST_S = 0.15
"""A base that is later than that has another fault."""
SCAN_POINTS = 180


class _Debt:
    """Sums up what was told and not yet done, of either the way (m) or the turn (rad)."""

    def __init__(self, least: float) -> None:
        self._least = least
        self._told = 0.0
        self._speed = 0.0
        self._began_at = 0.0
        self._began_s = self._steady_since_s = -math.inf
        self.is_measured = True

    def begin(self, done: float, now_s: float) -> None:
        self._told, self._began_at = 0.0, done
        self._began_s = self._steady_since_s = now_s
        self.is_measured = False

    def tell(self, speed: float, now_s: float, held_s: float) -> None:
        """Tell it to do `speed` from now on; what it was told before has been held for `held_s`."""
        self._told += self._speed * held_s
        if abs(speed - self._speed) > STEADY_SHARE * abs(speed):
            self._steady_since_s = now_s
        self._speed = speed

    def late_s(self, done: float, stamp_s: float, told_s: float, *, guesses: bool) -> float | None:
        """Return how late it is, once that shows.

        Args:
            told_s: since when it is told what it is told now.
            guesses: a first guess will do.
        """
        if self.is_measured or abs(self._speed) < self._least:
            return None
        is_steady = stamp_s - self._steady_since_s >= STEADY_S
        if stamp_s - self._began_s > LONGEST_S or (not is_steady and not guesses):
            return None
        if stamp_s - self._began_s < GAINING_S:
            return None
        self.is_measured = is_steady
        owed = self._told + self._speed * (stamp_s - told_s) - (done - self._began_at)
        return owed / self._speed


class Response:
    """Measures how late the robot does what it is told, whenever it sets out; `lag_s` is the last result.

    It belongs to the thread that sends.
    """

    def __init__(self) -> None:
        self.lag_s = 0.0
        self._is_guess = True
        self._way, self._turn = _Debt(LEAST_MPS), _Debt(LEAST_RADPS)
        self._twist = ZERO_TWIST
        self._told_s = 0.0

    def tell(self, twist: Twist, now_s: float, path_m: float, turned_rad: float) -> None:
        """Tell the robot `twist` from now on; its wheels have rolled and turned so far in all."""
        if self._twist.is_zero and not twist.is_zero:
            self._way.begin(path_m, now_s)
            self._turn.begin(turned_rad, now_s)
            self._told_s = now_s
        held_s = now_s - self._told_s
        self._way.tell(twist.speed_mps, now_s, held_s)
        self._turn.tell(twist.wz_radps, now_s, held_s)
        self._twist, self._told_s = twist, now_s

    def see(self, stamp_s: float, path_m: float, turned_rad: float) -> None:
        """Take how far its wheels had rolled and turned by `stamp_s`."""
        for debt, done in ((self._way, path_m), (self._turn, turned_rad)):
            late_s = debt.late_s(done, stamp_s, self._told_s, guesses=self._is_guess)
            if late_s is not None:
                self.lag_s = max(0.0, min(LATEST_S, late_s))
                self._is_guess = self._is_guess and not debt.is_measured


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
        """Return True where no scan has come yet, nor would it have to: it has listened for less than `due_s`."""
        return not self._has_scanned and self._clock.now_s() - self._attached_at_s <= due_s

    @property
    def has_odometry(self) -> bool:
        """Return True where the profile says that the robot measures its motion."""
        return bool(self._profile.wiring.odom_topic)

    @property
    def estimate(self) -> Estimate | None:
        """Return the newest estimate; None before the first odometry."""
        return self.estimator.estimate

    def odometry_age_s(self) -> float:
        """Return how old the newest odometry is, seconds; infinite before the first."""
        made_s = self.estimate.stamp_s if self.estimate is not None else -math.inf
        return self._age_s(self._odometry_at_s, made_s)

    def ages_s(self) -> dict[str, float]:
        """Return how old the newest word of each sensor is, seconds, by name; infinite before the first word."""
        made_s = self.scan.stamp_s if self.scan is not None else -math.inf
        return {
            "odom": self.odometry_age_s(),
            "imu": self._clock.now_s() - self._imu_at_s,
            "scan": self._age_s(self._scan_at_s, made_s),
        }

    def _age_s(self, came_s: float, made_s: float) -> float:
        """Return its age; fresh mail with old news (a late wire, a clock that was set back) is as old as the news."""
        now_s = self._clock.now_s()
        return now_s - (came_s if now_s - made_s <= OLD_NEWS_S else min(came_s, made_s))

    def pose_now(self) -> Pose | None:
        """Return where the robot is by now, if it went on as odometry last saw it; None before the first."""
        estimate = self.estimate
        if estimate is None:
            return None
        late_s = max(0.0, min(self._clock.now_s() - estimate.stamp_s, OLD_NEWS_S))
        return estimate.pose.moved(estimate.twist, late_s)

    def note_sent(self, twist: Twist) -> None:
        """Note that the robot has been sent `twist`, or is about to be."""
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
    """Return the scan; None where no beam shows anything: a covered lidar, a driver that fills in none of its limits.

    Plus infinity does show something: that nothing is there (REP-117).
    """
    near_m, far_m = max(scan.range_min_m, NO_RETURN_M), scan.range_max_m
    shows = near_m < far_m and any(
        near_m <= range_m <= far_m or range_m == math.inf for range_m in scan.ranges_m
    )
    return scan._replace(range_min_m=near_m) if shows else None


ODOMETRY_LATE_S = 0.13
"""Odometry comes ten times a second at least: with news older than this the robot goes slower."""
ODOMETRY_SILENT_S = 0.2
"""With news as old as this it is told to stand: it then does within 250 ms."""
ODOMETRY_LOST_S = 0.45
"""A packet that a bad Wi-Fi lost is there again after a quarter of a second: it stands and waits for no longer."""
MOVING_MPS, MOVING_RADPS = 0.03, 0.1
"""Above these it clearly moves; noise of a standing robot is below."""
FRESH_S = 0.3
"""Odometry older than this shows nothing."""
SAME_MOMENT_S = 0.001
"""Stamps closer than this are of one moment: sums of clock ticks differ by rounding."""
SETTLE_S = 0.8
"""The longest wait, at the end of a plan, for a robot to be seen standing that is not seen moving."""
STANDS_LATE_S = 2.0
"""A robot that is told to stand and clearly moves after this long does not obey."""


def sensor_fault(sensors: Sensors) -> Reason | None:
    """Return the reason where odometry is silent or says what cannot be."""
    if not sensors.has_odometry:
        return None
    age_s = sensors.odometry_age_s()
    if age_s > ODOMETRY_LOST_S:
        return silence(sensors)
    fault, sensors.estimator.fault = sensors.estimator.fault, None
    return fault


def silence(sensors: Sensors) -> Reason:
    """Return how long odometry has been silent, as a reason."""
    return Reason("odometry_silent", {"age_s": round(min(sensors.odometry_age_s(), 999.0), 2)})


def freshness(sensors: Sensors) -> float:
    """Return the share of its speed, 0 to 1, for odometry as old as now: less where it is late, 0 where silent."""
    if not sensors.has_odometry:
        return 1.0
    left_s = ODOMETRY_SILENT_S - sensors.odometry_age_s()
    return max(0.0, min(1.0, left_s / (ODOMETRY_SILENT_S - ODOMETRY_LATE_S)))


def is_seen_moving(sensors: Sensors) -> bool:
    """Return True where odometry shows clearly, and just now, that it moves."""
    estimate = sensors.estimate
    if estimate is None or sensors.odometry_age_s() >= FRESH_S:
        return False
    return estimate.twist.speed_mps > MOVING_MPS or abs(estimate.twist.wz_radps) > MOVING_RADPS


def patience_s(sensors: Sensors) -> float:
    """Return how long a robot that was told to stand may take; for ever while nobody sees it: that ends otherwise."""
    if sensors.odometry_age_s() >= FRESH_S:
        return math.inf
    return STANDS_LATE_S if is_seen_moving(sensors) else SETTLE_S


def is_seen_standing(sensors: Sensors, since_s: float = -math.inf) -> bool:
    """Return True where it is told to stand, and odometry of after that (and of `since_s`) shows that it does."""
    estimate = sensors.estimate
    if estimate is None or not estimate.is_standing or sensors.odometry_age_s() >= FRESH_S:
        return False
    return estimate.stamp_s - max(since_s, sensors.estimator.rest.told_since_s) > SAME_MOMENT_S


def scan_points_m(lidar: Lidar, scan: LaserScan, pose: Pose) -> tuple[tuple[float, float], ...]:
    """Return what the lidar saw from `pose`, in `odom`: of neighbouring beams the nearest return, to the centimetre."""
    origin = pose.compose(Pose(lidar.x_m, lidar.y_m, lidar.yaw_rad))
    ranges, first_rad = scan.ranges_m, origin.yaw_rad + scan.angle_min_rad
    together = math.ceil(len(ranges) / SCAN_POINTS)
    points = []
    for start in range(0, len(ranges), max(together, 1)):
        seen = [
            (distance_m, start + offset)
            for offset, distance_m in enumerate(ranges[start : start + together])
            if scan.range_min_m <= distance_m <= scan.range_max_m
        ]
        if seen:
            distance_m, beam = min(seen)
            angle_rad = first_rad + beam * scan.angle_increment_rad
            x_m = origin.x_m + distance_m * math.cos(angle_rad)
            points.append((round(x_m, 2), round(origin.y_m + distance_m * math.sin(angle_rad), 2)))
    return tuple(points)
