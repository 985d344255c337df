"""The options that commands share. Imports argparse alone: `chatrobot --help` must be there at once."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from typing import Any, NoReturn, TypeVar

from chatrobot.core.errors import UsageError
from chatrobot.core.motion_budget import NONE, read_limit

Number = TypeVar("Number", int, float)
DEFAULT_ROBOT = "wheeltec_mini_mec"
"""The same as `robots.load.DEFAULT_PROFILE` (a test compares); importing that would read TOML for a help text."""

NO_ODOMETRY = "no_odometry"
"""The same as `robots.open_loop.NO_ODOMETRY`: the robot of who asks for open loop and names none."""

_MODEL_OPTIONS = ("interpreter", "model", "rounds", "budget_tokens", "budget_s")
_BUDGET_OPTIONS = ("max_distance", "max_time", "open_loop")
SHOWN: dict[str, tuple[str, ...]] = {
    "plan": ("on", "robot", *_MODEL_OPTIONS, *_BUDGET_OPTIONS, "json", "world", "config_dir"),
    "stop": (),
    "schema": (),
    "calibrate": ("on", "robot", "sim", "world", "config_dir"),
    "doctor": ("on", "robot", "world", "model", "json", "config_dir"),
    "sim": ("on", "robot", "sim", "world", "config_dir"),
    "node": ("on", "robot", *_MODEL_OPTIONS, *_BUDGET_OPTIONS, "world", "config_dir", "parameters"),
    "model": ("model", "json", "config_dir"),
    "usage": ("json", "config_dir"),
    "fake-model": ("json",),
}
"""The options that `--help` of a command lists, where it does not list all; any of them may stand before it, too."""
SHOWN_OF_PROGRAMS: dict[str, tuple[str, ...]] = {
    "list": ("json", "config_dir"),
    "show": ("robot", "json", "config_dir"),
    "edit": ("config_dir",),
    "rename": ("config_dir",),
    "remove": ("config_dir",),
    "export": ("config_dir",),
}


class Parser(argparse.ArgumentParser):
    """Wrong usage leaves through `main` like every other mistake, not out of the middle of parsing."""

    def error(self, message: str) -> NoReturn:
        from chatrobot.models.secret import scrub  # a key may have been typed where none belongs

        raise UsageError(scrub(message, None), allowed=f"see {self.prog} --help")


_HELP_OF_NODES = {
    "on": "which wire: dds (the default) or ros[://DOMAIN[/NAMESPACE]], rosbridge[:ws://HOST:9090] or local:PATH",
    "world": "what is known of the surroundings: empty, home or a world file (default: empty)",
}
_HELP_OF = {
    "node": _HELP_OF_NODES,
    "sim": {
        "on": "where: on this machine alone (the default), dds or ros[://DOMAIN[/NAMESPACE]]; under ros2 run ros",
        "world": "where it is: empty, home or a world file (default: home)",
    },
}
"""What `--help` of a command says in place of the general words, where its defaults are others."""


def options_of(shown: Sequence[str] | None = None, command: str = "") -> Parser:
    """Good before and after the command: hence no defaults here, the one would undo the other.

    Args:
        shown: the options that the help lists, by their names in the namespace; None for all.
        command: whose help it is.
    """
    parser = Parser(add_help=False, argument_default=argparse.SUPPRESS, allow_abbrev=False)
    group = parser.add_argument_group("options")

    def add(*names: str, **how: Any) -> None:
        action = group.add_argument(*names, **how)
        action.help = _HELP_OF.get(command, {}).get(action.dest, action.help)
        if shown is not None and action.dest not in shown:
            action.help = argparse.SUPPRESS

    add(
        "--on",
        metavar="WHERE",
        help="which robot: sim (the default), dds or ros[://DOMAIN[/NAMESPACE]], or rosbridge[:ws://HOST:9090]",
    )
    add(
        "--robot",
        metavar="PROFILE",
        help=f"a robot profile, by name or .toml file (default: {DEFAULT_ROBOT})",
    )
    add("--interpreter", choices=("auto", "offline", "model"), help="who understands (default: auto)")
    add("--model", metavar="PROVIDER:NAME", help="the language model to ask what is not understood offline")
    add("--rounds", type=positive(int), metavar="N", help="how often a model may look and go on (default: 6)")
    add(
        "--budget-tokens",
        type=positive(int),
        metavar="N",
        help="what a model may use for one text (default: 20000)",
    )
    add(
        "--budget-s",
        type=positive(float),
        metavar="SECONDS",
        help="what a model's turn may take (default: 600)",
    )
    add("--fast", action="store_true", help="simulated time, as quick as it goes")
    add("--json", action="store_true", help="one JSON object a line; without a command: text in, events out")
    add(
        "--trace", action="store_true", help="with --json: the simulated robot's true pose, 50 times a second"
    )
    add(
        "--sim",
        metavar="KEY=VALUE,…",
        help="how the simulated robot lies: slip=0.03,latency_s=0.05,noise=on,seed=1",
    )
    add("--world", metavar="WORLD", help="empty, home or a world file (default: home; eval: empty)")
    add(
        "--max-distance",
        type=limit,
        metavar="M|none",
        help="metres that one text or program may drive (default: 100)",
    )
    add(
        "--max-time",
        type=limit,
        metavar="S|none",
        help="seconds that one text or program may drive (default: 600; a program without an end runs 60)",
    )
    add(
        "--open-loop",
        action="store_true",
        help="drive a robot without odometry: nothing is measured; 0.2 m/s, 0.5 rad/s and 10 s a text at most"
        f" (robot: {NO_ODOMETRY}, unless you name one)",
    )
    add("--approve", action="store_true", help="ask before each plan")
    add("--yes", action="store_true", help="do each plan without asking")
    add("--config-dir", metavar="DIR", help="where places, programs and robot profiles live")
    add(
        "-p",
        dest="parameters",
        action="append",
        metavar="NAME:=VALUE",
        help="the tutorial's parameters: generate_code:=True (base), revChatGPT:=True",
    )
    return parser


_KINDS: dict[Any, str] = {int: "whole number", float: "number"}


def port(text: str) -> int:
    if not text.isdecimal() or int(text) > 65_535:
        raise argparse.ArgumentTypeError(f"{text!r} is no port (0 to 65535)")
    return int(text)


def limit(text: str) -> float:
    """A limit of the motion budget: a number above zero, or `none`."""
    try:
        return read_limit(text if text == NONE else float(text))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a number above zero nor {NONE}") from None


def positive(kind: Callable[[str], Number]) -> Callable[[str], Number]:
    """A reader of numbers above zero."""

    def read(text: str) -> Number:
        try:
            value = kind(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is no {_KINDS[kind]}") from None
        if not 0 < value < float("inf"):
            raise argparse.ArgumentTypeError(f"{text!r} is not above zero")
        return value

    return read
