"""A run does not begin inside an obstacle: whoever chose the world is told what stands there."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.compose import Setup, connect
from chatrobot.core.errors import WorldError
from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.sim.__main__ import main
from chatrobot.sim.load import load_world, parse_world
from chatrobot.sim.world import check_start

MECANUM = load_profile("wheeltec_mini_mec")
"""0.27 m long, 0.222 m wide."""


def world(shape: str) -> str:
    return f"name: shop\nobstacles:\n  - {{name: table, {shape}}}\n"


@pytest.mark.parametrize(
    "shape",
    [
        "rectangle: {x_m: 0, y_m: 0, length_m: 2, width_m: 2}",
        "rectangle: {x_m: 0.6, y_m: 0, length_m: 1, width_m: 1}",
        "rectangle: {x_m: 0, y_m: 0, length_m: 0.05, width_m: 3}",
        "rectangle: {x_m: 0.1, y_m: 0, length_m: 0.02, width_m: 0.02}",
        "circle: {x_m: 0.2, y_m: 0, radius_m: 0.1}",
        "wall: {from: [-1, 0.1], to: [1, 0.1], thickness_m: 0.1}",
    ],
)
def test_a_start_in_an_obstacle_is_refused_by_its_name(shape: str) -> None:
    with pytest.raises(WorldError, match="table"):
        check_start(parse_world(world(shape), "shop.yaml"), MECANUM, "--world shop.yaml")


@pytest.mark.parametrize(
    "shape",
    [
        "rectangle: {x_m: 0.64, y_m: 0, length_m: 1, width_m: 1}",
        "circle: {x_m: 0.25, y_m: 0, radius_m: 0.1}",
        "wall: {from: [-1, 0.2], to: [1, 0.2], thickness_m: 0.1}",
    ],
)
def test_a_start_beside_an_obstacle_is_fine(shape: str) -> None:
    check_start(parse_world(world(shape), "shop.yaml"), MECANUM, "--world shop.yaml")


@pytest.mark.parametrize("name", [entry.name for entry in list_profiles()])
def test_every_robot_can_start_at_home(name: str) -> None:
    check_start(load_world("home"), load_profile(name), "--world home")


def test_session_and_simulated_robot_do_not_begin_there(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "shop.yaml"
    file.write_text(world("rectangle: {x_m: 0, y_m: 0, length_m: 2, width_m: 2}"))
    for fast in (True, False):
        with pytest.raises(WorldError, match="lies in the table"):
            connect(Setup(world=str(file), fast=fast), lambda _: None)
    socket = str(tmp_path / "wire")
    assert main(["--profile", "wheeltec_mini_mec", "--world", str(file), "--socket", socket]) == 2
    assert "lies in the table" in capfd.readouterr().err
