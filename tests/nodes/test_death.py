"""Whichever node dies or freezes, the robot stands within 250 ms, at a subscriber that is none of ours."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.nodes.node_rig import running

pytestmark = pytest.mark.realtime

PROMISE_S = 0.25
TIMES = 2
"""`make faults` does twenty of each."""


@pytest.mark.parametrize("_", range(TIMES))
@pytest.mark.parametrize("whom", ["base", "control", "input"])
@pytest.mark.parametrize("how", ["SIGKILL", "SIGSTOP"])
def test_the_robot_stands_within_250_ms(tmp_path: Path, whom: str, how: str, _: int) -> None:
    with running(tmp_path) as rig:
        said_s = rig.nodes["input"].say("forward 100 m at 0.3 m/s")
        rig.wait_for_motion(said_s)
        rig.truth.wait_for(lambda odometry: odometry.vx_mps > 0.25, said_s)
        took_s = rig.seconds_to_zero(rig.nodes[whom].strike(how))
        print(f"{how} {whom}: {took_s * 1e3:.0f} ms")
        assert took_s <= PROMISE_S


@pytest.mark.parametrize("whom", ["base", "control", "input"])
def test_ctrl_c_stops_the_robot_first(tmp_path: Path, whom: str) -> None:
    with running(tmp_path) as rig:
        said_s = rig.nodes["input"].say("forward 100 m at 0.3 m/s")
        rig.wait_for_motion(said_s)
        assert rig.seconds_to_zero(rig.nodes[whom].strike("SIGINT")) <= PROMISE_S
        assert rig.nodes[whom].process.wait(10.0) == 5


def test_a_base_that_thaws_drives_again_when_told_and_not_before(tmp_path: Path) -> None:
    with running(tmp_path) as rig:
        said_s = rig.nodes["input"].say("forward 5 m")
        rig.wait_for_motion(said_s)
        rig.seconds_to_zero(rig.nodes["base"].strike("SIGSTOP"))
        thawed_s = rig.nodes["base"].strike("SIGCONT")
        assert rig.result(thawed_s)["outcome"] == "stopped"
        assert not any(any(twist) for at_s, twist in rig.velocities.all if at_s > thawed_s)
        assert rig.do("forward 10 cm")["outcome"] == "completed"


def test_a_control_that_is_gone_is_told_and_a_new_one_obeys(tmp_path: Path) -> None:
    with running(tmp_path) as rig:
        said_s = rig.nodes["input"].say("forward 5 m")
        rig.wait_for_motion(said_s)
        struck_s = rig.nodes["control"].strike("SIGKILL")
        assert rig.result(struck_s)["reason"]["code"] == "control_silent"
        rig.start("node", "control", "--on", "dds", "--accept-others").wait_for_line("control")
        assert rig.do("forward 10 cm")["outcome"] == "completed"


def test_a_base_without_control_says_so(tmp_path: Path) -> None:
    with running(tmp_path, "base", "input") as rig:
        result = rig.do("forward")
        assert (result["outcome"], result["reason"]["code"]) == ("failed", "no_control")


def test_a_second_control_is_named_and_nothing_moves_until_it_is_gone(tmp_path: Path) -> None:
    with running(tmp_path) as rig:
        second = rig.start("node", "control", "--on", "dds")
        for control in (second, rig.nodes["control"]):
            assert "chatrobot_control" in control.wait_for_line("notice (not_alone")
        result = rig.do("forward")
        assert (result["outcome"], result["reason"]["code"]) == ("refused", "another_motion")
        assert "chatrobot_control" in result["reply"]
        assert not any(any(twist) for _, twist in rig.velocities.all)
        second.end()
        rig.nodes["control"].wait_for_line("notice (alone_again")
        assert rig.do("forward 10 cm")["outcome"] == "completed"
