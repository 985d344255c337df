"""What sensors say, as events: where the robot is, what its lidar sees; and what was put around it. They belong to no
instruction."""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.core.event import Event
from chatrobot.core.geometry import Pose, Twist


@dataclass(frozen=True)
class Telemetry(Event, name="telemetry"):
    """Where the robot is and how it moves, as it measures itself; `path_m` since odometry began.

    `odometry_epoch` counts the times odometry began anew: a pose of an older epoch means nothing any more.
    `sectors_m` are those of `Looked`.
    """

    pose: Pose
    twist: Twist
    path_m: float
    battery_percent: float | None = None
    nearest_obstacle_m: float | None = None
    moving: bool = False
    odometry_epoch: int = 0
    sectors_m: tuple[float | None, ...] = ()


@dataclass(frozen=True)
class TruePose(Event, name="pose"):
    """The simulator's truth, for `--trace`. Nothing else may read it."""

    t_s: float
    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    wz_radps: float


@dataclass(frozen=True)
class Scan(Event, name="scan"):
    """What the lidar sees, for a map: at most 180 points and 5 a second, and only while a display watches."""

    pose: Pose
    points_m: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Looked(Event, name="looked"):
    """What the lidar sees, by eight sectors of 45 degrees, from straight ahead counter-clockwise.

    Metres from the robot's edge to the nearest thing; None where nothing is seen; empty without a lidar.
    """

    sectors_m: tuple[float | None, ...] = ()


@dataclass(frozen=True)
class ObstacleChanged(Event, name="obstacle_changed"):
    """A person has put an obstacle into the simulation, or moved it; `outline_m` is empty where it was taken away."""

    obstacle: str
    outline_m: tuple[tuple[float, float], ...]
