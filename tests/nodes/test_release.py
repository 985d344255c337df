"""Over ROS an emergency stop is released only where `control` was told that it may be, and then by `base` alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.wire.messages import Text
from tests.nodes.node_rig import running

pytestmark = pytest.mark.realtime


def test_a_person_releases_an_emergency_stop_over_ros_where_control_was_told_so(tmp_path: Path) -> None:
    with running(tmp_path, "base", "input") as rig:
        control = rig.start("node", "control", "--on", "dds", "--allow-release")
        control.wait_for_line("control")
        assert rig.do("turn left 5 degrees")["outcome"] == "completed"
        writers = sorted(name.rpartition("/")[2] for name in rig.ear.publishers_of("cmd_vel"))
        assert writers == ["chatrobot_control", "chatrobot_guard"], "one writer, and its guard"
        said_s = rig.nodes["input"].say("emergency stop")
        rig.result(said_s, "Emergency stop")
        assert rig.do("forward")["outcome"] == "refused"
        rig.publish("chatgpt_node", Text('{"word":"release","source":"me","lease":"me","sequence":1}'))
        control.wait_for_line("The emergency stop stays: the me may not release it")
        rig.nodes["input"].say("release the emergency stop")
        control.wait_for_line("The emergency stop is released")
        assert rig.do("turn left 5 degrees")["outcome"] == "completed"
