"""`chatrobot node input|base|control`: one of the tutorial's three nodes, until Ctrl-C. A stop goes out first."""

from __future__ import annotations

import argparse
import contextlib
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from chatrobot.cli.entry import STOPPED
from chatrobot.cli.folders import profile_folders
from chatrobot.cli.parameters import parameters_in, read_parameters
from chatrobot.cli.signals import SignalWatch
from chatrobot.core.errors import UsageError
from chatrobot.core.process import wake_promptly
from chatrobot.options import OF_NODES, OPTIONS, PARAMETERS
from chatrobot.robots.load import profile_argument
from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget
from chatrobot.wire.connect import Connect, connect_wire, wire_address
from chatrobot.wire.discovery import domain_and_namespace
from chatrobot.wire.ros import require_ros

if TYPE_CHECKING:
    from chatrobot.nodes.ros_interfaces import RosInterfaces

REPEATS_S = 2.0
"""`ros2 launch` sends each node the Ctrl-C that the terminal has sent it already: so soon it is the same one."""


def run(args: argparse.Namespace) -> int:
    """Return 0 where its input has ended; where it was asked to end 5, or 0 as a node of ROS, as those do.

    Raises:
        InputError: an option, a parameter, the profile or the world cannot be used.
        WireError: nobody answers on that wire.
    """
    if args.fast or args.trace or args.sim:
        raise UsageError(
            "--fast, --trace and --sim are for the simulated robot, not for nodes", allowed="leave them out"
        )
    wake_promptly()  # before there are threads, which take after this one
    args.on = wire_address("dds" if args.on == "auto" else args.on)
    args.approval = "all" if args.approve else "none" if args.yes else "profile"
    ros_args = [*args.ros_args, *(word for given in args.parameters for word in ("-p", given))]
    ros_interfaces: RosInterfaces | None = None
    connect: Connect = connect_wire
    if args.on.startswith("ros:"):
        ros_interfaces = open_ros_interfaces(args, ros_args)
        connect = ros_interfaces.connect
    else:
        vars(args).update(read_parameters(parameters_in(ros_args)))
    args.robot_file = profile_argument(args.robot, profile_folders(args))
    has_left = _RUNS[args.which](args, ros_interfaces, connect)
    return STOPPED if has_left and ros_interfaces is None else 0


def open_ros_interfaces(args: argparse.Namespace, ros_args: list[str]) -> RosInterfaces:
    """Open the node under `--on ros`, its parameters written into `args`; options are their defaults.

    Raises:
        UsageError: ROS is not here, or what it was given cannot be used.
    """
    require_ros()
    from chatrobot.language.typed import speak_for
    from chatrobot.nodes.ros_interfaces import RosInterfaces

    speak_for("ros")
    known = [(each, each.parameter) for each in (*OPTIONS, *OF_NODES) if each.parameter is not None]
    given = {named.name: option.to_parameter(getattr(args, option.name)) for option, named in known}
    if not args.names_robot:
        del given["robot"]
    domain_id, namespace = domain_and_namespace(args.on)
    ros_interfaces = RosInterfaces(
        f"chatrobot_{args.which}",
        PARAMETERS[args.which],
        {**given, "approval": args.approval},
        ros_args,
        namespace=namespace,
        domain_id=domain_id,
    )
    vars(args).update(ros_interfaces.values)
    for option, named in known:
        if named.name in ros_interfaces.values:
            setattr(args, option.name, option.from_parameter(ros_interfaces.values[named.name]))
    return ros_interfaces


def _run_control(args: argparse.Namespace, ros_interfaces: RosInterfaces | None, connect: Connect) -> bool:
    from chatrobot.core.events import Event, Started
    from chatrobot.link.topic_link import CHATGPT_NODE
    from chatrobot.nodes.control import ControlNode
    from chatrobot.nodes.log import Log, on_stderr
    from chatrobot.nodes.told import told

    log = Log(on_stderr if ros_interfaces is None else ros_interfaces.log)

    def note(event: Event) -> None:
        if (line := told(event)) is not None:
            log(*line)

    told(Started(1))  # reads the tables of words now, not in the middle of a motion
    node = ControlNode(
        args.on,
        args.robot_file,
        args.world or "empty",
        note=note,
        release=args.allow_release,
        accept_others=args.accept_others,
        on_robot=args.on_robot,
        budget=MotionBudget(args.max_distance, args.max_time),
        open_loop=args.open_loop,
        connect=connect,
    )

    with contextlib.closing(log), SignalWatch(node.stop, repeats_s=REPEATS_S) as watch:
        if ros_interfaces is not None:
            node.introduce(ros_interfaces)
        way = f"{node.resolved(CHATGPT_NODE)} → {node.cmd_vel_topic}"
        log("info", f"control drives {args.robot} on {_place(args)}: {way}; Ctrl-C stops and ends")
        node.run(lambda: watch.is_leaving)
    return True


def _run_base(args: argparse.Namespace, ros_interfaces: RosInterfaces | None, connect: Connect) -> bool:
    from chatrobot.cli.choices import setup_from
    from chatrobot.dialogue.options import Options
    from chatrobot.link.topic_link import CHATGPT_NODE, USER_INPUT
    from chatrobot.nodes.base import BaseNode
    from chatrobot.nodes.log import Log

    log = Log((lambda _, text: _say(text)) if ros_interfaces is None else ros_interfaces.log)
    setup = setup_from(args, options=Options(), world="empty", programs=args.generate_code)
    setup = replace(setup, robot=args.robot_file, budget=NOT_CHOSEN)  # control keeps the budget
    node = BaseNode(setup, log, connect, approval=args.approval, rev_chatgpt=args.revChatGPT)
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

    node = InputNode(args.on, load_profile(args.robot_file).wiring, _say, connect)

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


def _place(args: argparse.Namespace) -> str:
    """Return the address as a person would say it."""
    return str(args.on).rstrip(":")


def _say(text: str) -> None:
    with contextlib.suppress(OSError):
        print(text, file=sys.stdout, flush=True)


_RUNS = {"input": _run_input, "base": _run_base, "control": _run_control}
