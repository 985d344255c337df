"""rclpy.logging, rclpy.impl"""

from __future__ import annotations

import sys
from enum import IntEnum
from typing import Any

from chatrobot.programs.inside.link import get_link


class LoggingSeverity(IntEnum):
    """The severity of a line of the log."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


_levels: dict[str, LoggingSeverity] = {}
_OPTIONS = ["throttle_duration_sec", "throttle_time_source_type", "skip_first", "once"]


class RcutilsLogger:
    """Lines go to the host, with the time and the logger's name."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._last_ns: dict[tuple[str, int], int] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: int) -> None:
        _levels[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """Its own, or its nearest ancestor's."""
        name = self.name
        while name:
            if name in _levels:
                return _levels[name]
            name = name.rpartition(".")[0]
        return _levels.get("", LoggingSeverity.INFO)

    def is_enabled_for(self, severity: int) -> bool:
        return LoggingSeverity(severity) >= self.get_effective_level()

    def log(self, message: str, severity: int, **options: Any) -> bool:
        """Send a line; tell whether it went out."""
        for option in options:
            if option not in (*_OPTIONS, "name"):
                raise TypeError(
                    f'parameter "{option}" is not one of the recognized logging options "{_OPTIONS}"'
                )
        if not isinstance(message, str):
            raise TypeError(
                "rclpy_logging_rcutils_log(): incompatible function arguments. The following argument types are "
                f"supported:\n    a str\n\nInvoked with: {message!r}"
            )
        severity = LoggingSeverity(severity)
        if not self.is_enabled_for(severity) or not self._passes(options):
            return False
        get_link().log(severity.name, options.get("name") or self.name, message)
        return True

    def _passes(self, options: dict[str, Any]) -> bool:
        """`once`, `skip_first` and `throttle_duration_sec` count per place in the program."""
        if not (options.get("once") or options.get("skip_first") or "throttle_duration_sec" in options):
            return True
        frame = sys._getframe(3)
        place, now_ns = (frame.f_code.co_filename, frame.f_lasti), get_link().now_ns()
        last_ns = self._last_ns.get(place)
        if last_ns is not None and (
            options.get("once") or now_ns - last_ns < options.get("throttle_duration_sec", 0.0) * 1e9
        ):
            return False
        self._last_ns[place] = now_ns
        return not (last_ns is None and options.get("skip_first"))

    def debug(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.DEBUG, **options)

    def info(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.INFO, **options)

    def warning(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.WARN, **options)

    def warn(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.WARN, **options)

    def error(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.ERROR, **options)

    def fatal(self, message: str, **options: Any) -> bool:
        return self.log(message, LoggingSeverity.FATAL, **options)


def get_logger(name: str) -> RcutilsLogger:
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def set_logger_level(name: str, level: int) -> None:
    RcutilsLogger(name).set_level(level)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    return RcutilsLogger(name).get_effective_level()


get_logger_level = get_logger_effective_level


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    return LoggingSeverity[log_severity.upper()]
