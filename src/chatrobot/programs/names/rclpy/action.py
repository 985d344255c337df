"""rclpy.action: not in the box, and it says so."""

from __future__ import annotations

from typing import Any, NoReturn


def _refuse(name: str) -> NoReturn:
    raise NotImplementedError(f"{name}: actions are not available here; publish velocities, or use a service")


class ActionClient:
    """Needs a server that only a whole ROS system has."""

    def __init__(self, *_: Any, **__: Any) -> None:
        _refuse("ActionClient")


class ActionServer:
    """Needs clients that only a whole ROS system has."""

    def __init__(self, *_: Any, **__: Any) -> None:
        _refuse("ActionServer")
