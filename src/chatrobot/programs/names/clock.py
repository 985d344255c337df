"""rclpy.clock, .clock_type, .constants, .duration, .time"""

from __future__ import annotations

import math
import time
from enum import IntEnum
from functools import total_ordering
from typing import Any

from chatrobot.programs.inside.interfaces import kind
from chatrobot.programs.inside.link import get_link
from chatrobot.programs.names.context import get_default_context
from chatrobot.programs.names.errors import NotInitializedException

S_TO_NS = 1000 * 1000 * 1000
_DurationMsg, _TimeMsg = kind("builtin_interfaces/Duration"), kind("builtin_interfaces/Time")


class ClockType(IntEnum):
    """In the box all three tell the same time."""

    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3


@total_ordering
class Duration:
    """A length of time, in nanoseconds."""

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -(2**63) <= total < 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self.nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self == Infinite else f"{self.nanoseconds} nanoseconds"

    def __add__(self, other: Any) -> Duration:
        if isinstance(other, Duration):
            return Duration(nanoseconds=self.nanoseconds + other.nanoseconds)
        return NotImplemented

    def __sub__(self, other: Any) -> Duration:
        if isinstance(other, Duration):
            return Duration(nanoseconds=self.nanoseconds - other.nanoseconds)
        return NotImplemented

    def __mul__(self, other: Any) -> Duration:
        if isinstance(other, float) and not math.isfinite(other):
            if other == math.inf:
                return Infinite
            raise ValueError("Can't multiply duration with nan")
        if isinstance(other, (int, float)):
            return Duration(nanoseconds=int(self.nanoseconds * other))
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self.nanoseconds == other.nanoseconds
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self.nanoseconds < other.nanoseconds
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def to_msg(self) -> Any:
        seconds, nanoseconds = divmod(self.nanoseconds, S_TO_NS)
        return _DurationMsg(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: Any) -> Duration:
        if not isinstance(msg, _DurationMsg):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


Infinite = Duration(nanoseconds=2**63 - 1)


@total_ordering
class Time:
    """A point in time of one kind of clock."""

    def __init__(
        self, *, seconds: float = 0, nanoseconds: int = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds = total
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        return self.nanoseconds // S_TO_NS, self.nanoseconds % S_TO_NS

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self.nanoseconds}, clock_type={self.clock_type.name})"

    def __add__(self, other: Any) -> Time:
        if isinstance(other, Duration):
            return Time(nanoseconds=self.nanoseconds + other.nanoseconds, clock_type=self.clock_type)
        return NotImplemented

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, Time):
            self._check("subtract", other)
            return Duration(nanoseconds=self.nanoseconds - other.nanoseconds)
        if isinstance(other, Duration):
            try:
                return Time(nanoseconds=self.nanoseconds - other.nanoseconds, clock_type=self.clock_type)
            except ValueError as error:
                raise ValueError("Subtraction leads to negative time.") from error
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Time):
            self._check("compare", other)
            return self.nanoseconds == other.nanoseconds
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        if isinstance(other, Time):
            self._check("compare", other)
            return self.nanoseconds < other.nanoseconds
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def _check(self, verb: str, other: Time) -> None:
        if self.clock_type != other.clock_type:
            raise TypeError(f"Can't {verb} times with different clock types")

    def to_msg(self) -> Any:
        seconds, nanoseconds = self.seconds_nanoseconds()
        return _TimeMsg(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: Any, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        if not isinstance(msg, _TimeMsg):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)


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
