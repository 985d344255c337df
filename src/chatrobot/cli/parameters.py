"""ROS parameters on the command line: the tutorial's own, and files of them among a program's arguments."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from chatrobot.core.errors import UsageError
from chatrobot.options import TUTORIAL

_VALUES = {"true": True, "false": False}


def read_parameters(given: Sequence[str]) -> dict[str, bool]:
    """Return the values of `-p NAME:=VALUE`, by name.

    Raises:
        UsageError: there is no such parameter, or no such value.
    """
    values = {parameter.name: False for parameter in TUTORIAL}
    for parameter in given:
        name, _, value = parameter.partition(":=")
        if name not in values or value.lower() not in _VALUES:
            raise UsageError(
                f"{parameter!r} is not a parameter here; others need --on ros",
                where="-p",
                allowed="generate_code:=True, revChatGPT:=True",
            )
        values[name] = _VALUES[value.lower()]
    return values


def parameters_in(ros_args: Sequence[str]) -> list[str]:
    """List the `NAME:=VALUE` of what stands after `--ros-args`; anything else comes as it is."""
    words = iter(ros_args)
    return [next(words, "") if word in ("-p", "--param") else word for word in words]


_OPTION = "--params-file"
_FORM = "a ROS parameter file: NODE: {ros__parameters: {NAME: VALUE}}"
_MOST_BYTES = 100_000


def with_parameter_files(args: Sequence[str]) -> list[str]:
    """`args` with each `--params-file FILE` behind `--ros-args` put as `-p NODE:NAME:=VALUE`, in its place.

    Raises:
        UsageError: a file cannot be read, or is none.
    """
    found: list[str] = []
    is_ros = False
    rest = iter(args)
    for argument in rest:
        is_ros = argument == "--ros-args" or (is_ros and argument != "--")
        if is_ros and argument == _OPTION:
            for rule in _rules(next(rest, "")):
                found += ["-p", rule]
        else:
            found.append(argument)
    return found


def _rules(name: str) -> Iterator[str]:
    import yaml

    try:
        with Path(name).expanduser().open("rb") as file:
            data = yaml.safe_load(file.read(_MOST_BYTES))
    except OSError as error:
        raise UsageError(f"cannot be read ({error.strerror})", where=f"{_OPTION} {name}") from error
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise UsageError("not YAML", where=f"{_OPTION} {name}", allowed=_FORM) from error
    if not isinstance(data, dict):
        raise UsageError("not a ROS parameter file", where=f"{_OPTION} {name}", allowed=_FORM)
    for node, about in data.items():
        values = about.get("ros__parameters") if isinstance(about, dict) else None
        node_name = "" if node == "/**" else str(node).lstrip("/")
        if not isinstance(values, dict) or "/" in node_name or "*" in node_name:
            raise UsageError(
                f"{node!r} is not a node with ros__parameters", where=f"{_OPTION} {name}", allowed=_FORM
            )
        prefix = f"{node_name}:" if node_name else ""
        for parameter, value in _flat(values):
            yield f"{prefix}{parameter}:={_written(value)}"


def _flat(values: Mapping[Any, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Names below names are put as `outer.inner`."""
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _written(value: Any) -> str:
    """`value` as `-p` takes it; a text is put in quotes, so that it stays one."""
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value)
    text = str(value).replace("'", "''")
    return f"'{text}'"
