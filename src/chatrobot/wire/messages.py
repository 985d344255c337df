"""What travels on a wire: the planar part of the standard ROS 2 messages, flat and cheap.

Units and frames as in `chatrobot.core.geometry`. Stamps are seconds of the sender's clock; where sender and
receiver share no clock, a backend translates.
"""

from __future__ import annotations

from typing import NamedTuple, Union


class TwistMessage(NamedTuple):
    """geometry_msgs/Twist, planar."""

    vx_mps: float
    vy_mps: float
    wz_radps: float


ZERO = TwistMessage(0.0, 0.0, 0.0)


class Odometry(NamedTuple):
    """nav_msgs/Odometry, planar: pose in `odom`, velocity in `base_link`."""

    stamp_s: float
    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    wz_radps: float


class Imu(NamedTuple):
    """sensor_msgs/Imu, planar: the rate of turn."""

    stamp_s: float
    wz_radps: float


class LaserScan(NamedTuple):
    """sensor_msgs/LaserScan. Beam i looks along `angle_min_rad + i * angle_increment_rad` in the lidar's frame."""

    stamp_s: float
    angle_min_rad: float
    angle_increment_rad: float
    range_min_m: float
    range_max_m: float
    ranges_m: list[float]


class Picture(NamedTuple):
    """sensor_msgs/Image or sensor_msgs/CompressedImage.

    `encoding` is rgb8, bgr8 or mono8, rows from top to bottom, `row_bytes` apart; or jpeg or png: then `data` is
    that file, and the other numbers are zero.
    """

    stamp_s: float
    encoding: str
    width_px: int
    height_px: int
    row_bytes: int
    data: bytes


class Flag(NamedTuple):
    """std_msgs/Bool."""

    data: bool


class Number(NamedTuple):
    """std_msgs/Float64 (a battery's percentage, say)."""

    data: float


class Text(NamedTuple):
    """std_msgs/String."""

    data: str


Message = Union[TwistMessage, Odometry, Imu, LaserScan, Picture, Flag, Number, Text]
MESSAGE_TYPES: tuple[type[Message], ...] = (
    TwistMessage, Odometry, Imu, LaserScan, Picture, Flag, Number, Text,
)  # fmt: skip
PICTURE_BYTES = 131_072
"""Every wire carries a picture of this size; those between machines also far larger ones."""
