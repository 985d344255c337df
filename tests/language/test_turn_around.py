"""To turn around is to look the other way; what spins counts whole turns."""

from __future__ import annotations

import math

import pytest

from tests.language.dialogue_runner import conversation


@pytest.mark.parametrize(
    ("said", "turned_deg"),
    [
        ("turn around twice", 360.0),
        ("turn round twice", 360.0),
        ("turn around three times", 540.0),
        ("turn around two times slowly", 360.0),
        ("spin around twice", 720.0),
        ("turn all the way around twice", 720.0),
        ("转身两次", 360.0),
        ("掉头两次", 360.0),
        ("向后转三次", 540.0),
        ("转两圈", 720.0),
    ],
)
def test_to_turn_around_so_often_is_half_a_turn_each_time(said: str, turned_deg: float) -> None:
    assert math.degrees(abs(conversation(said).track.turned_rad)) == pytest.approx(turned_deg)
