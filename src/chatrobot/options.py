"""Every option that a person can choose, declared once: for the command line, the ROS parameters and the reference.

`cli.options` makes argparse's arguments of it, `nodes.ros_interfaces` ROS parameters, `scripts.make_reference` a page.
Imports nothing that costs time: `chatrobot --help` must be there at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Union

Value = Union[bool, int, float, str]
DEFAULT_ROBOT = "wheeltec_mini_mec"
"""Equals `robots.load.DEFAULT_PROFILE` (a test compares); importing that would read TOML for a help text."""
NO_ODOMETRY = "no_odometry"
"""Equals `robots.open_loop.NO_ODOMETRY`: the robot where a person asks for open loop and names none."""


@dataclass(frozen=True)
class Parameter:
    """One ROS parameter. It is read when the node starts, and read-only from then on.

    Attributes:
        nodes: the nodes that declare it.
        default: also gives the type.
        bounds: lowest and highest value of a number.
        choices: the words allowed; empty for any.
        open_loop: the default where `open_loop`, which is declared before, is true; None for the same.
    """

    name: str
    nodes: tuple[str, ...]
    default: Value
    description: str
    bounds: tuple[float, float] | None = None
    choices: tuple[str, ...] = ()
    open_loop: Value | None = None


@dataclass(frozen=True)
class Option:
    """One option of the command line; `commands` use it and list it in their help.

    Attributes:
        help: what it does; `helps` has what is said instead in the help of some commands.
        metavar: what stands for its value in the help; empty for a switch.
        kind: how its value is read: str, int, float, or "limit" for a number or `none`.
        offers: what Tab completes its value with: a key of `cli.completion.OFFERS`, `files .END`, or the values.
        parameter: the same as a ROS parameter.
    """

    flag: str
    help: str
    commands: tuple[str, ...]
    group: str
    default: Any = None
    metavar: str = ""
    kind: Any = str
    choices: tuple[str, ...] = ()
    offers: str | tuple[str, ...] = ()
    dest: str = ""
    is_repeated: bool = False
    helps: Mapping[str, str] = field(default_factory=dict)
    parameter: Parameter | None = None

    @property
    def name(self) -> str:
        """Its name in a namespace."""
        return self.dest or self.flag.lstrip("-").replace("-", "_")

    @property
    def takes_value(self) -> bool:
        """It is no switch."""
        return bool(self.metavar or self.choices)

    def to_parameter(self, value: Any) -> Value:
        """Return a value of the option as one of its parameter: ROS has neither None nor infinity."""
        assert self.parameter is not None
        if value is None or value == "":
            return self.parameter.default
        return -1.0 if self.kind == "limit" and math.isinf(value) else value

    def from_parameter(self, value: Any) -> Any:
        """Return a value of the parameter as one of the option."""
        if self.kind == "limit":
            return None if value == 0.0 else math.inf if value < 0.0 else value
        return value or self.default


COMMON, SIMULATION, MODEL, LIMITS = "options", "simulation", "language model", "limits of one text or program"
"""The groups of the help; argparse itself calls the first so."""
DRIVE = ("", "do", "program new", "program run")
"""The commands that drive a robot; "" is `chatrobot` alone."""
FACES = (*DRIVE, "mcp", "web")
"""The same and the faces on one robot that last."""
PLAN = (*FACES, "plan", "node")
"""Those that turn text into a plan."""
UNDERSTAND = (*PLAN, "eval", "lesson")
_IN_A_WORLD = tuple(command for command in UNDERSTAND if command != "lesson")
"""A lesson has its own."""
INTERPRETERS = ("auto", "offline", "model")
_KEPT = tuple(f"program {action}" for action in ("list", "show", "edit", "rename", "remove", "export"))
_JSON = (
    "plan",
    "replay",
    "eval",
    "world list",
    "world check",
    "lesson",
    "worlds",
    "doctor",
    "robots",
    "model",
    "usage",
    "fake-model",
    "program list",
    "program show",
)
_WORLD = "a world by name, a world file or a map.yaml; chatrobot world list has the names (default: {})"
_WIRES = "ros[://DOMAIN[/NAMESPACE]] or rosbridge[:ws://HOST:9090]"
_OPEN_LOOP = (
    "drive a robot without odometry: at most 0.2 m/s, 0.5 rad/s and 10 s a text, and nothing is measured"
)
_BASE, _CONTROL, _BOTH = ("base",), ("control",), ("base", "control")

# fmt: off
OPTIONS = (
    Option("--on", f"which robot: sim (the default), dds, {_WIRES}", (*PLAN, "calibrate", "sim", "record"), COMMON,
        "auto", "WHERE", offers=("sim", "dds", "ros", "rosbridge"), helps={
            "record": f"where the robot is: dds (the default), {_WIRES}",
            "node": f"where the robot is: dds (the default), {_WIRES}",
            "sim": f"where others find it: dds, {_WIRES} (default: a wire of its own, see --socket; ros2 run: ros)"}),
    Option("--robot", f"a robot profile, by name or .toml file (default: {DEFAULT_ROBOT}); chatrobot robots lists them",
        (*UNDERSTAND, "calibrate", "doctor", "sim", "record", "program show", "world draw", "world check"),
        COMMON, DEFAULT_ROBOT, "PROFILE", offers="robots",
        parameter=Parameter("robot", _BOTH, DEFAULT_ROBOT, "The robot's profile: a built-in name, or "
            "the path of a .toml file; with open_loop no_odometry is the default.", open_loop=NO_ODOMETRY)),
    Option("--world", _WORLD.format("home"), (*_IN_A_WORLD, "calibrate", "sim", "record"), COMMON, "", "WORLD",
        offers="worlds", helps=dict.fromkeys(("eval", "node", "calibrate", "record"), _WORLD.format("empty")),
        parameter=Parameter("world", _BOTH, "empty",
            "What is known of the surroundings: the name of a world, or the path of a world file or a map.yaml.")),
    Option("--yes", "do each plan without asking", (*FACES, "node"), COMMON, False),
    Option("--approve", "ask before each plan", (*FACES, "node"), COMMON, False),
    Option("--json", "one JSON object a line", (*DRIVE, *_JSON), COMMON, False,
        helps={"": "text in, events out: one JSON object a line"}),
    Option("--web", "at a terminal: show the conversation in a browser, too", ("", "replay"), COMMON, False,
        helps={"replay": "show it in a browser"}),
    Option("--record", "record what happens, by default to a new file of the recordings folder; the console and the"
        " web console do so unasked", (*FACES, "lesson"), COMMON, None, "[FILE.mcap]", offers="files .mcap"),
    Option("--no-record", "record nothing", (*DRIVE, "web", "lesson"), COMMON, False),
    Option("--config-dir", "where places, programs, recordings and robot profiles live",
        (*PLAN, "lesson", "calibrate", "sim", "doctor", "robots", "model", "usage", "record", "replay", *_KEPT),
        COMMON, None, "DIR", offers="folders", parameter=Parameter("config_dir", _BASE, "",
            "Where places and robot profiles live; empty for the user's own folder.")),
    Option("-p", "as the tutorial's node takes it: revChatGPT:=True", ("", "do", "plan", "node"), COMMON, (),
        "NAME:=VALUE", dest="parameters", is_repeated=True,
        helps={"node": "the tutorial's parameters: generate_code:=True (base), revChatGPT:=True"}),
    Option("--fast", "simulated time, as quick as it goes", (*DRIVE, "calibrate"), SIMULATION, False),
    Option("--sim", "faults injected into the simulated robot: slip=0.03,latency_s=0.05,noise=on,seed=1",
        (*FACES, "eval", "lesson", "calibrate", "sim"), SIMULATION, "", "KEY=VALUE,…"),
    Option("--trace", "with --json: the simulated robot's true pose, 50 times a second", DRIVE, SIMULATION, False),
    Option("--model", "the language model to ask what is not understood offline", (*UNDERSTAND, "doctor", "model"),
        MODEL, "", "PROVIDER:NAME", offers="models",
        parameter=Parameter("model", _BASE, "",
            "The language model, PROVIDER:NAME; empty for the one that was set up, if any.")),
    Option("--interpreter", "who understands (default: auto)", UNDERSTAND, MODEL, "auto", choices=INTERPRETERS,
        parameter=Parameter("interpreter", _BASE, "auto", "Who understands: auto, offline or model.",
            choices=INTERPRETERS)),
    Option("--rounds", "how often a model may look and go on (default: 6)", UNDERSTAND, MODEL, 6, "N", int,
        parameter=Parameter("rounds", _BASE, 6, "How often a model may look and go on in one turn.", (1, 100))),
    Option("--budget-tokens", "what a model may use for one text (default: 20000)", UNDERSTAND, MODEL, 20_000, "N", int,
        parameter=Parameter("budget_tokens", _BASE, 20_000, "How many tokens all calls of one turn may use.",
                               (100, 10_000_000))),
    Option("--budget-s", "what a model's turn may take (default: 600)", UNDERSTAND, MODEL, 600.0, "SECONDS", float,
        parameter=Parameter("budget_s", _BASE, 600.0, "How long one turn may take in all, seconds.", (1.0, 86_400.0))),
    Option("--max-distance", "metres that one text or program may drive (default: 100)", UNDERSTAND, LIMITS, None,
        "M|none", "limit", offers=("none",),
        parameter=Parameter("max_distance_m", _CONTROL, 0.0,
            "How far one text or program may drive; 0: as the profile says, -1: no limit.", (-1.0, 1e6))),
    Option("--max-time", "seconds that one text or program may drive (default: 600; a program without an end runs 60)",
        UNDERSTAND, LIMITS, None, "S|none", "limit", offers=("none",),
        parameter=Parameter("max_time_s", _CONTROL, 0.0,
            "How long one text or program may drive; 0: as the profile says, -1: no limit.", (-1.0, 1e6))),
    Option("--open-loop", f"{_OPEN_LOOP} (robot: {NO_ODOMETRY}, unless you name one)", PLAN, LIMITS, False,
        parameter=Parameter("open_loop", _BOTH, False, f"{_OPEN_LOOP[0].upper()}{_OPEN_LOOP[1:]}.")),
)
"""Every command accepts these."""
OF_NODES = (
    Option("--allow-release", "control: an emergency stop may be released over the wire", ("node",), COMMON, False,
        parameter=Parameter("allow_release", _CONTROL, False,
            "An emergency stop may be released over ROS; offers ~/release.")),
    Option("--accept-others", "control: drive though another ChatRobot is on the same robot", ("node",), COMMON,
        False, parameter=Parameter("accept_others", _CONTROL, False,
            "Drive though another ChatRobot is on the same robot.")),
    Option("--on-robot", "control: this machine is the robot, so no network can part us from its base", ("node",),
        COMMON, False, parameter=Parameter("on_robot", _CONTROL, False,
            "This machine is the robot's own: no network lies between control and base.")),
)
"""`chatrobot node` alone accepts these."""
TUTORIAL = (
    Parameter("generate_code", _BASE, False, "The tutorial's: have requests for programs answered by a program."),
    Parameter("revChatGPT", _BASE, False,
        "The tutorial's: the model's server keeps the conversation, as that service did."),
)
"""The parameters of the tutorial's base node, which the command line takes with -p, too."""
_PARAMETERS = (
    *TUTORIAL,
    *sorted((each.parameter for each in (*OPTIONS, *OF_NODES) if each.parameter),
        key=lambda parameter: parameter.name != "open_loop"),
    Parameter("diagnostics_period_s", _BOTH, 1.0, "Seconds between two messages on /diagnostics.", (0.1, 60.0)),
    Parameter("approval", _BASE, "profile",
        "What waits for a person's yes: all plans, none, or profile: a model's, where the robot's profile says so.",
        None, ("profile", "all", "none")),
)
# fmt: on
PARAMETERS = {
    node: tuple(each for each in _PARAMETERS if node in each.nodes) for node in ("input", "base", "control")
}
"""The ROS parameters of each node. `ros/chatrobot/params/params.yaml` lists the same for people; a test compares."""
