"""What `ros2 run` starts: the nodes and the simulated robot, `--on ros`. Asked to end they give 0, as ROS's own do."""

from __future__ import annotations

import os
import signal
import sys
import threading
from types import FrameType

from chatrobot.cli.entry import STOPPED, main
from chatrobot.cli.ros_help import asks_for_help, show

UNWIND_S = 3.0
"""So long a Ctrl-C while a node starts may take; nothing has been driven yet."""


def input_node() -> int:
    return _run("node", "input")


def base_node() -> int:
    return _run("node", "base")


def control_node() -> int:
    return _run("node", "control")


def simulated_robot() -> int:
    return _run("sim")


def _run(*command: str) -> int:
    """Of two Ctrl-C, which `ros2 launch` sends, the first counts, also while this process starts or ends."""
    if command[0] == "node" and asks_for_help(sys.argv[1:]):
        return show(command[1])
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
