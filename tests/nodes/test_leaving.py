"""A launch that is ended with Ctrl-C leaves a robot that stands, and nobody on the graph, its guard neither."""

from __future__ import annotations

import time
from pathlib import Path

import psutil
import pytest
from scripts.faults import has_ended

from chatrobot.wire.messages import TwistMessage
from tests.nodes.node_rig import NodeRig, running

pytestmark = pytest.mark.realtime

PROMISE_S, GUARD_GONE_S = 0.25, 1.0
ASKED_TO_END = {"control": 5, "base": 5, "input": 5}


def end_the_launch(rig: NodeRig) -> float:
    """Seconds to zero."""
    guard = rig.guard()
    struck_s = rig.interrupt_all()
    took_s = rig.velocities.seconds_to_zero(struck_s)
    codes = {name: node.process.wait(10.0) for name, node in rig.nodes.items()}
    ended_s = time.monotonic()
    assert codes == ASKED_TO_END
    assert rig.robot.process.wait(10.0) == 0
    while not has_ended(guard):
        assert time.monotonic() - ended_s < GUARD_GONE_S, "the guard sends zeros to nobody"
        time.sleep(0.01)
    lines = [line for node in (rig.robot, *rig.nodes.values()) for line in node.lines]
    assert not any("Traceback" in line or "Exception" in line for line in lines), lines
    return took_s


@pytest.mark.alone
def test_ctrl_c_for_all_while_the_robot_drives(tmp_path: Path) -> None:
    with running(tmp_path, namespace="robot1") as rig:
        rig.drive()
        took_s = end_the_launch(rig)
    assert took_s <= PROMISE_S


def test_ctrl_c_for_all_while_it_stands(tmp_path: Path) -> None:
    with running(tmp_path) as rig:
        end_the_launch(rig)


@pytest.mark.alone
def test_a_guard_in_a_namespace_halts_its_robot_and_no_other(tmp_path: Path) -> None:
    with running(tmp_path, namespace="robot1") as rig:
        elsewhere: list[object] = []
        rig.ear.subscribe("/cmd_vel", TwistMessage, elsewhere.append)
        rig.drive()
        took_s = rig.velocities.seconds_to_zero(rig.nodes["control"].strike("SIGKILL"))
        assert took_s <= PROMISE_S
        rig.truth.wait_for(lambda truth: not truth.vx_mps, time.monotonic())
        assert not elsewhere


def test_who_reads_what_control_wrote_need_not_wait_for_its_guard(tmp_path: Path) -> None:
    """The robot is frozen: the guard goes on, but `ros2 launch` must see that control has ended."""
    with running(tmp_path) as rig:
        rig.drive()
        guard = rig.guard()
        (robot,) = psutil.Process(rig.robot.process.pid).children()
        robot.suspend()
        control = rig.nodes["control"]
        control.strike("SIGKILL")
        control.wait_for_output_end(3.0)
        assert not has_ended(guard)
        robot.resume()
