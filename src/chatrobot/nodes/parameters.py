"""What the nodes can be told as ROS parameters: declared, described and bounded in one place.

`ros/chatrobot/params/params.yaml` lists the same for people; a test compares.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

Value = Union[bool, int, float, str]


@dataclass(frozen=True)
class Parameter:
    """One parameter. Read when the node starts, and read-only from then on: a robot is not changed under way.

    Attributes:
        default: also says the type.
        bounds: lowest and highest value of a number.
        choices: the words allowed; empty for any.
        open_loop: the default where `open_loop`, which is declared before, is true; None for the same.
    """

    name: str
    default: Value
    description: str
    bounds: tuple[float, float] | None = None
    choices: tuple[str, ...] = ()
    open_loop: Value | None = None


_ROBOT = (
    Parameter(
        "open_loop",
        False,
        "Drive a robot that has no odometry: at most 0.2 m/s, 0.5 rad/s and 10 s a text, and nothing is measured.",
    ),
    Parameter(
        "robot",
        "wheeltec_mini_mec",
        "The robot's profile: a built-in name, or the path of a .toml file; with open_loop no_odometry is the default.",
        open_loop="no_odometry",
    ),
    Parameter(
        "world", "empty", "What is known of the surroundings: empty, home, or the path of a world file."
    ),
    Parameter("diagnostics_period_s", 1.0, "Seconds between two messages on /diagnostics.", (0.1, 60.0)),
)
BASE = (
    Parameter("generate_code", False, "The tutorial's: have requests for programs answered by a program."),
    Parameter(
        "revChatGPT", False, "The tutorial's: the model's server keeps the conversation, as that service did."
    ),
    *_ROBOT,
    Parameter(
        "interpreter", "auto", "Who understands: auto, offline or model.", None, ("auto", "offline", "model")
    ),
    Parameter("model", "", "The language model, PROVIDER:NAME; empty for the one that was set up, if any."),
    Parameter(
        "approval",
        "profile",
        "What waits for a person's yes: all plans, none, or profile: a model's, where the robot's profile says so.",
        None,
        ("profile", "all", "none"),
    ),
    Parameter("rounds", 6, "How often a model may look and go on in one turn.", (1, 100)),
    Parameter("budget_tokens", 20_000, "How many tokens all calls of one turn may use.", (100, 10_000_000)),
    Parameter("budget_s", 600.0, "How long one turn may take in all, seconds.", (1.0, 86_400.0)),
    Parameter("config_dir", "", "Where places and robot profiles live; empty for the user's own folder."),
)
CONTROL = (
    *_ROBOT,
    Parameter("allow_release", False, "An emergency stop may be released over ROS; offers ~/release."),
    Parameter("accept_others", False, "Drive though another ChatRobot is on the same robot."),
    Parameter(
        "on_robot", False, "This machine is the robot's own: no network lies between control and base."
    ),
    Parameter(
        "max_distance_m",
        0.0,
        "How far one text or program may drive; 0: as the profile says, -1: no limit.",
        (-1.0, 1e6),
    ),
    Parameter(
        "max_time_s",
        0.0,
        "How long one text or program may drive; 0: as the profile says, -1: no limit.",
        (-1.0, 1e6),
    ),
)
INPUT: tuple[Parameter, ...] = ()
PARAMETERS = {"input": INPUT, "base": BASE, "control": CONTROL}
