"""When a twist would touch a point: the same arithmetic forwards, sideways and turning."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.governor.contact import Footprint, _moved, _seen_from, seconds_to_contact

BOX = Footprint(((0.2, -0.1), (0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1)))
"""0.4 m long, 0.2 m wide."""

MARGIN_M = 0.03


def seconds(x: float, y: float, twist: Twist, horizon_s: float = 2.0) -> float:
    return seconds_to_contact(BOX, np.array([[x, y]]), twist, horizon_s, MARGIN_M)


def test_clearance_is_the_distance_to_the_sides_positive_outside() -> None:
    points = np.array(
        [[0.3, 0.0], [0.0, 0.3], [-0.3, 0.05], [0.0, -0.15], [0.0, 0.0], [0.19, 0.0], [0.2, 0.1]]
    )
    expected = [0.1, 0.2, 0.1, 0.05, -0.1, -0.01, 0.0]
    assert BOX.clearance_m(points[:, 0], points[:, 1]) == pytest.approx(expected)
    assert BOX.radius_m == pytest.approx(math.hypot(0.2, 0.1))


def test_a_footprint_need_not_have_sides_of_one_length_or_right_angles() -> None:
    assert Footprint(((1.0, -0.1), (1.0, 0.1), (-0.2, 0.0))).radius_m == pytest.approx(math.hypot(1.0, 0.1))
    slanted = Footprint(((0.4, 0.0), (0.0, 0.3), (-0.2, -0.3)))
    # the side from (0.4, 0) to (0, 0.3) has the normal (0.6, 0.8) and the offset 0.24
    assert slanted.clearance_m(np.array([0.6]), np.array([0.8])) == pytest.approx([1.0 - 0.24])


@pytest.mark.parametrize(
    ("x", "y", "twist", "way_m"),
    [
        (1.0, 0.05, Twist(0.5, 0.0, 0.0), 1.0 - 0.2 - MARGIN_M),
        (-1.0, -0.05, Twist(-0.5, 0.0, 0.0), 1.0 - 0.2 - MARGIN_M),
        (0.1, 0.8, Twist(0.0, 0.5, 0.0), 0.8 - 0.1 - MARGIN_M),
        (0.0, 1.1, Twist(0.0, 0.5, 0.0), 1.1 - 0.1 - MARGIN_M),
        (-0.1, -0.8, Twist(0.0, -0.5, 0.0), 0.8 - 0.1 - MARGIN_M),
    ],
)
def test_straight_on_it_is_the_way_over_the_speed(x: float, y: float, twist: Twist, way_m: float) -> None:
    assert seconds(x, y, twist) == pytest.approx(way_m / 0.5, abs=0.002)


def test_beside_the_way_and_behind_there_is_no_contact() -> None:
    ahead = Twist(0.5, 0.0, 0.0)
    assert seconds(1.0, 0.1 + MARGIN_M + 0.001, ahead) == math.inf
    assert seconds(-0.3, 0.0, ahead) == math.inf
    assert seconds(1.0, 0.1 + MARGIN_M - 0.002, ahead) < 2.0


def test_beyond_the_horizon_there_is_no_contact() -> None:
    assert seconds(1.0, 0.0, Twist(0.5, 0.0, 0.0), horizon_s=1.5) == math.inf
    assert seconds(1.0, 0.0, Twist(0.5, 0.0, 0.0), horizon_s=1.6) == pytest.approx(1.54, abs=0.002)


def test_a_corner_that_swings_touches() -> None:
    """A post beside the robot, nearer than its corners reach: the corner at (0.2, -0.1) comes round to it."""
    assert seconds(0.0, 0.18, Twist(0.0, 0.0, 0.5), 4.0) < 3.0
    assert seconds(0.0, 0.18, Twist(0.0, 0.0, -0.5), 4.0) == pytest.approx(
        seconds(0.0, 0.18, Twist(0.0, 0.0, 0.5), 4.0)
    )
    assert seconds(0.0, BOX.radius_m + MARGIN_M + 0.01, Twist(0.0, 0.0, 0.5), 4.0) == math.inf


def test_what_is_within_the_margin_already_may_be_left_but_not_approached() -> None:
    assert seconds(0.22, 0.0, Twist(-0.5, 0.0, 0.0)) == math.inf
    assert seconds(0.22, 0.0, Twist(0.5, 0.0, 0.0)) == 0.0
    assert seconds(0.22, 0.0, Twist(0.0, 0.5, 0.0)) == math.inf, "along it"
    assert seconds(0.2 + MARGIN_M, 0.0, Twist(0.5, 0.0, 0.0)) == 0.0


def test_nothing_to_touch_is_never_touched() -> None:
    assert seconds_to_contact(BOX, np.empty((0, 2)), Twist(0.5, 0.0, 0.0), 2.0, MARGIN_M) == math.inf


def test_straight_on_there_is_nothing_that_cannot_be_divided() -> None:
    with np.errstate(all="raise"):
        angle, x, y = _moved(Twist(0.5, 0.25, 0.0), np.array([0.0, 2.0]))
    assert (angle.tolist(), x.tolist(), y.tolist()) == ([0.0, 0.0], [0.0, 1.0], [0.0, 0.5])


def test_the_nearest_of_many_points_counts() -> None:
    points = np.array([[5.0, 0.0], [1.2, 0.0], [0.9, 0.05], [0.0, 0.5]])
    assert seconds_to_contact(BOX, points, Twist(0.5, 0.0, 0.0), 2.0, MARGIN_M) == pytest.approx(
        1.34, abs=0.002
    )
    assert seconds_to_contact(BOX, points[:1], Twist(0.5, 0.0, 0.0), 2.0, MARGIN_M) == math.inf
    one_near = np.array([[0.215, 0.0], [0.9, 0.0]])
    assert seconds_to_contact(BOX, one_near, Twist(0.5, 0.0, 0.0), 2.0, MARGIN_M) == 0.0


@given(
    st.floats(-1.0, 1.0),
    st.floats(-1.0, 1.0),
    st.floats(-2.0, 2.0) | st.floats(-1e-5, 1e-5),
    st.floats(-3.0, 3.0),
    st.floats(-3.0, 3.0),
)
def test_points_pass_by_as_the_exact_motion_says(vx: float, vy: float, wz: float, x: float, y: float) -> None:
    twist, times = Twist(vx, vy, wz), np.array([0.0, 0.4, 1.0])
    seen_x, seen_y = _seen_from(np.array([[x, y]]), *_moved(twist, times))
    for row, time_s in enumerate(times.tolist()):
        expected = Pose(x, y).relative_to(ORIGIN.moved(twist, time_s))
        assert (seen_x[row, 0], seen_y[row, 0]) == pytest.approx(expected[:2], abs=1e-6)


@settings(deadline=None, max_examples=60)
@given(
    st.lists(st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)), min_size=1, max_size=12),
    st.floats(-0.5, 0.5),
    st.floats(-0.5, 0.5),
    st.floats(-2.0, 2.0),
    st.floats(0.1, 1.0),
)
def test_no_point_that_the_way_comes_near_is_passed_over(
    points: list[tuple[float, float]], vx: float, vy: float, wz: float, horizon_s: float
) -> None:
    """Points far from the way are not looked at: all of them together find what each alone does, one far or near."""
    twist = Twist(vx, vy, wz)
    alone = min(seconds(x, y, twist, horizon_s) for x, y in points)
    together = seconds_to_contact(BOX, np.array(points), twist, horizon_s, MARGIN_M)
    assert together <= alone + 1e-9
    for x, y in points:
        touches = any(
            BOX.clearance_m(*map(np.array, zip(Pose(x, y).relative_to(ORIGIN.moved(twist, t))[:2])))[0]
            < -0.02
            for t in np.linspace(0.0, horizon_s, 40).tolist()
        )
        outside = BOX.clearance_m(np.array([x]), np.array([y]))[0] > MARGIN_M
        if touches and outside:
            assert together < math.inf
