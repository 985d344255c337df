"""What a person can type here: options of our command line, ROS parameters under `ros2 run`, arguments in Python.

The phrases name options as our command line has them, and commands of the console at the terminal. On another face a
phrase whose code ends in one of its `_ENDINGS` goes before the one without. Where this process is a node of ROS, each
option is shown as what stands behind `--ros-args`.
"""

from __future__ import annotations

import re
from typing import Literal

_SWITCHES = ("open-loop", "on-robot", "allow-release", "accept-others")
_VALUES = {
    "robot": ("robot", "PROFILE"),
    "model": ("model", "PROVIDER:NAME"),
    "rounds": ("rounds", "N"),
    "budget-tokens": ("budget_tokens", "N"),
    "budget-s": ("budget_s", "SECONDS"),
    "max-distance": ("max_distance_m", "METRES"),
    "max-time": ("max_time_s", "SECONDS"),
}
"""The options that are a ROS parameter with a value, and what a person puts in its place."""

_OPTION = re.compile(
    rf"--(?P<switch>{'|'.join(_SWITCHES)})(?![\w-])|--(?P<name>{'|'.join(_VALUES)})(?![\w-])"
    r"(?: (?P<value>[a-z-]+:NAME|[A-Z:]+|(?<=--robot )[\w./~-]*\w))?"
)
"""A value that follows is a placeholder, or the name of a robot's profile."""

Face = Literal["console", "lines", "python", "ros"]
"""Where people read us: at the console, as lines of a command, in a program that called `connect`, at a node of ROS."""
_ENDINGS: dict[Face, tuple[str, ...]] = {
    "console": ("",),
    "lines": ("_consoleless", ""),
    "python": ("_python", "_consoleless", ""),
    "ros": ("_ros", ""),
}
_face: Face = "console"


def speak_for(face: Face) -> None:
    """From now on name what can be typed on that face of this process."""
    global _face  # how the process was started, and it stays so
    _face = face


def codes(code: str) -> tuple[str, ...]:
    """The codes under which a phrase is looked for, the best first."""
    return tuple(code + ending for ending in _ENDINGS[_face])


def typed(text: str) -> str:
    """The text with its options as they are typed here."""
    return as_ros_args(text) if _face == "ros" else text


def as_ros_args(text: str) -> str:
    """The text with our options as ROS parameters."""
    return _OPTION.sub(_parameter, text)


def _parameter(found: re.Match[str]) -> str:
    if found["switch"]:
        return f"--ros-args -p {found['switch'].replace('-', '_')}:=True"
    name, placeholder = _VALUES[found["name"]]
    return f"--ros-args -p {name}:={found['value'] or placeholder}"
