"""turtlesim, the first robot of every ROS course: driven by our nodes on ROS, and by a process that has no ROS."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from ros_rig import PATIENCE_S, SOURCE, Heard, Rig, Workspace, rig_of

from chatrobot.wire.messages import Odometry, Text, TwistMessage

pytestmark = pytest.mark.realtime
TURTLE = ("ros2", "run", "turtlesim", "turtlesim_node")


@pytest.fixture
def rig(workspace: Workspace, tmp_path: Path) -> Iterator[Rig]:
    with rig_of(workspace, tmp_path, "turtlesim") as made:
        yield made


def resting_pose(poses: Heard, since_s: float) -> Odometry:
    """Where it stands, once it stands."""
    found: Odometry = poses.wait_for(lambda pose: not (pose.vx_mps or pose.wz_radps), since_s)[1]
    return found


def test_launched_with_our_nodes_it_drives_a_square_that_closes(rig: Rig) -> None:
    poses, replies = rig.hear("turtle1/pose", Odometry), rig.hear("chatrobot/reply", Text)
    launch = rig.start("ros2", "launch", "chatrobot", "turtlesim.launch.py")
    launch.wait_for_line("control drives turtlesim")
    start = poses.wait_for(lambda _: True)[1]
    assert rig.ear.wait_for_listener("user_input", Text, 20.0, count=2)
    time.sleep(0.5)
    said_s = time.monotonic()
    rig.ear.publish("user_input", Text("drive a square of 2 m"))
    replies.wait_for(lambda reply: reply.data.startswith(("Done", "Not", "Stopped")), said_s)
    final = resting_pose(poses, time.monotonic())
    path = [pose for _, pose in poses.since(said_s)]
    assert max(pose.x_m for pose in path) - min(pose.x_m for pose in path) == pytest.approx(2.0, abs=0.15)
    assert max(pose.y_m for pose in path) - min(pose.y_m for pose in path) == pytest.approx(2.0, abs=0.15)
    off_m = math.hypot(final.x_m - start.x_m, final.y_m - start.y_m)
    off_rad = abs(math.remainder(final.yaw_rad - start.yaw_rad, math.tau))
    print(f"the square closes to {off_m:.3f} units and {math.degrees(off_rad):.2f} degrees")
    assert off_m < 0.1
    assert off_rad < math.radians(3.0)


def test_launched_with_our_nodes_it_goes_sideways(rig: Rig) -> None:
    poses, replies = rig.hear("turtle1/pose", Odometry), rig.hear("chatrobot/reply", Text)
    rig.start("ros2", "launch", "chatrobot", "turtlesim.launch.py").wait_for_line("control drives turtlesim")
    start = poses.wait_for(lambda _: True)[1]
    assert rig.ear.wait_for_listener("user_input", Text, 20.0, count=2)
    time.sleep(0.5)
    said_s = time.monotonic()
    rig.ear.publish("user_input", Text("slide left 1 m"))
    replies.wait_for(lambda reply: reply.data.startswith(("Done", "Not", "Stopped", "I stopped")), said_s)
    final = resting_pose(poses, time.monotonic())
    assert final.y_m - start.y_m == pytest.approx(1.0, abs=0.1)
    assert final.x_m - start.x_m == pytest.approx(0.0, abs=0.1)


def test_it_does_not_go_on_for_its_second_after_a_stop(rig: Rig) -> None:
    poses = rig.hear("turtle1/pose", Odometry)
    rig.start("ros2", "launch", "chatrobot", "turtlesim.launch.py").wait_for_line("control drives turtlesim")
    poses.wait_for(lambda _: True)
    assert rig.ear.wait_for_listener("user_input", Text, 20.0, count=2)
    time.sleep(0.5)
    rig.ear.publish("user_input", Text("forward 4 m"))
    poses.wait_for(lambda pose: pose.vx_mps > 0.5)
    said_s = time.monotonic()
    rig.ear.publish("user_input", Text("stop"))
    stood_s, _ = poses.wait_for(lambda pose: pose.vx_mps == 0.0, said_s)
    assert stood_s - said_s < 0.25


def drive_without_ros(rig: Rig, folder: Path, reach: str) -> subprocess.Popen[str]:
    """`chatrobot … --on dds` as on a machine that has no ROS: nothing of it in the environment but the domain."""
    kept = {"PATH": os.environ["PATH"], "HOME": str(folder), "PYTHONPATH": str(SOURCE)}
    (folder / "plain").mkdir(mode=0o700)
    return subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "--json", "--on", "dds", "--robot", "turtlesim", "--yes"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={
            **kept,
            "ROS_DOMAIN_ID": rig.domain,
            "ROS_AUTOMATIC_DISCOVERY_RANGE": reach,
            "XDG_RUNTIME_DIR": str(folder / "plain"),
        },
    )


@pytest.mark.parametrize("turtle_first", [True, False], ids=["turtlesim first", "ours first"])
@pytest.mark.parametrize("ours", ["LOCALHOST", "SUBNET"])
@pytest.mark.parametrize("theirs", ["LOCALHOST", "SUBNET"])
def test_a_process_without_ros_drives_it(
    workspace: Workspace, tmp_path: Path, ours: str, theirs: str, turtle_first: bool
) -> None:
    pytest.importorskip("cyclonedds")
    with rig_of(workspace, tmp_path, "turtlesim") as rig:
        if turtle_first:
            rig.start(*TURTLE, ROS_AUTOMATIC_DISCOVERY_RANGE=theirs)
            time.sleep(3.0)
        with drive_without_ros(rig, tmp_path, ours) as console:
            assert console.stdin is not None
            assert console.stdout is not None
            if not turtle_first:
                time.sleep(3.0)
                rig.start(*TURTLE, ROS_AUTOMATIC_DISCOVERY_RANGE=theirs)
                time.sleep(3.0)
            console.stdin.write("forward 1 m\n")
            console.stdin.close()
            events = [json.loads(line) for line in console.stdout]
            console.wait(PATIENCE_S)
    result = events[-1]
    assert result["event"] == "result"
    assert result["outcome"] == "completed", result["reply"]
    assert result["path_m"] == pytest.approx(1.0, abs=0.05)


def test_velocities_reach_it_as_twists(rig: Rig) -> None:
    """Its units count as metres: what we send is what it drives."""
    velocities, poses = rig.hear("turtle1/cmd_vel", TwistMessage), rig.hear("turtle1/pose", Odometry)
    rig.start(*TURTLE)
    poses.wait_for(lambda _: True)
    assert rig.ear.wait_for_listener("turtle1/cmd_vel", TwistMessage, 20.0, count=2)
    rig.ear.publish("turtle1/cmd_vel", TwistMessage(0.5, 0.0, 0.0))
    assert velocities.wait_for(any)[1].vx_mps == 0.5
    assert poses.wait_for(lambda pose: pose.vx_mps > 0.0)[1].vx_mps == pytest.approx(0.5)
    rig.ear.publish("turtle1/cmd_vel", TwistMessage(0.0, 0.0, 0.0))
