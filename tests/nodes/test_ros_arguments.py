"""What a node is told as ROS tells it: ros2 run, parameters, ROS's arguments, Ctrl-C while it starts."""

from __future__ import annotations

import ast
import math
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from chatrobot.cli import node as command
from chatrobot.cli import ros_run, sim
from chatrobot.cli.arguments import parse
from chatrobot.cli.node import open_ros_interfaces
from chatrobot.core.errors import UsageError
from chatrobot.nodes import control
from chatrobot.options import PARAMETERS
from chatrobot.programs.ros_args import split_ros_args
from chatrobot.robots.profile import MotionBudget
from tests.nodes.ros_graph import PATIENCE_S, Guard, fake_rclpy, running

ROOT = Path(__file__).parents[2]
PARAMS_FILE = ROOT / "ros" / "chatrobot" / "params" / "params.yaml"


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
    guards: list[Guard],
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


def test_open_loop_is_a_parameter_and_brings_its_robot(ros: fake_rclpy.Ros) -> None:
    def values(*ros_args: str) -> dict[str, Any]:
        args = parse(["node", "control", "--on", "ros", "--ros-args", *ros_args])
        args.approval, args.on = "profile", "ros:"
        ros_interfaces = open_ros_interfaces(args, args.ros_args)
        ros_interfaces.node.close()
        return {name: getattr(args, name) for name in ("robot", "open_loop")}

    assert values() == {"robot": "wheeltec_mini_mec", "open_loop": False}
    assert values("-p", "open_loop:=True") == {"robot": "no_odometry", "open_loop": True}
    assert values("-p", "open_loop:=True", "-p", "robot:=turtlesim") == {
        "robot": "turtlesim",
        "open_loop": True,
    }
    assert not ros.nodes


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
    args = parse(arguments)
    with pytest.raises(UsageError):
        (command if args.command == "node" else sim).run(args)


def test_ros_s_arguments_are_for_nodes() -> None:
    with pytest.raises(UsageError):
        parse(["do", "hi", "--ros-args", "-r", "a:=b"])


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
