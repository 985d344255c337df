"""Under ROS our nodes are what ROS expects: parameters, services, diagnostics, names. rclpy is a fake here."""

from __future__ import annotations

import ast
import json
import math
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import yaml

sys.path.insert(0, str(Path(__file__).parents[1] / "wire"))
import fake_rclpy

from chatrobot.cli import doctor, ros_run
from chatrobot.cli import node as command
from chatrobot.cli.arguments import parse, split_ros_args
from chatrobot.cli.entry import STOPPED
from chatrobot.core.clock import RealClock, VirtualClock
from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.motion_budget import MotionBudget
from chatrobot.language.phrases import say
from chatrobot.nodes import control
from chatrobot.nodes.parameters import PARAMETERS
from chatrobot.session import motion_runner
from chatrobot.session.guard_link import SimulatedGuard
from chatrobot.wire.messages import Odometry, Text, TwistMessage

ROOT = Path(__file__).parents[2]
PARAMS_FILE = ROOT / "ros" / "chatrobot" / "params" / "params.yaml"
PATIENCE_S = 10.0


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> fake_rclpy.Ros:
    monkeypatch.setattr("chatrobot.language.typed._is_ros", False)  # a node sets it for its process
    return fake_rclpy.install(monkeypatch)


class _Guard(SimulatedGuard):
    """In place of the guard's process, which has no fake of ROS."""

    def __init__(self, address: str, wiring: Any, clock: Any, *, is_near: bool) -> None:
        super().__init__(VirtualClock())
        self.given_clock = clock
        self.halts = address, wiring.cmd_vel_topic, wiring.odom_topic
        self.namespace = wiring.namespace
        self.is_near = is_near

    def wait_until_alive(self, _timeout_s: float) -> bool:
        return True


@pytest.fixture
def guards(monkeypatch: pytest.MonkeyPatch) -> list[_Guard]:
    made: list[_Guard] = []

    def make(address: str, wiring: Any, clock: Any, *, is_near: bool) -> _Guard:
        made.append(_Guard(address, wiring, clock, is_near=is_near))
        return made[-1]

    monkeypatch.setattr(motion_runner, "GuardProcess", make)
    return made


class _Watch:
    """In place of the signals': this is not the main thread."""

    leaving = threading.Event()

    def __init__(self, stop: Callable[[str], None], *, repeats_s: float) -> None:
        self._stop = stop
        assert repeats_s > 0.0, "ros2 launch sends a second Ctrl-C"

    def __enter__(self) -> _Watch:
        return self

    def __exit__(self, *_: object) -> None: ...

    @property
    def is_leaving(self) -> bool:
        return self.leaving.is_set()


class _Silent:
    """In place of a keyboard."""

    has_ended = False

    def __init__(self, on_line: object) -> None: ...
    def start(self) -> None: ...

    def wait(self, timeout_s: float) -> None:
        threading.Event().wait(timeout_s)


def _until(condition: Callable[[], bool]) -> None:
    for _ in range(round(PATIENCE_S / 0.01)):
        if condition():
            return
        threading.Event().wait(0.01)
    raise AssertionError("it did not become so")


@contextmanager
def running(monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, *arguments: str) -> Iterator[list[int]]:
    """`chatrobot node …` in a thread, once its services are there; its exit code once it has ended."""
    monkeypatch.setattr(command, "SignalWatch", _Watch)
    monkeypatch.setattr(_Watch, "leaving", threading.Event())
    known = len(ros.nodes)
    codes: list[int] = []
    args = parse(["node", "--on", "ros", *arguments])
    thread = threading.Thread(target=lambda: codes.append(command.run(args)))
    thread.start()

    def is_there() -> bool:
        assert thread.is_alive()
        return len(ros.nodes) > known and bool(ros.nodes[-1].timers or arguments[0] == "input")

    try:
        _until(is_there)
        yield codes
    finally:
        _Watch.leaving.set()
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
    assert len(ros.nodes) == known, "the node is still there"


@pytest.fixture
def ear(ros: fake_rclpy.Ros) -> Iterator[Any]:  # noqa: ARG001
    from chatrobot.core.wiring import Wiring
    from chatrobot.wire.connect import connect_wire

    wire = connect_wire("ros:", Wiring(), "ear")
    yield wire
    wire.close()


def test_control_offers_its_services_and_stops_at_once(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard], ear: Any
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
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard], ear: Any
) -> None:
    events: list[str] = []
    ear.subscribe("chatrobot/events", Text, lambda message: events.append(message.data))
    with running(monkeypatch, ros, "control", "--ros-args", "-p", "allow_release:=true"):
        assert not ros.call("/chatrobot_control/release").message.startswith("not")
        assert ros.call("/chatrobot_control/emergency_stop").success
        assert ros.call("/chatrobot_control/release").message == "released"
    assert guards


@pytest.mark.parametrize(
    ("words", "budget"),
    [
        ((), MotionBudget()),
        (("--max-distance", "3", "--max-time", "none"), MotionBudget(3.0, math.inf)),
        (("--ros-args", "-p", "max_distance_m:=1.5"), MotionBudget(1.5)),
        (("--max-time", "9", "--ros-args", "-p", "max_time_s:=-1.0"), MotionBudget(None, math.inf)),
        (("--max-time", "9", "--ros-args", "-p", "max_time_s:=0.0"), MotionBudget()),
    ],
)
def test_control_takes_its_motion_budget_from_options_and_parameters(
    monkeypatch: pytest.MonkeyPatch,
    ros: fake_rclpy.Ros,
    guards: list[_Guard],
    words: tuple[str, ...],
    budget: MotionBudget,
) -> None:
    given: list[MotionBudget] = []
    begin = control.MotionRunner.__init__

    def note(self: Any, *arguments: Any, **named: Any) -> None:
        given.append(named["budget"])
        begin(self, *arguments, **named)

    monkeypatch.setattr(control.MotionRunner, "__init__", note)
    with running(monkeypatch, ros, "control", *words):
        assert given == [budget]
    assert guards


def test_namespace_remapping_and_name_reach_the_guard_and_the_graph(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard]
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
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard], ear: Any
) -> None:
    words = ("--ros-args", "-r", "__ns:=/robot1", "-r", "cmd_vel:=/base/go")
    with running(monkeypatch, ros, "control", *words):
        ear.publish("/robot1/chatgpt_node", Text("good morning"))
        name, notice = "robot1.chatrobot_control", say("en", "foreign_ignored", text="good morning")
        _until(lambda: ("warn", name, notice) in ros.log)
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
    monkeypatch.setattr("chatrobot.cli.lines.LineReader", _Silent)
    said = ""
    with running(monkeypatch, ros, node, "--ros-args", "-r", "__ns:=/robot1"):
        while banner not in said:
            said += capsys.readouterr().out + "".join(text for _, _, text in ros.log)
            threading.Event().wait(0.01)


def test_asked_to_end_a_node_of_ros_gives_zero(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard]
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


def test_events_are_quiet_while_nothing_happens_and_telemetry_has_a_topic_of_its_own(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard], ear: Any
) -> None:
    events: list[str] = []
    telemetry: list[dict[str, Any]] = []
    ear.subscribe("chatrobot/events", Text, lambda message: events.append(message.data))
    ear.subscribe("chatrobot/telemetry", Text, lambda message: telemetry.append(json.loads(message.data)))
    with running(monkeypatch, ros, "control"):

        def has_told_enough() -> bool:
            ear.publish("odom", Odometry(time.monotonic(), 1.0, 2.0, 0.0, 0.0, 0.0, 0.0))
            return len(telemetry) > 5

        _until(has_told_enough)
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


def test_the_command_line_is_the_default_and_ros_s_parameters_go_before_it(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros
) -> None:
    words = ("base", "--robot", "turtlesim", "--world", "home", "--interpreter", "offline")
    words = (*words, "-p", "generate_code:=True")
    with running(monkeypatch, ros, *words, "--ros-args", "-p", "robot:=originbot"):
        values = ros.parameters("chatrobot_base")
    assert values == {
        "use_sim_time": False,
        "generate_code": True,
        "revChatGPT": False,
        "open_loop": False,
        "robot": "originbot",
        "world": "home",
        "diagnostics_period_s": 1.0,
        "config_dir": "",
        "interpreter": "offline",
        "model": "",
        "approval": "profile",
        "rounds": 6,
        "budget_tokens": 20_000,
        "budget_s": 600.0,
    }


@pytest.mark.parametrize(
    "given",
    [
        "diagnostics_period_s:=0.01",
        "generate_code:=perhaps",
        "robot:=1.0",
        "rounds:=0",
        "interpreter:=psychic",
    ],
)
def test_a_parameter_out_of_range_or_of_another_type_is_refused(ros: fake_rclpy.Ros, given: str) -> None:
    with pytest.raises(UsageError, match=given.partition(":")[0]):
        command.run(parse(["node", "base", "--on", "ros", "--ros-args", "-p", given]))
    assert not ros.nodes


def test_motion_keeps_the_simulation_s_time_and_the_guard_real_time(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, guards: list[_Guard]
) -> None:
    clocks: list[Any] = []

    class Spy(motion_runner.Motion):
        def __init__(self, profile: Any, wire: Any, clock: Any, *rest: Any) -> None:
            clocks.append(clock)
            super().__init__(profile, wire, clock, *rest)

    monkeypatch.setattr(motion_runner, "Motion", Spy)
    ros.clock_s = 12.5
    with running(monkeypatch, ros, "control", "--ros-args", "-p", "use_sim_time:=true"):
        assert clocks[0].now_s() == 12.5
        assert isinstance(guards[0].given_clock, RealClock)


def test_without_a_clock_a_node_that_follows_simulated_time_does_not_start(
    monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros
) -> None:
    monkeypatch.setattr(import_module("chatrobot.nodes.citizen"), "SIMULATED_TIME_S", 0.05)
    with pytest.raises(WireError, match="/clock"):
        command.run(parse(["node", "base", "--on", "ros", "--ros-args", "-p", "use_sim_time:=true"]))
    assert not ros.nodes


def test_every_parameter_is_described_and_stands_in_the_file_with_its_default(ros: fake_rclpy.Ros) -> None:
    text = PARAMS_FILE.read_text(encoding="utf-8")
    listed = yaml.safe_load(text)
    assert set(listed) == {f"/**/chatrobot_{name}" for name, known in PARAMETERS.items() if known}
    for name, known in PARAMETERS.items():
        if known:
            values = listed[f"/**/chatrobot_{name}"]["ros__parameters"]
            assert values.pop("use_sim_time") is False
            assert values == {parameter.name: parameter.default for parameter in known}
            for parameter in known:
                bounds = f" ({parameter.bounds[0]} to {parameter.bounds[1]})" if parameter.bounds else ""
                assert f"# {parameter.description}{bounds}\n" in text
    assert not ros.nodes


def test_every_parameter_stands_on_the_page_and_every_switch_of_a_launch_line_is_one() -> None:
    page = (ROOT / "docs" / "ros.md").read_text(encoding="utf-8")
    names = {parameter.name for known in PARAMETERS.values() for parameter in known}
    assert {name for name in names if f"| `{name}` |" in page} == names
    launch = (ROOT / "ros" / "chatrobot" / "launch" / "robot.launch.py").read_text(encoding="utf-8")
    of_one = re.search("^OF_ONE = (.*?^})", launch, re.MULTILINE | re.DOTALL)
    assert of_one is not None
    assert set(re.findall(r'^    "(\w+)":', launch[: of_one.start()], re.MULTILINE)) <= {
        *names,
        "use_sim_time",
    }
    for node, own in ast.literal_eval(of_one[1]).items():
        assert own <= {parameter.name for parameter in PARAMETERS[node]}


def test_doctor_tells_which_ros_is_here_and_who_is_on_it(ros: fake_rclpy.Ros, ear: Any) -> None:
    ear.advertise("odom", Odometry)
    check = doctor._ros(parse(["doctor"]))
    assert check.state == "ok"
    assert check.text.startswith("jazzy with rmw_fake_cpp; on domain ")
    assert check.text.endswith("/ear tells odom")
    assert [node.name for node in ros.nodes] == ["ear"]


def test_doctor_says_how_to_get_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    check = doctor._ros(parse(["doctor"]))
    assert check.state == "later"
    assert "not for this Python" in check.text
    assert "source /opt/ros" in check.text


@pytest.mark.parametrize("which", ["base", "control"])
def test_help_under_ros2_run_lists_the_parameters_with_their_defaults(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], which: str
) -> None:
    monkeypatch.setattr(sys, "argv", [f"/ws/lib/chatGPT_test/chatGPT_{which}", "--help"])
    assert {"base": ros_run.base_node, "control": ros_run.control_node}[which]() == 0
    text = capsys.readouterr().out
    assert text.startswith(f"usage: ros2 run chatGPT_test chatGPT_{which} --ros-args")
    for parameter in PARAMETERS[which]:
        assert f"\n  {parameter.name}:=" in text
    assert "world:=empty" in text
    assert "--on" not in text


def test_open_loop_is_a_parameter_and_brings_its_robot(ros: fake_rclpy.Ros) -> None:
    def values(*ros_args: str) -> dict[str, Any]:
        from chatrobot.cli.ros_node import open_citizen

        args = parse(["node", "control", "--on", "ros", "--ros-args", *ros_args])
        args.approval = "profile"
        citizen = open_citizen(args, "ros:", args.ros_args)
        citizen.node.close()
        return {name: getattr(args, name) for name in ("robot", "open_loop")}

    assert values() == {"robot": "wheeltec_mini_mec", "open_loop": False}
    assert values("-p", "open_loop:=True") == {"robot": "no_odometry", "open_loop": True}
    assert values("-p", "open_loop:=True", "-p", "robot:=turtlesim") == {
        "robot": "turtlesim",
        "open_loop": True,
    }
    assert not ros.nodes


@pytest.mark.parametrize(
    ("executable", "command_line"),
    [
        (ros_run.input_node, ["node", "input"]),
        (ros_run.base_node, ["node", "base"]),
        (ros_run.control_node, ["node", "control"]),
        (ros_run.simulated_robot, ["sim"]),
    ],
)
def test_ros2_run_starts_what_the_command_line_starts(
    monkeypatch: pytest.MonkeyPatch, executable: Callable[[], int], command_line: list[str]
) -> None:
    started: list[list[str]] = []
    monkeypatch.setattr(ros_run, "main", lambda arguments: started.append(arguments) or 7)
    monkeypatch.setattr(sys, "argv", ["/ws/lib/chatrobot/it", "--ros-args", "-r", "a:=b"])
    before = signal.getsignal(signal.SIGINT)
    assert executable() == 7
    assert signal.getsignal(signal.SIGINT) is before
    assert started == [[*command_line, "--on", "ros", "--ros-args", "-r", "a:=b"]]


INTERRUPTED = """
import signal, sys, time
from chatrobot.cli import ros_run
from chatrobot.cli.entry import STOPPED

def starting(_arguments):
    try:
        print("starts", flush=True)
        while True:
            time.sleep(0.01)
    except KeyboardInterrupt:
        time.sleep(0.4)
        return STOPPED

ros_run.main = starting
code = ros_run.control_node()
time.sleep(0.4)
sys.exit(code)
"""


def test_while_a_node_starts_the_first_of_two_ctrl_c_counts_and_the_second_breaks_off_nothing() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "starts\n"
    for _ in range(3):  # the last one comes as it leaves
        process.send_signal(signal.SIGINT)
        time.sleep(0.25)
    _, said = process.communicate(timeout=20.0)
    assert (process.returncode, said) == (0, "")


SWALLOWED = """
import sys, time
from chatrobot.cli import ros_run

def starting(_arguments):
    try:
        print("starts", flush=True)
        while True:
            time.sleep(0.01)
    except KeyboardInterrupt:
        time.sleep(20.0)
    return 1

ros_run.main, ros_run.UNWIND_S = starting, 0.3
sys.exit(ros_run.control_node())
"""


def test_a_ctrl_c_that_a_library_swallows_while_a_node_starts_ends_it_all_the_same() -> None:
    process = subprocess.Popen([sys.executable, "-c", SWALLOWED], text=True, stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == "starts\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(PATIENCE_S) == 0


def test_ros_s_arguments_end_at_two_dashes() -> None:
    words = [
        "node",
        "base",
        "--ros-args",
        "-r",
        "a:=b",
        "--",
        "--robot",
        "turtlesim",
        "--ros-args",
        "-p",
        "c:=1",
    ]
    assert split_ros_args(words) == (["node", "base", "--robot", "turtlesim"], ["-r", "a:=b", "-p", "c:=1"])


@pytest.mark.parametrize(
    "arguments",
    [
        ["node", "base", "--on", "dds", "--ros-args", "-r", "a:=b"],
        ["sim", "--ros-args", "-r", "a:=b"],
    ],
)
def test_ros_s_arguments_need_ros(arguments: list[str]) -> None:
    from chatrobot.cli import sim

    args = parse(arguments)
    with pytest.raises(UsageError):
        (command if args.command == "node" else sim).run(args)


def test_ros_s_arguments_are_for_nodes() -> None:
    with pytest.raises(UsageError):
        parse(["do", "hi", "--ros-args", "-r", "a:=b"])
