"""Options as the person types them: on our command line, or as ROS parameters under `ros2 run`.

The phrases name options as our command line has them. Where this process is a node of ROS, each is shown as what
stands behind `--ros-args`, and a phrase whose code ends in `_ros` goes before the one without.
"""

from __future__ import annotations

import re

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

_is_ros = False


def type_as_ros_args() -> None:
    """This process is a node of ROS: from now on options are shown as its parameters."""
    global _is_ros  # how the process was started, and it stays so
    _is_ros = True


def codes(code: str) -> tuple[str, ...]:
    """The codes under which a phrase is looked for, the best first."""
    return (f"{code}_ros", code) if _is_ros else (code,)


def typed(text: str) -> str:
    """The text with its options as they are typed here."""
    return as_ros_args(text) if _is_ros else text


def as_ros_args(text: str) -> str:
    """The text with our options as ROS parameters."""
    return _OPTION.sub(_parameter, text)


def _parameter(found: re.Match[str]) -> str:
    if found["switch"]:
        return f"--ros-args -p {found['switch'].replace('-', '_')}:=True"
    name, placeholder = _VALUES[found["name"]]
    return f"--ros-args -p {name}:={found['value'] or placeholder}"
