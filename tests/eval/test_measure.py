"""A trace of true poses, in numbers."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Twist
from chatrobot.sim.trace import has_moved, measure
from tests.eval.traces import forward, left, rest, trace


def test_nothing_is_no_motion() -> None:
    measured = measure([])
    assert not measured.has_moved
    assert measured.path_m == 0.0


def test_there_and_back_is_a_path_and_no_displacement() -> None:
    measured = measure(trace(forward(2.0), forward(-2.0)))
    assert measured.path_m == pytest.approx(4.0)
    assert measured.distance_m == pytest.approx(0.0, abs=1e-9)
    assert measured.farthest_m == pytest.approx(2.0)


def test_rotation_is_counted_in_full_and_the_heading_modulo_a_turn() -> None:
    measured = measure(trace(left(math.radians(720 + 90))))
    assert measured.turned_deg == pytest.approx(810.0, abs=0.6)
    assert measured.yaw_deg == pytest.approx(90.0, abs=0.6)


def test_half_a_turn_is_180_degrees_and_not_minus_180() -> None:
    assert measure(trace((math.pi, Twist(0.0, 0.0, 1.0)))).yaw_deg == pytest.approx(180.0, abs=0.5)


def test_only_standing_between_motions_is_a_pause() -> None:
    measured = measure(trace(rest(5.0), forward(1.0), rest(3.0), forward(1.0), rest(7.0)))
    assert measured.pause_s == pytest.approx(3.0, abs=0.03)
    assert measured.duration_s == pytest.approx(4.0, abs=0.03)


def test_coming_to_rest_for_a_moment_between_two_steps_is_no_pause() -> None:
    measured = measure(trace(forward(1.0), rest(0.08), left(0.5), rest(0.08), forward(1.0)))
    assert measured.pause_s == 0.0
    assert measured.duration_s == pytest.approx(5.16, abs=0.05)


def test_top_speeds_are_those_of_any_direction() -> None:
    measured = measure(trace((1.0, Twist(0.3, -0.4)), (1.0, Twist(0.0, 0.0, -0.7))))
    assert measured.max_speed == pytest.approx(0.5)
    assert measured.max_turn_rate == pytest.approx(0.7)


def test_a_tremble_is_no_motion_but_a_movement_that_is_undone_is_one() -> None:
    assert not has_moved(trace((1.0, Twist(0.004))))
    assert has_moved(trace(forward(0.1), forward(-0.1)))
    assert has_moved(trace(left(0.1), left(-0.1)))
