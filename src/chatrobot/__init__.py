"""ChatRobot: say it, and a robot does exactly that, safely.

import chatrobot

with chatrobot.connect() as robot:
    print(robot.do("forward 1 m, then turn left").reply)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from chatrobot.api import Robot, connect
    from chatrobot.core.errors import ChatRobotError
    from chatrobot.core.events import Event, Result
    from chatrobot.plan.steps import Plan

__version__ = "0.1.0"
__all__ = ["ChatRobotError", "Event", "Plan", "Result", "Robot", "connect"]

_HOMES = {
    "connect": "chatrobot.api",
    "Robot": "chatrobot.api",
    "ChatRobotError": "chatrobot.core.errors",
    "Event": "chatrobot.core.events",
    "Result": "chatrobot.core.events",
    "Plan": "chatrobot.plan.steps",
}


def __getattr__(name: str) -> Any:
    """Names are imported when they are first used: the command `chatrobot stop` has no time for the rest."""
    if name not in _HOMES:
        raise AttributeError(f"module 'chatrobot' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
