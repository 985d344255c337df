"""The motion budget of a control node is the one it was started with."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.wire.messages import Text
from tests.nodes.node_rig import running

pytestmark = pytest.mark.realtime


def test_what_control_was_started_with_holds_for_all_that_comes_over_topics(tmp_path: Path) -> None:
    with running(tmp_path, "base", "input") as rig:
        control = rig.start("node", "control", "--on", "dds", "--max-distance", "0.5")
        control.wait_for_line("control")
        assert rig.do("forward 1 m")["reason"]["code"] == "over_max_distance"
        limit = '{"word":"limit","source":"console","lease":"me","sequence":1,"payload":{"max_distance_m":"none"}}'
        rig.publish("chatgpt_node", Text(limit))
        control.wait_for_line("The limit of distance and time stays")
        assert rig.do("forward 1 m")["outcome"] == "refused"
        ended = rig.do("drive forward until a wall is within 50 cm")
        assert (ended["outcome"], ended["reason"]["code"]) == ("stopped", "max_distance_reached")
        assert ended["path_m"] == pytest.approx(0.5, abs=0.1)
