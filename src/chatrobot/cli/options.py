"""The options that commands share: each declared once, with its default, the commands that take it and what Tab offers.

Imports argparse alone: `chatrobot --help` must be there at once.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NoReturn, TypeVar

from chatrobot.core.errors import UsageError
from chatrobot.robots.profile import NONE, read_limit

Number = TypeVar("Number", int, float)
DEFAULT_ROBOT = "wheeltec_mini_mec"
"""The same as `robots.load.DEFAULT_PROFILE` (a test compares); importing that would read TOML for a help text."""

NO_ODOMETRY = "no_odometry"
"""The same as `robots.open_loop.NO_ODOMETRY`: the robot of who asks for open loop and names none."""

COMMON = "options"
"""argparse's own name for the group that stands first."""
_SIMULATION, _MODEL, _LIMITS = "simulation", "language model", "limits of one text or program"
_WORLD = "empty, home or a world file (default: {})"
_WIRES = "ros[://DOMAIN[/NAMESPACE]] or rosbridge[:ws://HOST:9090]"
_DRIVE = ("", "do", "program new", "program run")
"""The commands that drive a robot; "" is `chatrobot` alone."""
_PLAN = (*_DRIVE, "plan", "node")
"""Those that turn text into a plan."""
_UNDERSTAND = (*_PLAN, "eval")
_KEPT = ("list", "show", "edit", "rename", "remove", "export")
_SETTINGS = ("doctor", "robots", "model", "usage", *(f"program {action}" for action in _KEPT))


@dataclass(frozen=True)
class Option:
    """One shared option. Every command accepts it; `commands` are those that use it, and list it in their help.

    Args:
        help: what it does; `helps` has what else is said of it in the help of some commands.
        metavar: what stands for its value in the help; empty for a switch.
        offers: what Tab completes its value with: a key of `completion.OFFERS`, or the values themselves.
    """

    flag: str
    help: str
    commands: tuple[str, ...]
    group: str = COMMON
    default: Any = None
    metavar: str = ""
    read: Callable[[str], Any] = str
    choices: tuple[str, ...] | None = None
    offers: str | tuple[str, ...] = ()
    dest: str = ""
    is_repeated: bool = False
    helps: Mapping[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Its name in the namespace."""
        return self.dest or self.flag.lstrip("-").replace("-", "_")

    @property
    def takes_value(self) -> bool:
        """It is no switch."""
        return bool(self.metavar or self.choices)

    def add_to(self, group: argparse._ActionsContainer, command: str) -> None:
        """Good before and after the command: hence no default here, the one would undo the other."""
        how: dict[str, Any] = {"dest": self.name, "default": argparse.SUPPRESS, "help": argparse.SUPPRESS}
        if command in self.commands:
            how["help"] = self.helps.get(command, self.help)
        if self.choices:
            how["choices"] = self.choices
        elif self.metavar:
            how |= {"metavar": self.metavar, "type": self.read}
        if self.is_repeated:
            how["action"] = "append"
        elif not self.takes_value:
            how["action"] = "store_true"
        offer(group.add_argument(self.flag, **how), self.offers)


class Parser(argparse.ArgumentParser):
    """Wrong usage leaves through `main` like every other mistake, not out of the middle of parsing."""

    def __init__(self, **how: Any) -> None:
        how.setdefault("formatter_class", HelpText)
        super().__init__(**how, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        from chatrobot.models.secret import scrub  # a key may have been typed where none belongs

        raise UsageError(scrub(message, None), allowed=f"see {self.prog} --help")


class HelpText(argparse.RawDescriptionHelpFormatter):
    """Options are listed once, below: the line of usage has no room for them."""

    def add_usage(self, usage: str | None, actions: Any, groups: Any, prefix: str | None = None) -> None:
        if usage is None:
            self._prog += " [options]"
            actions, groups = [action for action in actions if not action.option_strings], []
        super().add_usage(usage, actions, groups, prefix)


def add_options(parser: argparse.ArgumentParser, command: str) -> None:
    """Have `parser` accept every shared option, and list those that `command` uses, group by group."""
    for title in (COMMON, _SIMULATION, _MODEL, _LIMITS):
        group = parser if title == COMMON else parser.add_argument_group(title)
        for option in OPTIONS:
            if option.group == title:
                option.add_to(group, command)


def offer(action: argparse.Action, offers: str | tuple[str, ...]) -> None:
    """Say what Tab completes the value of `action` with: see `Option`."""
    vars(action)["offers"] = offers


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


OPTIONS = (
    Option(
        "--on",
        f"which robot: sim (the default), dds, {_WIRES}",
        (*_PLAN, "calibrate", "sim"),
        default="auto",
        metavar="WHERE",
        offers=("sim", "dds", "ros", "rosbridge"),
        helps={
            "node": f"where the robot is: dds (the default), {_WIRES}",
            "sim": f"where others find it: dds, {_WIRES} (default: a wire of its own, see --socket; ros2 run: ros)",
        },
    ),
    Option(
        "--robot",
        f"a robot profile, by name or .toml file (default: {DEFAULT_ROBOT}); chatrobot robots lists them",
        (*_UNDERSTAND, "calibrate", "doctor", "sim", "program show"),
        default=DEFAULT_ROBOT,
        metavar="PROFILE",
        offers="robots",
    ),
    Option(
        "--world",
        _WORLD.format("home"),
        (*_UNDERSTAND, "calibrate", "sim"),
        default="",
        metavar="WORLD",
        offers="worlds",
        helps=dict.fromkeys(("eval", "node", "calibrate"), _WORLD.format("empty")),
    ),
    Option("--yes", "do each plan without asking", (*_DRIVE, "node"), default=False),
    Option("--approve", "ask before each plan", (*_DRIVE, "node"), default=False),
    Option(
        "--json",
        "one JSON object a line",
        (
            *_DRIVE,
            "plan",
            "eval",
            "worlds",
            "doctor",
            "robots",
            "model",
            "usage",
            "fake-model",
            "program list",
            "program show",
        ),
        default=False,
        helps={"": "text in, events out: one JSON object a line"},
    ),
    Option(
        "--config-dir",
        "where places, programs and robot profiles live",
        (*_PLAN, "calibrate", "sim", *_SETTINGS),
        metavar="DIR",
        offers="folders",
    ),
    Option(
        "-p",
        "as the tutorial's node takes it: revChatGPT:=True",
        ("", "do", "plan", "node"),
        default=(),
        metavar="NAME:=VALUE",
        dest="parameters",
        is_repeated=True,
        helps={"node": "the tutorial's parameters: generate_code:=True (base), revChatGPT:=True"},
    ),
    Option("--fast", "simulated time, as quick as it goes", (*_DRIVE, "calibrate"), _SIMULATION, False),
    Option(
        "--sim",
        "how the simulated robot lies: slip=0.03,latency_s=0.05,noise=on,seed=1",
        (*_DRIVE, "eval", "calibrate", "sim"),
        _SIMULATION,
        "",
        "KEY=VALUE,…",
    ),
    Option(
        "--trace",
        "with --json: the simulated robot's true pose, 50 times a second",
        _DRIVE,
        _SIMULATION,
        False,
    ),
    Option(
        "--model",
        "the language model to ask what is not understood offline",
        (*_UNDERSTAND, "doctor", "model"),
        _MODEL,
        "",
        "PROVIDER:NAME",
        offers="models",
    ),
    Option(
        "--interpreter",
        "who understands (default: auto)",
        _UNDERSTAND,
        _MODEL,
        "auto",
        choices=("auto", "offline", "model"),
    ),
    Option(
        "--rounds",
        "how often a model may look and go on (default: 6)",
        _UNDERSTAND,
        _MODEL,
        6,
        "N",
        positive(int),
    ),
    Option(
        "--budget-tokens",
        "what a model may use for one text (default: 20000)",
        _UNDERSTAND,
        _MODEL,
        20_000,
        "N",
        positive(int),
    ),
    Option(
        "--budget-s",
        "what a model's turn may take (default: 600)",
        _UNDERSTAND,
        _MODEL,
        600.0,
        "SECONDS",
        positive(float),
    ),
    Option(
        "--max-distance",
        "metres that one text or program may drive (default: 100)",
        _UNDERSTAND,
        _LIMITS,
        metavar="M|none",
        read=limit,
        offers=(NONE,),
    ),
    Option(
        "--max-time",
        "seconds that one text or program may drive (default: 600; a program without an end runs 60)",
        _UNDERSTAND,
        _LIMITS,
        metavar="S|none",
        read=limit,
        offers=(NONE,),
    ),
    Option(
        "--open-loop",
        "drive a robot without odometry: at most 0.2 m/s, 0.5 rad/s and 10 s a text, and nothing is measured"
        f" (robot: {NO_ODOMETRY}, unless you name one)",
        _PLAN,
        _LIMITS,
        False,
    ),
)
