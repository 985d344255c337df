"""rclpy.clock_type"""

from enum import IntEnum


class ClockType(IntEnum):
    """In the box all three tell the same time."""

    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3
