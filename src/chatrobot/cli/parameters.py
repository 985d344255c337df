"""The tutorial's parameters, as `ros2 run` takes them: `-p revChatGPT:=True`."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.core.errors import UsageError

NAMES = ("generate_code", "revChatGPT")
_VALUES = {"true": True, "false": False}


def read_parameters(given: Sequence[str]) -> dict[str, bool]:
    """The values of `-p NAME:=VALUE`, by name.

    Raises:
        UsageError: there is no such parameter, or no such value.
    """
    values = dict.fromkeys(NAMES, False)
    for parameter in given:
        name, _, value = parameter.partition(":=")
        if name not in values or value.lower() not in _VALUES:
            raise UsageError(
                f"{parameter!r} is no parameter here without --on ros",
                where="-p",
                allowed="generate_code:=True, revChatGPT:=True",
            )
        values[name] = _VALUES[value.lower()]
    return values


def parameters_in(ros_args: Sequence[str]) -> list[str]:
    """The `NAME:=VALUE` of what stands after `--ros-args`; what is something else comes as it is."""
    words = iter(ros_args)
    return [next(words, "") if word in ("-p", "--param") else word for word in words]
