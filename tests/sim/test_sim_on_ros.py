"""The simulated robot on a wire of ROS: its callbacks come on the physics thread, its frames are REP-105's."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
from sim_rig import PROFILE
from tests.under_signals import see_every_wait_end

from chatrobot.core.errors import WireError
from chatrobot.robots.profile import Lidar
from chatrobot.sim.__main__ import main
from chatrobot.sim.network_wire import MarshalledWire, TransformPublisher
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Message, Number, Odometry
from chatrobot.wire.wire import Wire

STANDING = Odometry(1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0)


class Recorder(Wire):
    """A wire that keeps what it is told to publish."""

    def __init__(self) -> None:
        self.published: list[tuple[str, Mapping[str, Any]]] = []
        self.kept: set[str] = set()

    def publish_fields(
        self, topic: str, type_name: str, fields: Mapping[str, Any], *, is_kept: bool = False
    ) -> None:
        assert type_name == "tf2_msgs/msg/TFMessage"
        self.published.append((topic, fields))
        if is_kept:
            self.kept.add(topic)

    def publish(self, topic: str, message: Message) -> None: ...
    def subscribe(self, topic: str, kind: Any, callback: Any) -> None: ...
    def close(self) -> None: ...


def test_callbacks_come_on_the_thread_that_polls_and_in_order() -> None:
    hub = MemoryHub()
    wire = MarshalledWire(hub.connect())
    heard: list[tuple[float, threading.Thread]] = []
    wire.subscribe("topic", Number, lambda message: heard.append((message.data, threading.current_thread())))
    sender = threading.Thread(target=lambda: [hub.connect().publish("topic", Number(i)) for i in (1.0, 2.0)])
    sender.start()
    sender.join()
    assert heard == []
    wire.poll(0.0)
    assert heard == [(1.0, threading.current_thread()), (2.0, threading.current_thread())]


def test_a_signal_in_the_last_moment_of_a_wait_does_not_make_it_wait_for_ever() -> None:
    imports = (
        "from chatrobot.sim.network_wire import MarshalledWire\nfrom chatrobot.wire.memory import MemoryHub"
    )
    see_every_wait_end(imports, "MarshalledWire(MemoryHub().connect())", "poll(0.002)")


def test_a_robot_lives_on_while_its_network_is_gone() -> None:
    class Gone(Recorder):
        def publish(self, topic: str, message: Message) -> None:
            raise WireError(f"gone: {topic} {message}")

    MarshalledWire(Gone()).publish("odom", STANDING)


def test_what_moves_is_told_with_every_second_odometry_and_what_is_fixed_once_for_all() -> None:
    wire = Recorder()
    lidar = Lidar(x_m=0.1, y_m=0.0, yaw_rad=0.5, beams=360, min_range_m=0.05, max_range_m=12.0, rate_hz=10.0)
    transforms = TransformPublisher(wire, replace(PROFILE, lidar=lidar))
    for _ in range(4):
        transforms.after("odom", STANDING)
        transforms.after("truth", STANDING)
    assert [topic for topic, _ in wire.published] == ["/tf_static", "/tf", "/tf"]
    assert wire.kept == {"/tf_static"}
    (laser,), (base,) = (fields["transforms"] for _, fields in wire.published[:2])
    assert (base["header"]["frame_id"], base["child_frame_id"]) == ("odom", "base_link")
    assert base["transform"]["translation"] == {"x": 2.0, "y": 3.0}
    assert (laser["header"]["frame_id"], laser["child_frame_id"]) == ("base_link", "laser")
    assert laser["transform"]["translation"] == {"x": 0.1, "y": 0.0}


@pytest.mark.parametrize("options", [[], ["--on", "dds:x"], ["--on", "nowhere"]])
def test_a_wire_that_is_none_is_a_wrong_option(
    options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--profile", "wheeltec_mini_mec", *options]) == 2
    assert capsys.readouterr().err
