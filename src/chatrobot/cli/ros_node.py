"""A node of ours under `--on ros`: ROS's parameters take the place of what stood on the command line."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from chatrobot.language.typed import type_as_ros_args
from chatrobot.nodes.parameters import PARAMETERS, Value
from chatrobot.wire.discovery import domain_and_namespace
from chatrobot.wire.ros import require_ros

if TYPE_CHECKING:
    from chatrobot.nodes.ros_interfaces import RosInterfaces


def open_ros_interfaces(args: argparse.Namespace, address: str, ros_args: list[str]) -> RosInterfaces:
    """The node, with its parameters written into `args`. Command-line options are their defaults.

    Raises:
        UsageError: ROS is not here, or what it was given cannot be used.
    """
    require_ros()
    from chatrobot.nodes.ros_interfaces import RosInterfaces

    type_as_ros_args()
    given: dict[str, Value] = {
        **({"robot": args.robot} if args.names_robot else {}),
        "open_loop": args.open_loop,
        "world": args.world or "empty",
        "config_dir": args.config_dir or "",
        "interpreter": args.interpreter,
        "model": args.model,
        "approval": args.approval,
        "rounds": args.rounds,
        "budget_tokens": args.budget_tokens,
        "budget_s": float(args.budget_s),
        "allow_release": args.allow_release,
        "accept_others": args.accept_others,
        "on_robot": args.on_robot,
        "max_distance_m": _parameter_of(args.max_distance),
        "max_time_s": _parameter_of(args.max_time),
    }
    domain_id, namespace = domain_and_namespace(address)
    ros_interfaces = RosInterfaces(
        f"chatrobot_{args.which}",
        PARAMETERS[args.which],
        given,
        ros_args,
        namespace=namespace,
        domain_id=domain_id,
    )
    vars(args).update(ros_interfaces.values)
    args.config_dir = args.config_dir or None
    if args.which == "control":
        args.max_distance = _limit_of(args.max_distance_m)
        args.max_time = _limit_of(args.max_time_s)
    return ros_interfaces


def _parameter_of(limit: float | None) -> float:
    """A limit of the motion budget as a ROS parameter: 0 for not chosen, -1 for none."""
    return 0.0 if limit is None else -1.0 if math.isinf(limit) else limit


def _limit_of(value: float) -> float | None:
    return None if value == 0.0 else math.inf if value < 0.0 else value
