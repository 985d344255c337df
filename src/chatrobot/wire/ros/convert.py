"""Planar messages' nested dictionaries into the message objects that ROS generates."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from typing import Any

from chatrobot.core.errors import UsageError


@cache
def message_class(type_name: str) -> Any:
    """The class of `package/msg/Name`.

    Raises:
        UsageError: that package is not installed here.
    """
    package, _, name = type_name.split("/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError) as error:
        raise UsageError(
            f"ROS's {type_name} is not installed here",
            allowed=f"apt install ros-$ROS_DISTRO-{package.replace('_', '-')}, and source ROS's setup file",
        ) from error


def to_message(type_name: str, fields: Mapping[str, Any]) -> Any:
    """A message of these nested fields; what is left out is zero.

    Raises:
        UsageError: the type is not installed here.
    """
    message = message_class(type_name)()
    _fill(message, fields)
    return message


def _fill(message: Any, fields: Mapping[str, Any]) -> None:
    for name, value in fields.items():
        if isinstance(value, Mapping):
            _fill(getattr(message, name), value)
        elif isinstance(value, (list, tuple)):
            setattr(message, name, _sequence(message, name, value))
        elif isinstance(value, bytes) and isinstance(getattr(message, name), array):
            setattr(message, name, array("B", value))
        elif type(value) is int and isinstance(getattr(message, name), float):
            setattr(message, name, float(value))  # ROS asserts it, or takes its bits for a float's
        else:
            setattr(message, name, value)


def _sequence(message: Any, name: str, values: Any) -> Any:
    """A message's own sequence of numbers is an `array`, whose type is checked far faster than a list's items."""
    current = getattr(message, name)
    if isinstance(current, array):
        return array(current.typecode, values)
    if values and isinstance(values[0], Mapping):
        inner = message.get_fields_and_field_types()[name]  # sequence<geometry_msgs/TransformStamped>
        package, _, short = inner[inner.index("<") + 1 : inner.rindex(">")].split(",")[0].partition("/")
        return [to_message(f"{package}/msg/{short}", value) for value in values]
    return list(values)
