"""What `ros2 run` starts: the nodes and the simulated robot, `--on ros`. Asked to end they give 0, as ROS's own do.

Imports no rclpy: whoever asks with `--help` how a node is started may not have sourced ROS yet.
"""

from __future__ import annotations

import os
import signal
import sys
import textwrap
import threading
from pathlib import Path
from types import FrameType

from chatrobot.cli.entry import STOPPED, main
from chatrobot.options import PARAMETERS, Parameter

UNWIND_S = 3.0
"""So long a Ctrl-C while a node starts may take; nothing has been driven yet."""

_WIDTH = 100
_ABOUT = {
    "input": "Lines typed here go to the topic user_input.",
    "base": "From the topic user_input, by way of understanding, to the topic chatgpt_node.",
    "control": "From the topic chatgpt_node, by way of rehearsal and governor, to the robot's velocities.",
}
_NOTE = """\
They are read at the start and are read-only from then on; --params-file FILE reads them from YAML. Topics are
remapped with -r FROM:=TO (-r odom:=/wheel/odometry), the namespace with -r __ns:=/robot1."""


def input_node() -> int:
    """`ros2 run chatrobot input`."""
    return _run("node", "input")


def base_node() -> int:
    """`ros2 run chatrobot base`."""
    return _run("node", "base")


def control_node() -> int:
    """`ros2 run chatrobot control`."""
    return _run("node", "control")


def simulated_robot() -> int:
    """`ros2 run chatrobot sim`."""
    return _run("sim")


def _run(*command: str) -> int:
    """Run a command. Of two Ctrl-C, which `ros2 launch` sends, the first counts, also while this starts or ends."""
    ours = sys.argv[1 : sys.argv.index("--ros-args")] if "--ros-args" in sys.argv else sys.argv[1:]
    if command[0] == "node" and {"-h", "--help"}.intersection(ours):
        print(_help_of(command[1], Path(sys.argv[0])))
        return 0
    watch, before = _StartWatch(), signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, watch.interrupt)
    code = main([*command, "--on", "ros", *sys.argv[1:]])
    was_asked = code == STOPPED or watch.is_interrupted
    if was_asked or signal.getsignal(signal.SIGINT) != watch.interrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    else:
        signal.signal(signal.SIGINT, before)
    return 0 if was_asked else code


class _StartWatch:
    """Hears Ctrl-C until a node is there, whose own watch stops the robot first."""

    is_interrupted = False

    def interrupt(self, _signal: int, _frame: FrameType | None) -> None:
        if not self.is_interrupted:
            self.is_interrupted = True
            # An import that is broken off may swallow it, or leave a library that never ends.
            timer = threading.Timer(UNWIND_S, os._exit, (0,))
            timer.daemon = True
            timer.start()
            raise KeyboardInterrupt


def _help_of(which: str, path: Path) -> str:
    """Write the help of the node `which`: what it takes there, and the defaults that hold there."""
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
    begin = " " * 6
    about = textwrap.wrap(parameter.description, _WIDTH, initial_indent=begin, subsequent_indent=begin)
    return [f"  {parameter.name}:={shown}", *about]
