"""`chatrobot node input|base|control`: one of the tutorial's three nodes, until Ctrl-C. A stop goes out first."""

from __future__ import annotations

import argparse
import contextlib
import sys

from chatrobot.cli.entry import STOPPED
from chatrobot.cli.signals import SignalWatch
from chatrobot.core.errors import UsageError, WireError

_PARAMETERS = ("generate_code", "revChatGPT")
_VALUES = {"true": True, "false": False}


def run(args: argparse.Namespace) -> int:
    """0 where its input has ended, 5 where it was asked to end."""
    if args.fast or args.trace or args.sim:
        raise UsageError("a node drives a robot on a wire", allowed="leave out --fast, --trace and --sim")
    return {"input": _run_input, "base": _run_base, "control": _run_control}[args.which](args)


def _run_control(args: argparse.Namespace) -> int:
    from chatrobot.nodes.control import ControlNode, ControlOptions

    node = ControlNode(
        ControlOptions(
            _address(args),
            _profile(args),
            _world(args),
            args.allow_release,
            args.accept_others,
            args.on_robot,
        )
    )

    def stop(why: str) -> None:
        with contextlib.suppress(WireError):
            node.stop(why)

    def is_leaving() -> bool:
        if watch.is_leaving:
            node.leave()
        return watch.is_leaving

    with SignalWatch(stop) as watch:
        _say(
            f"control drives {args.robot} on {_address(args)}: chatgpt_node → cmd_vel; Ctrl-C stops and ends"
        )
        node.run(is_leaving)
    return STOPPED


def _run_base(args: argparse.Namespace) -> int:
    from chatrobot.cli.folders import config_folder
    from chatrobot.nodes.base import BaseNode, BaseOptions

    parameters = _parameters(args.parameters)
    node = BaseNode(
        BaseOptions(
            _address(args),
            _profile(args),
            _world(args),
            config_folder(args),
            parameters["generate_code"],
            parameters["revChatGPT"],
        ),
        _say,
    )
    with SignalWatch(node.stop) as watch:
        _say(f"base understands for {args.robot} on {_address(args)}: user_input → chatgpt_node")
        node.run(lambda: watch.is_leaving)
    return STOPPED


def _run_input(args: argparse.Namespace) -> int:
    from chatrobot.cli.lines import LineReader
    from chatrobot.language.phrases import say
    from chatrobot.nodes.input import InputNode
    from chatrobot.robots.load import load_profile

    node = InputNode(_address(args), load_profile(_profile(args)).wiring, _say)

    def on_line(line: str) -> None:
        if not node.say(line):
            _say(say("en", "unsaid"))

    reader = LineReader(on_line)
    with SignalWatch(lambda _: node.stop()) as watch:
        _say(f"input on {_address(args)}: each line goes to user_input")
        reader.start()
        while not (watch.is_leaving or reader.has_ended):
            reader.wait(0.1)
    node.close()
    return STOPPED if watch.is_leaving else 0


def _address(args: argparse.Namespace) -> str:
    from chatrobot.wire.connect import wire_address

    return wire_address("dds" if args.on == "auto" else args.on)


def _profile(args: argparse.Namespace) -> str:
    from chatrobot.cli.folders import profile_folders
    from chatrobot.robots.load import profile_argument

    return profile_argument(args.robot, profile_folders(args))


def _world(args: argparse.Namespace) -> str:
    return args.world or "empty"


def _parameters(given: list[str]) -> dict[str, bool]:
    """The values of `-p NAME:=VALUE`, by name."""
    values = dict.fromkeys(_PARAMETERS, False)
    for parameter in given:
        name, _, value = parameter.partition(":=")
        if name not in values or value.lower() not in _VALUES:
            raise UsageError(
                f"{parameter!r} is no parameter of this node",
                where="-p",
                allowed="generate_code:=True, revChatGPT:=True",
            )
        values[name] = _VALUES[value.lower()]
    return values


def _say(text: str) -> None:
    with contextlib.suppress(OSError):
        print(text, file=sys.stdout, flush=True)
