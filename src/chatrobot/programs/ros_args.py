"""Command-line arguments as ROS 2 reads them: what stands between `--ros-args` and `--`, or the end.

`-p [NODE:]NAME:=VALUE`, `-r [NODE:]FROM:=TO` (`__node`, `__ns`, `rostopic://…` and `rosservice://…` among them), and
`--log-level [LOGGER:=]LEVEL`. Used by the host, which refuses what cannot be read, and by `rclpy` in the sandbox.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

MOST_ARGS = 64
MOST_CHARS = 4000
"""Of all arguments of a program together."""

_PARAM, _REMAP, _LEVEL = ("-p", "--param"), ("-r", "--remap"), ("--log-level",)
_FILES = ("--params-file", "--log-config-file")
_WITH_VALUE = (*_PARAM, *_REMAP, *_LEVEL, *_FILES, "-e", "--enclave", "--log-file-name")
_SWITCH = re.compile(r"--(?:en|dis)able-(?:rosout|stdout|external-lib)-logs")
_RULE = re.compile(
    r"(?:(?P<node>[^:/~{}]+):(?!//))?(?P<what>(?:ros(?:topic|service)://)?[^:]+):=(?P<to>.*)", re.DOTALL
)
LEVELS = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")


class RosArgumentsError(ValueError):
    """An argument that ROS would not take, and why."""


@dataclass(frozen=True)
class Rule:
    """`what` becomes `to`, for nodes of that name; for all where it is ""."""

    node: str
    what: str
    to: Any

    def is_for(self, node_name: str) -> bool:
        """Tell whether it counts for that node."""
        return self.node in ("", node_name)


@dataclass(frozen=True)
class RosArguments:
    """`unknown` are those that ROS does not know; `levels` those of loggers, "" for all."""

    parameters: tuple[Rule, ...] = ()
    remaps: tuple[Rule, ...] = ()
    levels: tuple[tuple[str, str], ...] = ()
    unknown: tuple[str, ...] = ()

    def overridden_by(self, own: RosArguments) -> RosArguments:
        """Return these of a process, with those of one of its nodes put first."""
        return RosArguments((*self.parameters, *own.parameters), (*own.remaps, *self.remaps))

    def node_name(self, written: str) -> str:
        """Return the name of a node that its program calls `written`."""
        return self._first(written, "__node", "__name") or written

    def namespace(self, written: str) -> str | None:
        """Return the namespace given to a node of that written name; None where none is."""
        return self._first(written, "__ns")

    def _first(self, node_name: str, *whats: str) -> str | None:
        return next((rule.to for rule in self.remaps if rule.what in whats and rule.is_for(node_name)), None)

    def names(self, node_name: str, kind: str) -> dict[str, str]:
        """Return what names are led to for a node; `kind` is `topic` or `service`. The first rule for a name holds."""
        found: dict[str, str] = {}
        for rule in self.remaps:
            scheme, _, name = rule.what.rpartition("://")
            if rule.is_for(node_name) and not name.startswith("__") and scheme in ("", f"ros{kind}"):
                found.setdefault(name, rule.to)
        return found

    def values(self, node_name: str) -> dict[str, Any]:
        """Return the values of parameters for a node. The last one of a name holds."""
        return {rule.what: rule.to for rule in self.parameters if rule.is_for(node_name)}


def split_ros_args(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Part what stands between each `--ros-args` and `--` or the end, as ROS has it, from the rest, which is first."""
    ours: list[str] = []
    theirs: list[str] = []
    taking = ours
    for argument in arguments:
        if argument == "--ros-args":
            taking = theirs
        elif argument == "--" and taking is theirs:
            taking = ours
        else:
            taking.append(argument)
    return ours, theirs


def read_ros_args(args: Sequence[str]) -> RosArguments:
    """Read the ROS arguments among `args`.

    Raises:
        RosArgumentsError: one of them cannot be read, or names a file: no file can be opened in the sandbox.
    """
    parameters: list[Rule] = []
    remaps: list[Rule] = []
    levels: list[tuple[str, str]] = []
    unknown: list[str] = []
    for name, value in _options(args):
        if name in _PARAM:
            rule = _rule(name, value)
            parameters.append(Rule(rule.node, rule.what, parameter_value(rule.to)))
        elif name in _REMAP:
            remaps.append(_rule(name, value))
        elif name in _LEVEL:
            levels.append(_level(value))
        elif name in _FILES:
            raise RosArgumentsError(
                f"{name} {value}: a program cannot read files; give -p NAME:=VALUE instead"
            )
        elif name not in _WITH_VALUE and not _SWITCH.fullmatch(name):
            unknown.append(name)
    return RosArguments(tuple(parameters), tuple(remaps), tuple(levels), tuple(unknown))


def check_args(args: Sequence[str]) -> None:
    """Check that a program can be given these. Raises RosArgumentsError."""
    if len(args) > MOST_ARGS or sum(map(len, args)) > MOST_CHARS:
        raise RosArgumentsError(
            f"a program takes at most {MOST_ARGS} arguments of {MOST_CHARS} characters in all"
        )
    unknown = read_ros_args(args).unknown
    if unknown:
        raise RosArgumentsError(f"ROS knows no argument {unknown[0]!r}")


def _options(args: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each ROS argument with its value, "" for one that has none."""
    is_ours = False
    rest = iter(args)
    for argument in rest:
        if argument == "--ros-args":
            is_ours = True
        elif argument == "--":
            is_ours = False
        elif is_ours and argument in _WITH_VALUE:
            value = next(rest, None)
            if value is None:
                raise RosArgumentsError(f"{argument} is followed by nothing")
            yield argument, value
        elif is_ours:
            yield argument, ""


def _rule(option: str, text: str) -> Rule:
    found = _RULE.fullmatch(text)
    if found is None or not (found["to"] or option in _PARAM):
        form = "[NODE:]NAME:=VALUE" if option in _PARAM else "[NODE:]FROM:=TO"
        raise RosArgumentsError(f"{option} {text}: it has the form {form}")
    return Rule(found["node"] or "", found["what"], found["to"])


def _level(text: str) -> tuple[str, str]:
    logger, _, level = text.rpartition(":=")
    if level.upper() not in LEVELS:
        raise RosArgumentsError(f"--log-level {text}: the levels are {', '.join(LEVELS).lower()}")
    return logger, level.upper()


# --- values: the part of YAML that a parameter can have ---

_TRUE = frozenset({"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"})
_FALSE = frozenset({"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"})
_INT = re.compile(r"[-+]?(?:0[xX][0-9a-fA-F]+|\d+)")
_FLOAT = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_SPECIAL = re.compile(r"([-+]?)\.?(inf|Inf|INF|nan|NaN|NAN)")
_ITEM = re.compile(r"""\s*(?P<item>'(?:[^']|'')*'|"(?:[^"\\]|\\.)*"|[^,\[\]'"{}]*?)\s*(?:,|$)""", re.DOTALL)


def parameter_value(text: str) -> Any:
    """Read `text` as a parameter: a bool, a number, a text, or a list of one of them.

    Raises:
        RosArgumentsError: it is a list of different things, or cannot be read.
    """
    text = text.strip()
    if not text.startswith("["):
        return _scalar(text)
    if not text.endswith("]"):
        raise RosArgumentsError(f"the list {text!r} has no end")
    values = [_scalar(item) for item in _items(text[1:-1].strip())]
    if len({type(value) for value in values}) > 1:
        raise RosArgumentsError(f"the list {text!r} has values of different types")
    return values


def _items(text: str) -> Iterator[str]:
    at = 0
    while at < len(text):
        found = _ITEM.match(text, at)
        if found is None or not found["item"]:
            raise RosArgumentsError(f"the list [{text}] cannot be read")
        yield found["item"]
        at = found.end()


def _scalar(text: str) -> Any:
    if len(text) > 1 and text[0] == text[-1] == "'":
        return text[1:-1].replace("''", "'")
    if len(text) > 1 and text[0] == text[-1] == '"':
        return re.sub(r"\\(.)", r"\1", text[1:-1])
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INT.fullmatch(text):
        return int(text, 16 if "x" in text.lower() else 10)
    special = _SPECIAL.fullmatch(text)
    if special is not None:
        return float(special[1] + special[2])
    return float(text) if _FLOAT.fullmatch(text) else text
