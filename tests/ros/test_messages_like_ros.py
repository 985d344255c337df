"""Our message classes are ROS's: the same fields, types and defaults, and the same is taken and refused."""

from __future__ import annotations

import importlib
import itertools
import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "src"))
from chatrobot.programs.inside.interfaces import REGISTRY

KINDS = {name: kind for name, kind in REGISTRY.items() if "_R" not in name}
ODD = (
    None,
    True,
    1,
    -1,
    2**70,
    1.5,
    float("nan"),
    float("inf"),
    1e300,
    "x",
    b"x",
    b"xy",
    [1],
    [1.5],
    ["x"],
    {},
    object(),
)


def theirs(name: str) -> Any:
    package, kind = name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.msg"), kind)
    except ModuleNotFoundError:
        pytest.skip(f"{package} is not installed")


@pytest.mark.parametrize("name", sorted(KINDS))
def test_fields_and_types_are_the_same(name: str) -> None:
    assert KINDS[name].get_fields_and_field_types() == theirs(name).get_fields_and_field_types()


@pytest.mark.parametrize("name", sorted(KINDS))
def test_a_new_one_looks_the_same(name: str) -> None:
    assert repr(KINDS[name]()) == repr(theirs(name)())
    assert type(KINDS[name]()).__module__ == type(theirs(name)()).__module__


def outcome(kind: Any, field: str, value: Any) -> str:
    """What comes of an assignment: the value as it is read back, or what is said against it."""
    message = kind()
    try:
        setattr(message, field, value)
    except (AssertionError, ValueError) as error:
        return f"refused: {str(error).splitlines()[0]}"
    return "taken"


@pytest.mark.parametrize("name", sorted(KINDS))
def test_what_is_taken_and_what_is_refused_is_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Jazzy checks only where it is asked to; Humble always does."""
    real = theirs(name)
    module = sys.modules[real.__module__]
    if hasattr(module, "ros_python_check_fields"):
        monkeypatch.setattr(module, "ros_python_check_fields", "1")
    monkeypatch.setenv("ROS_PYTHON_CHECK_FIELDS", "1")
    for field, value in itertools.product(KINDS[name]._field_names, ODD):
        ours, said = outcome(KINDS[name], field, value), outcome(real, field, value)
        assert ours[:7] == said[:7], (field, value, ours, said)
