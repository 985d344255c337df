"""What is told is where the robot truly is: after a square and a question, and after thirty turns of all kinds."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from scripts import soak
from scripts.soak import Player, Turn


@pytest.fixture
def player(tmp_path: Path) -> Player:
    return Player("empty", real=False, folder=tmp_path)


def test_time_that_passes_after_a_motion_does_no_harm(player: Player) -> None:
    for text in ("drive a square with sides of 1 m", "where are you?", "forward 2 m", "forward 2 m"):
        told = player.play(Turn(text))
        assert (player.true.vx_mps, player.true.vy_mps, player.true.wz_radps) == (0.0, 0.0, 0.0)
        player.live(3.0)
    true = player.true
    assert math.hypot(told.pose.x_m - true.x_m, told.pose.y_m - true.y_m) < 0.001
    assert math.degrees(told.pose.yaw_rad - true.yaw_rad) == pytest.approx(0.0, abs=0.02)
    assert (true.x_m, true.y_m) == pytest.approx((4.0, 0.0), abs=0.005)


@pytest.mark.parametrize(
    "text", ["turn left 90 degrees", "turn right 10 degrees", "turn left 180 degrees at 1.5 rad/s"]
)
def test_a_turn_ends_where_it_was_to_end(player: Player, text: str) -> None:
    """It used to go 0.2 to 0.3 degrees too far."""
    told = player.play(Turn(text))
    asked_deg = float(text.split()[2]) * (1.0 if "left" in text else -1.0)
    assert math.degrees(player.true.yaw_rad) == pytest.approx(asked_deg, abs=0.05)
    assert math.degrees(told.turned_rad) == pytest.approx(asked_deg, abs=0.05)


def test_what_was_turned_before_a_stop_is_told_as_it_stands(player: Player) -> None:
    told = player.play(Turn("drive a circle with radius 0.5 m", stop_after_s=4.0))
    player.live(1.0)
    assert told.outcome == "stopped"
    assert math.degrees(told.turned_rad) == pytest.approx(math.degrees(player.true.yaw_rad), abs=0.05)
    (said_deg,) = re.findall(r"turned (-?[\d.]+)°", told.reply)
    assert float(said_deg) == pytest.approx(math.degrees(player.true.yaw_rad), abs=0.5)


@pytest.mark.slow
@pytest.mark.parametrize("world", soak.WORLDS)
def test_a_long_session_ends_where_it_says(world: str) -> None:
    """One of each; `make soak` plays a hundred."""
    session = soak.play(world, seed=0)
    assert session.is_within, f"{session.off_m} m, {session.off_deg} degrees off"
    assert session.outcomes["completed"] > 10
