"""`chatrobot node input|base|control`: one of the tutorial's three nodes, until Ctrl-C. A stop goes out first."""

from __future__ import annotations

import argparse
import contextlib
import sys
from typing import TYPE_CHECKING

from chatrobot.cli.entry import STOPPED
from chatrobot.cli.parameters import parameters_in, read_parameters
from chatrobot.cli.signals import SignalWatch
from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.process import wake_promptly
from chatrobot.robots.profile import MotionBudget
from chatrobot.wire.connect import Connect, connect_wire

if TYPE_CHECKING:
    from chatrobot.nodes.ros_interfaces import RosInterfaces

REPEATS_S = 2.0
"""`ros2 launch` sends each node the Ctrl-C that the terminal has sent it already: so soon it is the same one."""


def run(args: argparse.Namespace) -> int:
    """0 where its input has ended; where it was asked to end 5, and 0 as a node of ROS, which has no other way to."""
    if args.fast or args.trace or args.sim:
        raise UsageError("a node drives a robot on a wire", allowed="leave out --fast, --trace and --sim")
    wake_promptly()  # before there are threads, which take after this one
    args.approval = "all" if args.approve else "none" if args.yes else "profile"
    ros_args = [*args.ros_args, *(word for given in args.parameters for word in ("-p", given))]
    if _address(args).startswith("ros:"):
        from chatrobot.cli.ros_node import open_ros_interfaces

        ros_interfaces = open_ros_interfaces(args, _address(args), ros_args)
        connect: Connect = ros_interfaces.connect
    else:
        ros_interfaces, connect = None, connect_wire
        vars(args).update(read_parameters(parameters_in(ros_args)))
    has_left = {"input": _run_input, "base": _run_base, "control": _run_control}[args.which](
        args, ros_interfaces, connect
    )
    return STOPPED if has_left and ros_interfaces is None else 0


def _run_control(args: argparse.Namespace, ros_interfaces: RosInterfaces | None, connect: Connect) -> bool:
    from chatrobot.core.events import Event, Started
    from chatrobot.link.topic_link import CHATGPT_NODE
    from chatrobot.nodes.control import ControlNode, ControlOptions
    from chatrobot.nodes.log import Log, on_stderr
    from chatrobot.nodes.told import told

    log = Log(on_stderr if ros_interfaces is None else ros_interfaces.log)

    def note(event: Event) -> None:
        line = told(event)
        if line is not None:
            log(*line)

    told(Started(1))  # reads the tables of words now, not in the middle of a motion
    node = ControlNode(
        ControlOptions(
            _address(args),
            _profile(args),
            _world(args),
            args.allow_release,
            args.accept_others,
            args.on_robot,
            MotionBudget(args.max_distance, args.max_time),
            args.open_loop,
        ),
        connect,
        note,
    )

    def stop(why: str) -> None:
        with contextlib.suppress(WireError):
            node.stop(why)

    def is_leaving() -> bool:
        if watch.is_leaving:
            node.leave()
        return watch.is_leaving

    with contextlib.closing(log), SignalWatch(stop, repeats_s=REPEATS_S) as watch:
        if ros_interfaces is not None:
            node.introduce(ros_interfaces)
        way = f"{node.resolved(CHATGPT_NODE)} → {node.cmd_vel_topic}"
        log("info", f"control drives {args.robot} on {_place(args)}: {way}; Ctrl-C stops and ends")
        node.run(is_leaving)
    return True


def _run_base(args: argparse.Namespace, ros_interfaces: RosInterfaces | None, connect: Connect) -> bool:
    from chatrobot.cli.choices import model_from
    from chatrobot.cli.folders import config_folder
    from chatrobot.dialogue.llm.terms import ModelOptions
    from chatrobot.link.topic_link import CHATGPT_NODE, USER_INPUT
    from chatrobot.nodes.base import BaseNode, BaseOptions
    from chatrobot.nodes.log import Log

    log = Log((lambda _, text: _say(text)) if ros_interfaces is None else ros_interfaces.log)
    node = BaseNode(
        BaseOptions(
            _address(args),
            _profile(args),
            _world(args),
            config_folder(args),
            args.generate_code,
            args.revChatGPT,
            args.interpreter,
            model_from(args, server_held=args.revChatGPT),
            ModelOptions(rounds=args.rounds, budget_tokens=args.budget_tokens, budget_s=args.budget_s),
            args.approval,
            args.open_loop,
        ),
        log,
        connect,
    )
    with contextlib.closing(log), SignalWatch(node.stop, repeats_s=REPEATS_S) as watch:
        if ros_interfaces is not None:
            node.introduce(ros_interfaces)
        way = f"{node.resolved(USER_INPUT)} → {node.resolved(CHATGPT_NODE)}"
        ready = f"base understands for {args.robot} on {_place(args)}: {way}"
        node.run(lambda: watch.is_leaving, lambda: log("info", ready))
    return True


def _run_input(args: argparse.Namespace, _: RosInterfaces | None, connect: Connect) -> bool:
    """On standard output alone: it is a person's terminal, and what is said is on topics already."""
    from chatrobot.cli.lines import LineReader
    from chatrobot.language.phrases import say
    from chatrobot.link.topic_link import USER_INPUT
    from chatrobot.nodes.input import InputNode
    from chatrobot.robots.load import load_profile

    node = InputNode(_address(args), load_profile(_profile(args)).wiring, _say, connect)

    def on_line(line: str) -> None:
        if not node.say(line):
            _say(say("en", "unsaid"))

    reader = LineReader(on_line)
    with SignalWatch(lambda _: node.stop(), repeats_s=REPEATS_S) as watch:
        _say(f"input on {_place(args)}: each line goes to {node.resolved(USER_INPUT)}")
        reader.start()
        while not (watch.is_leaving or reader.has_ended):
            reader.wait(0.1)
        node.close()
    return watch.is_leaving


def _address(args: argparse.Namespace) -> str:
    from chatrobot.wire.connect import wire_address

    return wire_address("dds" if args.on == "auto" else args.on)


def _place(args: argparse.Namespace) -> str:
    """The address as a person would say it."""
    return _address(args).rstrip(":")


def _profile(args: argparse.Namespace) -> str:
    from chatrobot.cli.folders import profile_folders
    from chatrobot.robots.load import profile_argument

    return profile_argument(args.robot, profile_folders(args))


def _world(args: argparse.Namespace) -> str:
    return args.world or "empty"


def _say(text: str) -> None:
    with contextlib.suppress(OSError):
        print(text, file=sys.stdout, flush=True)
