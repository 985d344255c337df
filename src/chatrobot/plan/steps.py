"""The steps a plan is made of. Frozen, validated on construction, in units named by their fields.

A `Plan` round-trips through plan text (`chatrobot.plan.text`) and JSON (`chatrobot.plan.json_form`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Union

Frame = Literal["odom", "start"]
"""`odom`: where odometry began. `start`: the robot's pose at the moment this plan starts to move."""

MAX_REPEAT = 1000
MAX_WAIT_S = 3600.0


def _require(condition: bool, problem: str) -> None:
    if not condition:
        raise ValueError(problem)


def _positive(name: str, value: float | None) -> None:
    if value is not None:
        _require(
            math.isfinite(value) and value > 0.0, f"{name} must be a finite number above zero, not {value}"
        )


def _finite(name: str, value: float) -> None:
    _require(math.isfinite(value), f"{name} must be a finite number, not {value}")


@dataclass(frozen=True)
class ObstacleWithin:
    """True once the lidar sees something nearer than `distance_m` ahead of the footprint in the way of travel."""

    distance_m: float
    kind: Literal["obstacle_within"] = "obstacle_within"

    def __post_init__(self) -> None:
        _positive("distance_m", self.distance_m)


Condition = ObstacleWithin


@dataclass(frozen=True)
class Drive:
    """Go straight, keeping the heading: a distance or a time, and/or until a condition holds.

    `direction_rad` is the direction of travel in the robot's frame, 0 forward, pi/2 left, pi backward.
    At least one of `distance_m`, `duration_s`, `until`; not both distance and duration. With `until`, the
    distance or duration is the most it will do.
    """

    distance_m: float | None = None
    duration_s: float | None = None
    direction_rad: float = 0.0
    speed_mps: float | None = None
    until: Condition | None = None
    kind: Literal["drive"] = "drive"

    def __post_init__(self) -> None:
        _positive("distance_m", self.distance_m)
        _positive("duration_s", self.duration_s)
        _positive("speed_mps", self.speed_mps)
        _finite("direction_rad", self.direction_rad)
        _require(
            not (self.distance_m is None and self.duration_s is None and self.until is None),
            "a drive needs a distance, a duration or a condition",
        )
        _require(
            self.distance_m is None or self.duration_s is None,
            "a drive has a distance or a duration, not both (say the speed instead)",
        )


@dataclass(frozen=True)
class Turn:
    """Turn on the spot: `angle_rad` (positive; any size, 2 pi is a full turn) or `duration_s`, to the left or right."""

    angle_rad: float | None = None
    duration_s: float | None = None
    left: bool = True
    rate_radps: float | None = None
    kind: Literal["turn"] = "turn"

    def __post_init__(self) -> None:
        _positive("angle_rad", self.angle_rad)
        _positive("duration_s", self.duration_s)
        _positive("rate_radps", self.rate_radps)
        _require(
            (self.angle_rad is None) != (self.duration_s is None),
            "a turn needs an angle or a duration, and not both (say the rate instead)",
        )


@dataclass(frozen=True)
class Arc:
    """Drive a circular arc of `radius_m` about a point to the left or right, through `angle_rad` (positive)."""

    radius_m: float
    angle_rad: float
    left: bool = True
    backward: bool = False
    speed_mps: float | None = None
    kind: Literal["arc"] = "arc"

    def __post_init__(self) -> None:
        _positive("radius_m", self.radius_m)
        _positive("angle_rad", self.angle_rad)
        _positive("speed_mps", self.speed_mps)


@dataclass(frozen=True)
class RawTwist:
    """Hold a raw velocity for a time: the tutorial's form, where a line means one second."""

    vx_mps: float = 0.0
    vy_mps: float = 0.0
    wz_radps: float = 0.0
    duration_s: float = 1.0
    kind: Literal["twist"] = "twist"

    def __post_init__(self) -> None:
        _finite("vx_mps", self.vx_mps)
        _finite("vy_mps", self.vy_mps)
        _finite("wz_radps", self.wz_radps)
        _positive("duration_s", self.duration_s)


@dataclass(frozen=True)
class Go:
    """Go to a point, around what is known, and look along `yaw_rad` there if it is given.

    `place` is the name it was resolved from, for people to read; coordinates decide.
    """

    x_m: float
    y_m: float
    yaw_rad: float | None = None
    frame: Frame = "odom"
    place: str = ""
    speed_mps: float | None = None
    kind: Literal["go"] = "go"

    def __post_init__(self) -> None:
        _finite("x_m", self.x_m)
        _finite("y_m", self.y_m)
        if self.yaw_rad is not None:
            _finite("yaw_rad", self.yaw_rad)
        _positive("speed_mps", self.speed_mps)


@dataclass(frozen=True)
class Face:
    """Turn on the spot, the short way, until the heading in `frame` is `yaw_rad`."""

    yaw_rad: float
    frame: Frame = "start"
    rate_radps: float | None = None
    kind: Literal["face"] = "face"

    def __post_init__(self) -> None:
        _finite("yaw_rad", self.yaw_rad)
        _positive("rate_radps", self.rate_radps)


@dataclass(frozen=True)
class Wait:
    """Stand still."""

    duration_s: float
    kind: Literal["wait"] = "wait"

    def __post_init__(self) -> None:
        _positive("duration_s", self.duration_s)
        _require(
            self.duration_s <= MAX_WAIT_S, f"a wait is at most {MAX_WAIT_S:g} s, not {self.duration_s:g}"
        )


@dataclass(frozen=True)
class Say:
    """Say something to the person (an event; no motion). One line of text."""

    text: str
    kind: Literal["say"] = "say"

    def __post_init__(self) -> None:
        _require(self.text.isprintable() and bool(self.text.strip()), "say needs one line of printable text")


@dataclass(frozen=True)
class Remember:
    """Remember where the robot stands now under a name."""

    place: str
    kind: Literal["remember"] = "remember"

    def __post_init__(self) -> None:
        _require(self.place.isprintable() and bool(self.place.strip()), "a place needs a printable name")


@dataclass(frozen=True)
class Repeat:
    """Do the steps inside `count` times."""

    count: int
    steps: tuple[Step, ...]
    kind: Literal["repeat"] = "repeat"

    def __post_init__(self) -> None:
        _require(1 <= self.count <= MAX_REPEAT, f"a repeat count is 1 to {MAX_REPEAT}, not {self.count}")
        _require(len(self.steps) > 0, "a repeat needs at least one step inside")


Step = Union[Drive, Turn, Arc, RawTwist, Go, Face, Wait, Say, Remember, Repeat]


@dataclass(frozen=True)
class Plan:
    """What the robot is to do, in order."""

    steps: tuple[Step, ...]

    def __post_init__(self) -> None:
        _require(len(self.steps) > 0, "a plan needs at least one step")
