"""The events of a sandboxed program, as its host hears them. Read strictly: the program may say anything.

Times are seconds since the program's start, by the program's own clock; a live program may lie about them, so the
host goes by its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple, Union

from chatrobot.core.geometry import Twist
from chatrobot.core.reason import Reason
from chatrobot.programs.pipe import LATEST_S, PipeError
from chatrobot.programs.ros_args import LEVELS

SENSORS = ("odom", "scan", "imu", "battery", "bumper")
LONGEST_TEXT = 16 * 1024
LONGEST_NAME = 512
LONGEST_ERROR = 300


class TwistAsked(NamedTuple):
    """It published a velocity for the robot; `planar` is false where it had parts that no ground robot has."""

    t_s: float
    twist: Twist
    planar: bool


class TopicNoticed(NamedTuple):
    """It publishes on or listens to a topic (resolved, after remaps) of a type like `geometry_msgs/msg/Twist`."""

    t_s: float
    direction: Literal["publishes", "listens"]
    topic: str
    type_name: str


class Listens(NamedTuple):
    """It wants what a sensor of the robot says, and keeps the last `depth`."""

    t_s: float
    sensor: str
    depth: int


class Log(NamedTuple):
    """A line of a ROS logger."""

    t_s: float
    level: str
    name: str
    text: str


class Output(NamedTuple):
    """It printed a line."""

    t_s: float
    stream: Literal["stdout", "stderr"]
    text: str


class AsksTime(NamedTuple):
    """On virtual time: it waits until `until_s`, or, with `wakes`, until its robot says something before."""

    t_s: float
    until_s: float
    wakes: bool


class Beat(NamedTuple):
    """A live program is not frozen."""

    t_s: float


class Ended(NamedTuple):
    """It is over: it `returned`, called `exit`, or came to the `horizon` (`stuck`: waiting for ever for nothing)."""

    t_s: float
    how: Literal["returned", "exit", "horizon", "stuck"]
    exit_code: int


class Raised(NamedTuple):
    """It is over by an exception. `line` is the program's own line, 0 where there is none."""

    t_s: float
    type_name: str
    message: str
    traceback: str
    line: int

    @property
    def as_reason(self) -> Reason:
        """Return why it is over: `error` is the exception and what it says, `line` the program's own."""
        error = f"{self.type_name}: {self.message}" if self.message else self.type_name
        values: Mapping[str, str | int] = {"error": error[:LONGEST_ERROR], "line": self.line}
        if self.type_name in ("SyntaxError", "IndentationError", "TabError"):
            return Reason("program_syntax", {"problem": self.message[:LONGEST_ERROR], "line": self.line})
        if self.type_name in ("ModuleNotFoundError", "ImportError"):
            return Reason("program_import", values)
        if self.type_name == "PermissionError":
            return Reason("program_forbidden", values)
        return Reason("program_raised", values)


class Died(NamedTuple):
    """It is gone without a word, or it broke the protocol; `log` is the last that its process wrote."""

    reason: Reason
    log: str


ProgramEvent = Union[TwistAsked, TopicNoticed, Listens, Log, Output, AsksTime, Beat, Ended, Raised, Died]
ENDS = (Ended, Raised, Died)


def read_event(frame: list[Any]) -> ProgramEvent:
    """Read one frame. Raises PipeError for whatever is not exactly one of the words."""
    reader = _READERS.get(frame[0])
    if reader is None:
        raise PipeError(f"an unknown word: {frame[0][:40]!r}")
    kind, fields = reader
    if len(frame) - 1 != len(fields):
        raise PipeError(f"{frame[0]}: {len(frame) - 1} values")
    return kind(*[read(value) for read, value in zip(fields, frame[1:])])


def _seconds(value: Any) -> float:
    if type(value) is not int or not 0 <= value <= LATEST_S * 1e9:
        raise PipeError("not a time")
    return value * 1e-9


def _number(value: Any) -> float:
    """Infinity and NaN are numbers here: the governor refuses them."""
    if type(value) is int and abs(value) > 2**53:
        return math.inf
    if type(value) not in (int, float):
        raise PipeError("not a number")
    return float(value)


def _code(value: Any) -> int:
    if type(value) is not int:
        raise PipeError("not an exit code")
    return value & 0xFF


def _text(value: Any) -> str:
    if type(value) is not str:
        raise PipeError("not a text")
    return value[:LONGEST_TEXT]


def _typed(kind: type, what: str, is_one: Callable[[Any], bool] = lambda _: True) -> Callable[[Any], Any]:
    def read(value: Any) -> Any:
        if type(value) is not kind or not is_one(value):
            raise PipeError(f"not {what}")
        return value

    return read


def _one_of(*allowed: str) -> Callable[[Any], str]:
    return _typed(str, f"one of {allowed}", allowed.__contains__)


_flag = _typed(bool, "a flag")
_count = _typed(int, "a count", lambda value: 0 <= value <= 1_000_000)
_name = _typed(str, "a name", lambda value: len(value) <= LONGEST_NAME)


def _twist_asked(t_s: float, vx_mps: float, vy_mps: float, wz_radps: float, planar: bool) -> TwistAsked:
    return TwistAsked(t_s, Twist(vx_mps, vy_mps, wz_radps), planar)


_READERS: Mapping[str, tuple[Callable[..., ProgramEvent], tuple[Callable[[Any], Any], ...]]] = {
    "twist": (_twist_asked, (_seconds, _number, _number, _number, _flag)),
    "topic": (TopicNoticed, (_seconds, _one_of("publishes", "listens"), _name, _name)),
    "listens": (Listens, (_seconds, _one_of(*SENSORS), _count)),
    "log": (Log, (_seconds, _one_of(*LEVELS), _name, _text)),
    "out": (Output, (_seconds, _one_of("stdout", "stderr"), _text)),
    "until": (AsksTime, (_seconds, _seconds, _flag)),
    "beat": (Beat, (_seconds,)),
    "ended": (Ended, (_seconds, _one_of("returned", "exit", "horizon", "stuck"), _code)),
    "raised": (Raised, (_seconds, _name, _text, _text, _count)),
}
