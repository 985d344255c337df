"""rclpy.logging"""

from __future__ import annotations

from chatrobot.programs.names.rclpy.impl.logging_severity import LoggingSeverity as LoggingSeverity
from chatrobot.programs.names.rclpy.impl.rcutils_logger import RcutilsLogger


def get_logger(name: str) -> RcutilsLogger:
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def set_logger_level(name: str, level: int) -> None:
    RcutilsLogger(name).set_level(level)


def get_logger_level(name: str) -> LoggingSeverity:
    return RcutilsLogger(name).get_effective_level()


def get_logger_effective_level(name: str) -> LoggingSeverity:
    return RcutilsLogger(name).get_effective_level()


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    return LoggingSeverity[log_severity.upper()]
