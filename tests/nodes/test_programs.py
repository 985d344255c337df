"""The tutorial's second demo with no ROS and no model: programs asked for on `user_input` run in the box of control."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from chatrobot.programs.library import KeptProgram, Library
from chatrobot.wire.messages import Text
from tests.nodes.node_rig import NodeRig
from tests.programs.requests import ROTATION
from tests.programs.scripted_model import program

pytestmark = pytest.mark.realtime

PROMISE_S = 0.25
FOR_EVER = "Generate a ROS 2 Python program to drive forward at 0.3 m/s for 300 seconds."


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    """All four processes; `base` was started as the tutorial starts it."""
    folder = tmp_path_factory.mktemp("nodes")
    rude = program("self.drive(0.2, 0.0, 0.5)\nreturn")
    Library(folder / "config" / "chatrobot").keep(KeptProgram("rude dance", rude))
    made = NodeRig(folder, "control", "input")
    try:
        base = made.start("node", "base", "--on", "dds", "--ros-args", "-p", "generate_code:=True")
        made.nodes["base"] = base
        base.wait_for_line("generate_code is set")
        yield made
    finally:
        made.close()


def program_processes(rig: NodeRig) -> tuple[psutil.Process, psutil.Process]:
    """The warm server beside control, and the program in it: the last in the only row of children."""
    row = [psutil.Process(rig.nodes["control"].process.pid)]
    while children := [child for child in row[-1].children() if "chatrobot.guard" not in child.cmdline()]:
        row.append(children[0])
    assert len(row) >= 3, "no program is running"
    return row[-2], row[-1]


def started(rig: NodeRig, text: str) -> float:
    said_s = rig.publish("user_input", Text(text))
    rig.truth.wait_for(lambda odometry: odometry.vx_mps > 0.25, said_s)
    return said_s


def test_the_tutorials_rotation_word_for_word(rig: NodeRig) -> None:
    yaw0 = rig.pose()[2]
    said_s = rig.publish("user_input", Text(ROTATION))
    written = rig.event("program_written", said_s)
    assert "import rclpy" in written["source"]
    _, shown = rig.replies.wait_for(lambda text: "version 1" in text.data, said_s)
    assert "import rclpy" in shown.data
    assert written["place"].endswith("program.py")
    assert Path(written["place"]).name in shown.data
    result = rig.result(said_s)
    assert result["outcome"] == "completed"
    assert result["turned_rad"] == pytest.approx(3.0, abs=0.1)
    assert rig.pose()[2] - yaw0 == pytest.approx(3.0, abs=0.1)
    assert not any(rig.velocities.all[-1][1])


def test_findings_are_asked_about_on_user_input(rig: NodeRig) -> None:
    said_s = rig.publish("user_input", Text("run the rude dance"))
    asked_s, _ = rig.replies.wait_for(lambda text: "Say yes or no" in text.data, said_s)
    assert any("without stopping" in text.data for at_s, text in rig.replies.all if at_s >= said_s)
    rig.publish("user_input", Text("no"))
    assert rig.result(asked_s)["outcome"] == "refused"
    assert not any(any(twist) for at_s, twist in tuple(rig.velocities.all) if at_s >= said_s)


@pytest.mark.alone
def test_a_typed_stop_ends_a_program(rig: NodeRig) -> None:
    said_s = started(rig, FOR_EVER)
    typed_s = rig.nodes["input"].say("stop")
    took_s = rig.velocities.seconds_to_zero(typed_s)
    print(f"typed stop: {took_s * 1e3:.0f} ms")
    assert took_s <= PROMISE_S
    assert rig.result(said_s, "Stopped (")["outcome"] == "stopped"


@pytest.mark.alone
def test_whatever_dies_the_robot_stands_within_250_ms(rig: NodeRig) -> None:
    for whom in ("program", "server"):
        said_s = started(rig, FOR_EVER)
        server, running = program_processes(rig)
        struck_s = time.monotonic()
        (running if whom == "program" else server).kill()
        took_s = rig.velocities.seconds_to_zero(struck_s)
        print(f"{whom}: {took_s * 1e3:.0f} ms")
        assert took_s <= PROMISE_S
        assert rig.result(said_s)["outcome"] == "failed"
    started(rig, FOR_EVER)  # after both of that it still works
    _, running = program_processes(rig)
    took_s = rig.velocities.seconds_to_zero(rig.nodes["base"].strike("SIGKILL"))
    print(f"base: {took_s * 1e3:.0f} ms")
    assert took_s <= PROMISE_S
    psutil.wait_procs([running], 2.0)
    assert not running.is_running()
