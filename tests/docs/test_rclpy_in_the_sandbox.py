"""The page on what programs find names all that they find."""

from __future__ import annotations

from pathlib import Path

from chatrobot.programs.inside.top_level import modules

PAGE = (Path(__file__).parents[2] / "docs" / "rclpy-in-the-sandbox.md").read_text(encoding="utf-8")
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
INNER = {"_rclpy_pybind11", "impl", "constants", "clock_type", "action"}


def test_every_package_is_named() -> None:
    assert not [name for name in modules() if "." not in name and f"`{name}`" not in PAGE]


def test_every_part_of_rclpy_is_named() -> None:
    parts = {name.split(".")[1] for name in modules() if name.startswith("rclpy.")} - INNER - WITHIN_NODE
    assert len(parts) > 10
    assert not [part for part in parts if f".{part}`" not in PAGE]
