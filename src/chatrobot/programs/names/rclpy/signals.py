"""rclpy.signals"""

from enum import Enum


class SignalHandlerOptions(Enum):
    """In the box no signal reaches a program: a stop ends it."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Nothing is to be done."""


def uninstall_signal_handlers() -> None:
    """Nothing is to be done."""
