"""What a robot is: limits (apart from its wiring), shape, sensors and motion budget. One TOML file a robot fills it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from chatrobot.core.wiring import Wiring as Wiring

MAX_DISTANCE_M = 100.0
MAX_TIME_S = 600.0
ENDLESS_PROGRAM_S = 60.0
"""How long a program runs whose rehearsal did not end, where nobody chose a time."""

MOST = 1e9
"""No number beyond it is a limit that anybody means."""

NONE = "none"
"""How no limit is written: on the command line, in profiles and in envelopes."""

OPEN_LOOP = "open_loop"
"""The code of the notice that a robot is driven open loop."""

EXCEEDED = frozenset(
    {"over_max_distance", "over_max_time", "over_shared_distance", "over_shared_time", "over_open_loop_time"}
)
"""The refusals of what is known to exceed its budget."""


@dataclass(frozen=True)
class MotionBudget:
    """A choice of limits. None: not chosen, so that the defaults above hold; infinite: no limit.

    `ceiling_s` bounds the time whatever is chosen: it is no choice, and `changed` keeps it.
    """

    max_distance_m: float | None = None
    max_time_s: float | None = None
    ceiling_s: float = field(default=math.inf, kw_only=True)

    @property
    def distance_m(self) -> float:
        """Return how far one text or program may drive."""
        return self.max_distance_m if self.max_distance_m is not None else MAX_DISTANCE_M

    @property
    def time_s(self) -> float:
        """Return how long one text or program may drive; while it waits it does not."""
        return min(self.max_time_s if self.max_time_s is not None else MAX_TIME_S, self.ceiling_s)

    @property
    def is_at_ceiling(self) -> bool:
        """No choice can make the time longer."""
        return self.time_s == self.ceiling_s

    @property
    def endless_program_s(self) -> float:
        """Return how long a program may run whose rehearsal did not end."""
        return min(self.max_time_s if self.max_time_s is not None else ENDLESS_PROGRAM_S, self.ceiling_s)

    def changed(self, choice: MotionBudget) -> MotionBudget:
        """With what `choice` chooses in place of this."""
        return MotionBudget(
            self.max_distance_m if choice.max_distance_m is None else choice.max_distance_m,
            self.max_time_s if choice.max_time_s is None else choice.max_time_s,
            ceiling_s=self.ceiling_s,
        )


NOT_CHOSEN = MotionBudget()


def read_limit(value: object) -> float:
    """The limit that a number above zero, or `none`, is.

    Raises:
        ValueError: it is neither.
    """
    if value == NONE:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 < value <= MOST:
        raise ValueError(f"{value!r} is neither a number above zero nor {NONE}")
    return float(value)


def limit_text(value: float | None) -> str:
    """For another process: `read_limit_text` reads it. Empty: not chosen."""
    return "" if value is None else NONE if math.isinf(value) else repr(value)


def read_limit_text(text: str) -> float | None:
    """The limit in `text`; None where it is empty.

    Raises:
        ValueError: it is neither a number above zero nor `none`.
    """
    if not text:
        return None
    return read_limit(text if text == NONE else float(text))


Kinematics = Literal["differential", "mecanum", "ackermann"]
Point = tuple[float, float]


@dataclass(frozen=True)
class Limits:
    """The bounds that the governor holds the robot to. All positive; planar, in the robot's frame.

    `max_speed_mps` bounds the combined linear speed hypot(vx, vy) too. `deceleration_mps2` and `latency_s`
    are what braking distance is computed from: v * latency + v^2 / (2 * deceleration).
    `min_turning_radius_m` is 0 for a base that can turn on the spot.

    Combined limit: no wheel rolls faster than `max_wheel_speed_mps`, where the fastest one rolls at
    |vx| + |vy| + |wz| * `wheel_reach_m`. The reach is half the track, for a mecanum base half the wheelbase more
    (Lynch and Park, Modern Robotics, 2017, section 13.2). The jerks bind what gains speed; infinite: not limited.
    """

    max_speed_mps: float
    max_sideways_mps: float
    max_rate_radps: float
    acceleration_mps2: float
    angular_acceleration_radps2: float
    deceleration_mps2: float
    latency_s: float
    min_turning_radius_m: float = 0.0
    max_wheel_speed_mps: float = math.inf
    wheel_reach_m: float = 0.0
    jerk_mps3: float = math.inf
    angular_jerk_radps3: float = math.inf

    def wheel_speed_mps(self, vx_mps: float, vy_mps: float, wz_radps: float) -> float:
        """Of the fastest wheel."""
        return abs(vx_mps) + abs(vy_mps) + abs(wz_radps) * self.wheel_reach_m


@dataclass(frozen=True)
class Defaults:
    """The numbers that are meant by a person who names none."""

    speed_mps: float
    rate_radps: float
    distance_m: float
    turn_rad: float


@dataclass(frozen=True)
class Lidar:
    """A planar laser scanner: where it sits in the robot's frame and what it can see."""

    x_m: float
    y_m: float
    yaw_rad: float
    beams: int
    min_range_m: float
    max_range_m: float
    rate_hz: float


@dataclass(frozen=True)
class Circle:
    """A circle in `odom`."""

    x_m: float
    y_m: float
    radius_m: float


@dataclass(frozen=True)
class Safety:
    """Rules of the governor besides the limits.

    `fence` is a circle, or the corners of a polygon, in `odom`: the footprint stays inside. Without the sensors in
    `requires` nothing moves. `blind_speed_mps` is for ways that the lidar does not see; 0 refuses them. Below
    `battery_low_percent` no motion begins. `budget` is what one text or program may drive.
    """

    fence: Circle | tuple[Point, ...] | None = None
    requires: tuple[Literal["odom", "scan", "imu"], ...] = ()
    blind_speed_mps: float = 0.1
    battery_low_percent: float | None = None
    budget: MotionBudget = NOT_CHOSEN


@dataclass(frozen=True)
class Calibration:
    """Factors that a person measured on this very robot: odometry times these is the truth.

    `turn_scale` is for the gyro where there is one, otherwise for the wheels.
    """

    distance_scale: float = 1.0
    turn_scale: float = 1.0
    source: str = ""


@dataclass(frozen=True)
class RobotProfile:
    """One robot. `footprint` is a convex polygon around (0, 0), counter-clockwise, metres, robot frame.

    `name` is that of the file it was read from. `sources` tells for every limit, by the name of its field in
    `Limits`, where its number comes from. `approval` says whether a plan needs a person's yes before it runs
    where nothing else is said. `open_loop`: it is driven although nothing measures its motion; no file can say so,
    `chatrobot.robots.open_loop` does.
    """

    name: str
    title: str
    kinematics: Kinematics
    limits: Limits
    defaults: Defaults
    footprint: tuple[Point, ...]
    wiring: Wiring = field(default_factory=Wiring)
    lidar: Lidar | None = None
    safety: Safety = field(default_factory=Safety)
    calibration: Calibration = Calibration()
    approval: Literal["plan", "stream"] = "plan"
    open_loop: bool = False
    sources: Mapping[str, str] = field(default_factory=dict)

    def with_budget(self, choice: MotionBudget) -> RobotProfile:
        """The same robot with what somebody chose in place of its own motion budget."""
        return replace(self, safety=replace(self.safety, budget=self.safety.budget.changed(choice)))

    @property
    def has_odometry(self) -> bool:
        """It measures its motion."""
        return bool(self.wiring.odom_topic)

    @property
    def can_turn_on_the_spot(self) -> bool:
        """It turns without driving."""
        return self.kinematics != "ackermann"

    @property
    def can_go_sideways(self) -> bool:
        """It drives to its left and right without turning."""
        return self.kinematics == "mecanum"

    @property
    def footprint_radius_m(self) -> float:
        """Of the circle about the robot's centre that holds the whole footprint."""
        return float(max((x * x + y * y) ** 0.5 for x, y in self.footprint))
