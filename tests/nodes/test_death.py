"""Whichever node dies or freezes, the robot stands within 250 ms, at a subscriber that is none of ours.

One set of processes for all: what was killed is replaced, what was frozen thaws. One blow of each kind here, some more
beside busy processes in test_busy_machine.py; `make faults` strikes twenty times.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Iterator

import pytest

from tests.nodes.node_rig import NodeRig, running

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

PROMISE_S = 0.25
NODES = ("base", "control", "input")
REPLACEMENT = {"control": ("--accept-others",)}
"""One that was killed is still seen on DDS for ten seconds."""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes")) as made:
        yield made


def test_a_robot_that_moves_hears_from_us_20_times_a_second_at_least(rig: NodeRig) -> None:
    said_s = rig.drive()
    time.sleep(1.0)
    moving_s = [at_s for at_s, twist in rig.velocities.since(said_s) if twist.vx_mps > 0.0]
    assert max(later - sooner for sooner, later in itertools.pairwise(moving_s)) < 0.05
    rig.rest()


def test_a_second_control_is_named_and_nothing_moves_until_it_is_gone(rig: NodeRig) -> None:
    began_s = time.monotonic()
    second = rig.start("node", "control", "--on", "dds")
    try:
        for control in (second, rig.nodes["control"]):
            assert "chatrobot_control" in control.wait_for_line("Others send velocities")
        result = rig.do("forward")
        assert (result["outcome"], result["reason"]["code"]) == ("refused", "another_motion")
        assert "chatrobot_control" in result["reply"]
        assert not any(any(twist) for _, twist in rig.velocities.since(began_s))
    finally:
        second.end()
    rig.nodes["control"].wait_for_line("Nobody else sends velocities")
    assert rig.do("forward 10 cm")["outcome"] == "completed"


@pytest.mark.parametrize("whom", NODES)
def test_when_one_freezes_the_robot_stands_within_250_ms(rig: NodeRig, whom: str) -> None:
    rig.drive()
    took_s = rig.velocities.seconds_to_zero(rig.nodes[whom].strike("SIGSTOP"))
    rig.nodes[whom].strike("SIGCONT")
    rig.rest()
    print(f"SIGSTOP {whom}: {took_s * 1e3:.0f} ms")
    assert took_s <= PROMISE_S


def test_a_base_that_thaws_drives_again_when_told_and_not_before(rig: NodeRig) -> None:
    rig.drive()
    rig.velocities.seconds_to_zero(rig.nodes["base"].strike("SIGSTOP"))
    thawed_s = rig.nodes["base"].strike("SIGCONT")
    assert rig.result(thawed_s)["outcome"] == "stopped"
    assert not any(any(twist) for at_s, twist in rig.velocities.all if at_s > thawed_s)
    assert rig.do("forward 10 cm")["outcome"] == "completed"


@pytest.mark.parametrize("whom", NODES)
def test_when_one_is_killed_the_robot_stands_within_250_ms(rig: NodeRig, whom: str) -> None:
    rig.rest()
    before = rig.truth.all[-1][1]
    rig.drive()
    time.sleep(1.0)
    struck_s = rig.nodes[whom].strike("SIGKILL")
    took_s = rig.velocities.seconds_to_zero(struck_s)
    if whom == "control":
        result, after = rig.result(struck_s), rig.truth.all[-1][1]
        assert result["reason"]["code"] == "control_silent"
        driven_m = math.hypot(after.x_m - before.x_m, after.y_m - before.y_m)
        assert result["path_m"] == pytest.approx(driven_m, abs=0.1), "as told last"
    rig.replace(whom, *REPLACEMENT.get(whom, ()))
    rig.drive()  # who took its place does its work
    rig.rest()
    print(f"SIGKILL {whom}: {took_s * 1e3:.0f} ms")
    assert took_s <= PROMISE_S


@pytest.mark.parametrize("whom", ["base", "input"])
def test_ctrl_c_stops_the_robot_first(rig: NodeRig, whom: str) -> None:
    """Of control, which stops it itself, test_leaving.py says the same."""
    rig.drive()
    took_s = rig.velocities.seconds_to_zero(rig.nodes[whom].strike("SIGINT"))
    exit_code = rig.nodes[whom].process.wait(10.0)
    rig.replace(whom)
    rig.rest()
    assert took_s <= PROMISE_S
    assert exit_code == 5


def test_a_base_without_control_says_so(rig: NodeRig) -> None:
    rig.nodes["control"].end()
    time.sleep(1.5)  # so long one that has left still counts as there
    said_s = rig.nodes["input"].say("forward")
    _, result = rig.events.wait_for(lambda event: event["event"] == "result", said_s)
    assert (result["outcome"], result["reason"]["code"]) == ("failed", "no_control")
