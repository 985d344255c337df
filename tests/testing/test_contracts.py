"""The built-in primitives keep the contract that a third party's has to keep; what a fixture gives is what it says."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import chatrobot
from chatrobot.plan.primitive import AnyPrimitive, primitives
from chatrobot.testing.contracts import PrimitiveContract
from chatrobot.testing.rig import RecordingWire
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Text


class TestEveryPrimitive(PrimitiveContract):
    @pytest.fixture(autouse=True, params=primitives(), ids=lambda primitive: primitive.kind)
    def _take(self, request: pytest.FixtureRequest) -> None:
        taken: AnyPrimitive = request.param
        self.primitive = taken


def test_a_simulated_robot_is_closed_after_the_test(
    simulated_robot: Callable[..., chatrobot.Robot], request: pytest.FixtureRequest
) -> None:
    robot = simulated_robot()
    request.addfinalizer(robot.close)
    assert robot.do("forward 10 cm").outcome == "completed"


def test_a_recording_wire_keeps_what_goes_out_and_hears_what_comes_in() -> None:
    hub, heard = MemoryHub(), list[Text]()
    wire, other = RecordingWire(hub.connect()), hub.connect()
    wire.subscribe("topic", Text, heard.append)
    other.publish("topic", Text("in"))
    wire.publish("topic", Text("out"))
    assert heard == [Text("in"), Text("out")]
    assert wire.published == [("topic", Text("out"))]
