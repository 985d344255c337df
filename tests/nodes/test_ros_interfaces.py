"""Under ROS a running node of ours is what ROS expects: services, names, logs, diagnostics. rclpy is a fake here."""

from __future__ import annotations

import json
import signal
import sys
import threading
import time
from importlib import import_module
from typing import Any

import pytest

from chatrobot.cli import doctor, ros_run
from chatrobot.cli import node as command
from chatrobot.cli.arguments import parse
from chatrobot.cli.entry import STOPPED
from chatrobot.core.clock import RealClock
from chatrobot.core.errors import WireError
from chatrobot.language.phrases import say
from chatrobot.motion import runner
from chatrobot.wire.messages import Odometry, Text, TwistMessage
from tests.nodes.ros_graph import PATIENCE_S, Guard, Silent, fake_rclpy, running, until


def test_control_offers_its_services_and_stops_at_once(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard], ear: Any
) -> None:
    zero_came = threading.Event()
    ear.subscribe("cmd_vel", TwistMessage, lambda twist: any(twist) or zero_came.set())
    with running(monkeypatch, ros, "control"):
        assert set(ros.nodes[-1].services) == {"/chatrobot_control/stop", "/chatrobot_control/emergency_stop"}
        answer = ros.call("/chatrobot_control/stop")
        assert (answer.success, answer.message) == (
            True,
            "stop sent: no odometry shows whether the robot stands",
        )
        assert zero_came.wait(PATIENCE_S)
    assert guards[0].halts == ("ros:", "/cmd_vel", "/odom")


def test_an_emergency_stop_is_released_over_ros_only_where_that_was_switched_on(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard], ear: Any
) -> None:
    events: list[str] = []
    ear.subscribe("chatrobot/events", Text, lambda message: events.append(message.data))
    with running(monkeypatch, ros, "control", "--ros-args", "-p", "allow_release:=true"):
        assert not ros.call("/chatrobot_control/release").message.startswith("not")
        assert ros.call("/chatrobot_control/emergency_stop").success
        assert ros.call("/chatrobot_control/release").message == "released"
    assert guards


def test_namespace_remapping_and_name_reach_the_guard_and_the_graph(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard]
) -> None:
    words = [
        "-r",
        "__ns:=/robot1",
        "-r",
        "cmd_vel:=/base/go",
        "-r",
        "__node:=driver",
        "-p",
        "robot:=originbot",
    ]
    with running(monkeypatch, ros, "control", "--ros-args", *words):
        node = ros.nodes[-1]
        assert f"{node.namespace}/{node.name}" == "/robot1/driver"
        assert "/robot1/driver/stop" in node.services
    assert guards[0].halts == ("ros:", "/base/go", "/robot1/odom")
    assert guards[0].namespace == "robot1"


def test_it_logs_through_ros_in_sentences_and_its_banner_names_the_topics_as_they_are(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard], ear: Any
) -> None:
    words = ("--ros-args", "-r", "__ns:=/robot1", "-r", "cmd_vel:=/base/go")
    with running(monkeypatch, ros, "control", *words):
        ear.publish("/robot1/chatgpt_node", Text("good morning"))
        name, notice = "robot1.chatrobot_control", say("en", "foreign_ignored", text="good morning")
        until(lambda: ("warn", name, notice) in ros.log)
    severity, logger, banner = ros.log[0]
    assert (severity, logger) == ("info", name)
    assert "/robot1/chatgpt_node → /base/go" in banner
    assert guards


@pytest.mark.parametrize(
    ("node", "banner"),
    [("base", "/robot1/user_input → /robot1/chatgpt_node"), ("input", "goes to /robot1/user_input")],
)
def test_the_other_banners_name_the_topics_as_they_are(
    monkeypatch: pytest.MonkeyPatch,
    ros: fake_rclpy.Ros,
    capsys: pytest.CaptureFixture[str],
    node: str,
    banner: str,
) -> None:
    monkeypatch.setattr("chatrobot.cli.lines.LineReader", Silent)
    said = ""
    with running(monkeypatch, ros, node, "--ros-args", "-r", "__ns:=/robot1"):
        while banner not in said:
            said += capsys.readouterr().out + "".join(text for _, _, text in ros.log)
            threading.Event().wait(0.01)


def test_events_are_quiet_while_nothing_happens_and_telemetry_has_a_topic_of_its_own(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard], ear: Any
) -> None:
    events: list[str] = []
    telemetry: list[dict[str, Any]] = []
    ear.subscribe("chatrobot/events", Text, lambda message: events.append(message.data))
    ear.subscribe("chatrobot/telemetry", Text, lambda message: telemetry.append(json.loads(message.data)))
    with running(monkeypatch, ros, "control"):

        def has_told_enough() -> bool:
            ear.publish("odom", Odometry(time.monotonic(), 1.0, 2.0, 0.0, 0.0, 0.0, 0.0))
            return len(telemetry) > 5

        until(has_told_enough)
    assert all(json.loads(event)["event"] == "notice" for event in events), "said once, as it starts"
    assert len(events) < 2
    assert {told["event"] for told in telemetry} == {"telemetry"}
    assert telemetry[-1]["pose"]["y_m"] == 2.0
    assert guards


def test_diagnostics_tell_how_a_node_is(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, ear: Any
) -> None:
    from chatrobot.wire.ros.convert import message_class

    heard: list[Any] = []
    came = threading.Event()
    qos = fake_rclpy.SimpleNamespace(reliability=fake_rclpy.Option.RELIABLE)
    ear.node.handle.create_subscription(
        message_class("diagnostic_msgs/msg/DiagnosticArray"),
        "/diagnostics",
        lambda message: (heard.append(message), came.set()),
        qos,
    )
    with running(monkeypatch, ros, "base", "--ros-args", "-p", "diagnostics_period_s:=0.1"):
        assert came.wait(PATIENCE_S)
    (status,) = heard[0].status
    assert (status.name, status.message, status.level) == ("/chatrobot_base", "no_control", b"\1")
    assert {value.key for value in status.values} >= {"profile"}


def test_motion_keeps_the_simulation_s_time_and_the_guard_real_time(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard]
) -> None:
    clocks: list[Any] = []

    class Spy(runner.Motion):
        def __init__(self, profile: Any, wire: Any, clock: Any, *rest: Any) -> None:
            clocks.append(clock)
            super().__init__(profile, wire, clock, *rest)

    monkeypatch.setattr(runner, "Motion", Spy)
    ros.clock_s = 12.5
    with running(monkeypatch, ros, "control", "--ros-args", "-p", "use_sim_time:=true"):
        assert clocks[0].now_s() == 12.5
        assert isinstance(guards[0].given_clock, RealClock)


def test_without_a_clock_a_node_that_follows_simulated_time_does_not_start(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros
) -> None:
    monkeypatch.setattr(import_module("chatrobot.nodes.ros_interfaces"), "SIMULATED_TIME_S", 0.05)
    with pytest.raises(WireError, match="/clock"):
        command.run(parse(["node", "base", "--on", "ros", "--ros-args", "-p", "use_sim_time:=true"]))
    assert not ros.nodes


def test_asked_to_end_a_node_of_ros_gives_zero(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[Guard]
) -> None:
    with running(monkeypatch, ros, "control") as codes:
        pass
    assert codes == [0]
    monkeypatch.setattr(ros_run, "main", lambda _: STOPPED)
    monkeypatch.setattr(sys, "argv", ["control"])
    before = signal.getsignal(signal.SIGINT)
    assert ros_run.control_node() == 0, "Ctrl-C while it starts"
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN, "a second one would break off its end"
    signal.signal(signal.SIGINT, before)
    assert guards


def test_doctor_tells_which_ros_is_here_and_who_is_on_it(ros: fake_rclpy.Ros, ear: Any) -> None:
    ear.advertise("odom", Odometry)
    check = doctor._ros(parse(["doctor"]))
    assert check.state == "ok"
    assert check.text.startswith("jazzy with rmw_fake_cpp; on domain ")
    assert check.text.endswith("/ear publishes odom")
    assert [node.name for node in ros.nodes] == ["ear"]


def test_doctor_says_how_to_get_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    check = doctor._ros(parse(["doctor"]))
    assert check.state == "later"
    assert "not for this Python" in check.text
    assert "source /opt/ros" in check.text
