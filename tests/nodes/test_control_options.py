"""What `control` was told as it started holds for all that comes over topics: its motion budget, and who releases."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from chatrobot.wire.messages import Text
from tests.nodes.node_rig import Node, NodeRig, running

pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes"), "base", "input") as made:
        yield made


@pytest.fixture(scope="module")
def control(rig: NodeRig) -> Node:
    started = rig.start("node", "control", "--on", "dds", "--max-distance", "0.5", "--allow-release")
    started.wait_for_line("control")
    return started


def test_its_motion_budget_is_the_one_it_was_started_with(rig: NodeRig, control: Node) -> None:
    assert rig.do("forward 1 m")["reason"]["code"] == "over_max_distance"
    limit = (
        '{"word":"limit","source":"console","lease":"me","sequence":1,"payload":{"max_distance_m":"none"}}'
    )
    rig.publish("chatgpt_node", Text(limit))
    control.wait_for_line("The limits of distance and time are unchanged")
    assert rig.do("forward 1 m")["outcome"] == "refused"
    ended = rig.do("drive forward until a wall is within 50 cm")
    assert (ended["outcome"], ended["reason"]["code"]) == ("stopped", "max_distance_reached")
    assert ended["path_m"] == pytest.approx(0.5, abs=0.1)


def test_a_person_releases_an_emergency_stop_over_ros_where_control_was_told_so(
    rig: NodeRig, control: Node
) -> None:
    """By `base` alone."""
    assert rig.do("turn left 5 degrees")["outcome"] == "completed"
    writers = sorted(name.rpartition("/")[2] for name in rig.ear.publishers_of("cmd_vel"))
    assert writers == ["chatrobot_control", "chatrobot_guard"], "one writer, and its guard"
    said_s = rig.nodes["input"].say("emergency stop")
    rig.result(said_s, "Emergency stop")
    assert rig.do("forward")["outcome"] == "refused"
    rig.publish("chatgpt_node", Text('{"word":"release","source":"me","lease":"me","sequence":1}'))
    control.wait_for_line("Emergency stop still active: the me may not release it")
    rig.nodes["input"].say("release the emergency stop")
    control.wait_for_line("The emergency stop is released")
    assert rig.do("turn left 5 degrees")["outcome"] == "completed"
