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
from chatrobot.core.motion_budget import MotionBudget
from chatrobot.wire.connect import Connect, connect_wire

if TYPE_CHECKING:
    from chatrobot.nodes.citizen import Citizen


def run(args: argparse.Namespace) -> int:
    """0 where its input has ended, 5 where it was asked to end."""
    if args.fast or args.trace or args.sim:
        raise UsageError("a node drives a robot on a wire", allowed="leave out --fast, --trace and --sim")
    args.approval = "all" if args.approve else "none" if args.yes else "profile"
    ros_args = [*args.ros_args, *(word for given in args.parameters for word in ("-p", given))]
    if _address(args).startswith("ros:"):
        from chatrobot.cli.ros_node import open_citizen

        citizen = open_citizen(args, _address(args), ros_args)
        connect: Connect = citizen.connect
    else:
        citizen, connect = None, connect_wire
        vars(args).update(read_parameters(parameters_in(ros_args)))
    return {"input": _run_input, "base": _run_base, "control": _run_control}[args.which](
        args, citizen, connect
    )


def _run_control(args: argparse.Namespace, citizen: Citizen | None, connect: Connect) -> int:
    from chatrobot.nodes.control import ControlNode, ControlOptions

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
    )

    def stop(why: str) -> None:
        with contextlib.suppress(WireError):
            node.stop(why)

    def is_leaving() -> bool:
        if watch.is_leaving:
            node.leave()
        return watch.is_leaving

    with SignalWatch(stop) as watch:
        if citizen is not None:
            node.introduce(citizen)
        _say(f"control drives {args.robot} on {_place(args)}: chatgpt_node → cmd_vel; Ctrl-C stops and ends")
        node.run(is_leaving)
    return STOPPED


def _run_base(args: argparse.Namespace, citizen: Citizen | None, connect: Connect) -> int:
    from chatrobot.cli.choices import model_from
    from chatrobot.cli.folders import config_folder
    from chatrobot.nodes.base import BaseNode, BaseOptions
    from chatrobot.session.model_terms import ModelOptions

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
        _say,
        connect,
    )
    with SignalWatch(node.stop) as watch:
        if citizen is not None:
            node.introduce(citizen)
        ready = f"base understands for {args.robot} on {_place(args)}: user_input → chatgpt_node"
        node.run(lambda: watch.is_leaving, lambda: _say(ready))
    return STOPPED


def _run_input(args: argparse.Namespace, _: Citizen | None, connect: Connect) -> int:
    from chatrobot.cli.lines import LineReader
    from chatrobot.language.phrases import say
    from chatrobot.nodes.input import InputNode
    from chatrobot.robots.load import load_profile

    node = InputNode(_address(args), load_profile(_profile(args)).wiring, _say, connect)

    def on_line(line: str) -> None:
        if not node.say(line):
            _say(say("en", "unsaid"))

    reader = LineReader(on_line)
    with SignalWatch(lambda _: node.stop()) as watch:
        _say(f"input on {_place(args)}: each line goes to user_input")
        reader.start()
        while not (watch.is_leaving or reader.has_ended):
            reader.wait(0.1)
    node.close()
    return STOPPED if watch.is_leaving else 0


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
