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
from chatrobot.cli.folders import profile_folders
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.robots.load import profile_argument
from chatrobot.wire.connect import wire_address
from chatrobot.wire.runtime_dir import runtime_dir


def run(args: argparse.Namespace) -> int:
    """Run until Ctrl-C, or until everybody who drove it has left; return the exit code of its process."""
    address, path = _wire(args)
    robot: subprocess.Popen[bytes] | None = None
    asked_to_end = False

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal asked_to_end
        asked_to_end = True
        if robot is not None:
            robot.terminate()

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, end)
    robot = _start(args, address, path)
    if asked_to_end:  # before there was anybody to end
        robot.terminate()
    assert robot.stdout is not None
    if robot.stdout.readline() != b"ready\n" and not asked_to_end:
        if robot.wait() == USAGE:
            return USAGE  # it has said what was wrong
        raise LinkError("the simulated robot did not start")
    _tell(args.robot, address, path)
    code = robot.wait()
    if not asked_to_end:
        return code
    if not address:
        Path(path).unlink(missing_ok=True)  # asked in its first moments it leaves without tidying up
    return 0


def _wire(args: argparse.Namespace) -> tuple[str, str]:
    """Return the address of a wire that is there, or else empty; and the socket where it serves a wire of its own."""
    path = args.socket if getattr(args, "socket", None) else str(runtime_dir() / f"sim-{os.getpid()}.wire")
    address = "" if args.on in ("auto", "sim") else wire_address(args.on)
    if address.startswith("local:"):
        path, address = address.partition(":")[2], ""
    if args.ros_args and not address.startswith("ros:"):
        raise UsageError("only a ROS node takes ROS arguments", where="--ros-args", allowed="with --on ros")
    return address, path


def _start(args: argparse.Namespace, address: str, path: str) -> subprocess.Popen[bytes]:
    """Start it in a session of its own: a terminal's signals come here, and this command ends it."""
    profile = profile_argument(args.robot, profile_folders(args))
    return subprocess.Popen(
        [
            *(sys.executable, "-m", "chatrobot.sim", "--profile", profile),
            *("--world", args.world or "home", "--sim", args.sim),
            *(("--on", address) if address else ("--socket", path)),
            *(("--ros-args", *args.ros_args) if args.ros_args else ()),
        ],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        start_new_session=True,
    )


def _tell(robot: str, address: str, path: str) -> None:
    if address:
        print(f"the simulated {robot} is on {address.rstrip(':')}; it ends with Ctrl-C", flush=True)
        return
    print(f"the simulated {robot} answers on {path}", flush=True)
    leaves = "it ends with Ctrl-C, after 15 s if nobody connects, or 2 s after the last one has left"
    print(leaves, flush=True)
