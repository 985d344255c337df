"""On real ROS 2, too, the robot stops when a node of ours dies or freezes; the console drives it without nodes."""

from __future__ import annotations

import json
import os
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from ros_rig import PATIENCE_S, Process, Rig, Workspace, rig_of

from chatrobot.wire.messages import Odometry, Text, TwistMessage

pytestmark = pytest.mark.realtime


@pytest.fixture
def rig(workspace: Workspace, tmp_path: Path) -> Iterator[Rig]:
    with rig_of(workspace, tmp_path) as made:
        yield made


def started(rig: Rig) -> tuple[Process, Process]:
    """Control and base, in front of a simulated robot, and known to one another."""
    robot = rig.run("chatrobot", "sim", "--world", "empty")
    control, base = rig.run("chatrobot", "control"), rig.run("chatrobot", "base")
    for process, said in ((robot, "it ends with"), (control, "control drives"), (base, "user_input")):
        process.wait_for_line(said)
    assert rig.ear.wait_for_listener("user_input", Text, 20.0, count=2)
    time.sleep(0.5)
    return control, base


def the_node_itself(process: Process) -> int:
    """`ros2 run` is its parent."""
    children = Path(f"/proc/{process.process.pid}/task/{process.process.pid}/children").read_text().split()
    return int(children[0])


@pytest.mark.parametrize("which", ["control", "base"])
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_when_a_node_dies_or_freezes_the_robot_stops(rig: Rig, which: str, how: signal.Signals) -> None:
    velocities = rig.hear("cmd_vel", TwistMessage)
    control, base = started(rig)
    victim = the_node_itself(control if which == "control" else base)
    rig.ear.publish("user_input", Text("forward 10 m"))
    velocities.wait_for(lambda twist: twist.vx_mps > 0.2)
    struck_s = time.monotonic()
    os.kill(victim, how)
    time.sleep(1.0)
    moved = [at_s for at_s, twist in velocities.since(struck_s) if any(twist)]
    zeros = [at_s for at_s, twist in velocities.since(struck_s) if not any(twist)]
    if how == signal.SIGSTOP:
        os.kill(victim, signal.SIGKILL)
    assert zeros, "no zero came"
    stopped_s = min(at_s for at_s in zeros if at_s >= max(moved, default=struck_s)) - struck_s
    print(f"{how.name} of {which}: zero after {1e3 * stopped_s:.0f} ms")
    assert stopped_s < 0.25


def test_text_becomes_motion_and_a_stop_a_zero_quickly(rig: Rig) -> None:
    """From `user_input` to a subscriber, in a process that is none of the nodes; printed with `-s`."""
    velocities, truth = rig.hear("cmd_vel", TwistMessage), rig.hear("chatrobot/sim/truth", Odometry)
    started(rig)
    moves_s, stops_s = [], []
    for index in range(20):
        said_s = time.monotonic()
        rig.ear.publish("user_input", Text("forward 5 m" if index % 2 else "back 5 m"))
        moves_s.append(velocities.wait_for(any, said_s)[0] - said_s)
        time.sleep(0.3)
        said_s = time.monotonic()
        rig.ear.publish("user_input", Text("stop"))
        stops_s.append(velocities.wait_for(lambda twist: not any(twist), said_s)[0] - said_s)
        truth.wait_for(lambda true: not true.vx_mps, said_s)
        time.sleep(0.3)
    for name, values in (("text to motion", moves_s), ("stop to zero", stops_s)):
        print(f"{name}: median {1e3 * statistics.median(values):.1f} ms, longest {1e3 * max(values):.1f} ms")
    assert statistics.median(stops_s) < 0.02


def test_the_console_drives_over_ros_without_the_nodes(rig: Rig) -> None:
    rig.run("chatrobot", "sim", "--world", "empty").wait_for_line("it ends with")
    done = subprocess.run(
        [sys.executable, "-m", "chatrobot", "do", "forward 1 m", "--on", "ros", "--yes", "--json"],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        env=rig.environment,
    )
    result = json.loads(done.stdout.splitlines()[-1])
    assert (result["outcome"], done.returncode) == ("completed", 0), done.stderr
    assert result["path_m"] == pytest.approx(1.0, abs=0.03)
