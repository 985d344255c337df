"""The page on what programs find names all that they find."""

from __future__ import annotations

import pkgutil
from pathlib import Path

from chatrobot.programs import names
from chatrobot.programs.names import rclpy

PAGE = (Path(__file__).parents[2] / "docs" / "rclpy-in-the-sandbox.md").read_text(encoding="utf-8")
INNER = {
    "_rclpy_pybind11",
    "impl",
    "node_checks",
    "node_graph",
    "node_parameters",
    "node_entities",
    "arguments",
    "constants",
    "clock_type",
}
WITHIN_NODE = {
    "publisher",
    "subscription",
    "service",
    "client",
    "timer",
    "guard_condition",
    "context",
    "event_handler",
}


def test_every_package_is_named() -> None:
    assert not [info.name for info in pkgutil.iter_modules(names.__path__) if f"`{info.name}`" not in PAGE]


def test_every_part_of_rclpy_is_named() -> None:
    parts = {info.name for info in pkgutil.iter_modules(rclpy.__path__)} - INNER - WITHIN_NODE - {"action"}
    assert not [part for part in parts if f".{part}`" not in PAGE]
