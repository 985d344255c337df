"""rclpy.clock"""

from __future__ import annotations

import time
from typing import Any

from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.rclpy.clock_type import ClockType as ClockType
from chatrobot.programs.names.rclpy.constants import S_TO_NS
from chatrobot.programs.names.rclpy.duration import Duration
from chatrobot.programs.names.rclpy.exceptions import NotInitializedException
from chatrobot.programs.names.rclpy.time import Time
from chatrobot.programs.names.rclpy.utilities import get_default_context

SLICE_S = 0.1
"""A long sleep looks this often whether rclpy has been shut down."""


class Clock:
    """Tells the time of the link, whatever its type."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        self._clock_type = clock_type

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now(self) -> Time:
        return Time(nanoseconds=get_link().wall_ns(), clock_type=self.clock_type)

    def sleep_until(self, until: Time, context: Any = None) -> bool:
        """True when the time is reached, False when rclpy was shut down before."""
        context = get_default_context() if context is None else context
        if not context.ok():
            raise NotInitializedException()
        if until.clock_type != self.clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        while True:
            left_s = (until.nanoseconds - get_link().wall_ns()) / S_TO_NS
            if left_s <= 0.0:
                return True
            time.sleep(min(left_s, SLICE_S))
            if not context.ok():
                return False

    def sleep_for(self, rel_time: Duration, context: Any = None) -> bool:
        return self.sleep_until(self.now() + rel_time, context)


class ROSClock(Clock):
    """A clock of ROS time."""

    def __init__(self) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)

    @property
    def ros_time_is_active(self) -> bool:
        return False
