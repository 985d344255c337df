"""`chatrobot sim`: the simulated robot alone, in a process of its own, for other programs to drive."""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import FrameType

from chatrobot.cli.entry import USAGE
from chatrobot.core.errors import JointError
from chatrobot.wire.runtime_dir import runtime_dir


def run(args: argparse.Namespace) -> int:
    """Until Ctrl-C, or until everybody who drove it has left; the exit code of its process."""
    path = args.socket if getattr(args, "socket", None) else str(runtime_dir() / f"sim-{os.getpid()}.wire")
    robot = subprocess.Popen(
        [
            *(sys.executable, "-m", "chatrobot.sim", "--socket", path, "--profile", args.robot),
            *("--world", args.world or "home", "--sim", args.sim),
        ],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        start_new_session=True,
    )

    asked_to_end = False

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal asked_to_end
        asked_to_end = True
        robot.terminate()

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, end)
    assert robot.stdout is not None
    if robot.stdout.readline() != b"ready\n" and not asked_to_end:
        if robot.wait() == USAGE:
            return USAGE  # it has said what was wrong
        raise JointError("the simulated robot did not start")
    print(f"the simulated {args.robot} answers on {path}", flush=True)
    print(
        "it ends with Ctrl-C, 15 s after now if nobody comes, or 2 s after the last one has left", flush=True
    )
    code = robot.wait()
    if not asked_to_end:
        return code
    Path(path).unlink(missing_ok=True)  # asked in its first moments it leaves without tidying up
    return 0
