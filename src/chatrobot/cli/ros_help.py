"""`ros2 run chatrobot control --help`: what a node takes there, and the defaults that hold there.

Imports no rclpy: whoever asks how a node is started may not have sourced ROS yet.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

from chatrobot.nodes.parameters import PARAMETERS, Parameter

_WIDTH = 100
_ABOUT = {
    "input": "Lines typed here go to the topic user_input.",
    "base": "From the topic user_input, by way of understanding, to the topic chatgpt_node.",
    "control": "From the topic chatgpt_node, by way of rehearsal and governor, to the robot's velocities.",
}
_NOTE = """\
They are read at the start and are read-only from then on; --params-file FILE reads them from YAML. Topics are
remapped with -r FROM:=TO (-r odom:=/wheel/odometry), the namespace with -r __ns:=/robot1."""


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Whether `--help` stands before what is ROS's own."""
    ours = arguments[: arguments.index("--ros-args")] if "--ros-args" in arguments else arguments
    return any(argument in ("-h", "--help") for argument in ours)


def help_of(which: str, executable: str) -> str:
    """The help text of the node `which`, started as that executable."""
    path = Path(executable)
    lines = [
        f"usage: ros2 run {path.parent.name or 'chatrobot'} {path.name} --ros-args -p NAME:=VALUE -r FROM:=TO",
        "",
        _ABOUT[which],
    ]
    if PARAMETERS[which]:
        lines += ["", "parameters, with their defaults:"]
        lines += [line for parameter in PARAMETERS[which] for line in _listed(parameter)]
        lines += ["", _NOTE]
    return "\n".join(lines)


def _listed(parameter: Parameter) -> list[str]:
    default = parameter.default
    shown = str(default).lower() if isinstance(default, bool) else str(default) or '""'
    begin = f"  {parameter.name}:={shown}"
    return [
        begin,
        *textwrap.wrap(parameter.description, _WIDTH, initial_indent=" " * 6, subsequent_indent=" " * 6),
    ]


def show(which: str) -> int:
    """Print it."""
    print(help_of(which, sys.argv[0]))
    return 0
