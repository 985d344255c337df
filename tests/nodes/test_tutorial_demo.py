"""The tutorial's text demo with no ROS and no model: four processes on the real wire."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.nodes.node_rig import NodeRig, running

from chatrobot.wire.messages import Flag, Text

pytestmark = pytest.mark.realtime

FIRST_PROMPT = (
    "I have now connected your output to the ros node, I want you to control the car movement, so I need you to"
    " translate what I say into the car movement instructions, such as: “Go forward”, I need you to answer:"
    " “linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0”."
)
SLOW = "linear.x = 0.2,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0"


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes")) as made:
        yield made


def test_the_first_prompt_moves_nothing(rig: NodeRig) -> None:
    result = rig.do(FIRST_PROMPT)
    assert result["outcome"] != "completed"
    assert not any(any(twist) for _, twist in rig.velocities.all)


def test_forward_backward_left_right_end_where_they_should(rig: NodeRig) -> None:
    x0, y0, yaw0 = rig.pose()
    assert rig.do("forward")["outcome"] == "completed"
    x1, y1, _ = rig.pose()
    assert (x1 - x0, y1 - y0) == (pytest.approx(0.5, abs=0.02), pytest.approx(0.0, abs=0.02))
    assert rig.do("backward")["outcome"] == "completed"
    x2, y2, _ = rig.pose()
    assert (x2, y2) == (pytest.approx(x0, abs=0.02), pytest.approx(y0, abs=0.02))
    assert rig.do("left")["outcome"] == "completed"
    assert rig.pose()[2] - yaw0 == pytest.approx(math.pi / 2, abs=0.05)
    assert rig.do("right")["outcome"] == "completed"
    assert rig.pose()[2] == pytest.approx(yaw0, abs=0.05)
