"""A path that begins outside a fence is judged by the governor's rule, one that begins inside by the edge."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.plan.fenced_path import Fence, nothing_passes, outside_m, way_out
from chatrobot.plan.known_world import Floats
from chatrobot.robots.profile import Circle

SQUARE = ((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1))
AHEAD = Circle(3.0, 0.0, 1.0)


def driven(twist: Twist, seconds: float, start: Pose = ORIGIN) -> Floats:
    times = np.arange(0.0, seconds, 0.02)
    return np.array([(t_s, *start.moved(twist, t_s)) for t_s in times.tolist()])


def asked_of(rows: Floats, fence: Fence) -> list[tuple[Twist, Pose]]:
    """What the rule is asked, where it allows everything."""
    asked: list[tuple[Twist, Pose]] = []

    def allows(twist: Twist, pose: Pose) -> float:
        asked.append((twist, pose))
        return 1.0

    assert way_out(rows, SQUARE, fence, lambda _fence: allows) is None
    return asked


def test_from_inside_the_edge_counts_and_nobody_is_asked() -> None:
    rows = driven(Twist(0.5, 0.0, 0.0), 4.0, Pose(3.0, 0.0, 0.0))
    found = way_out(rows, SQUARE, AHEAD, lambda _fence: pytest.fail("asked"))
    assert found is not None
    assert not found.is_outside
    assert rows[found.contact.row, 1] == pytest.approx(3.9, abs=0.02)


def test_from_outside_it_may_come_in() -> None:
    assert way_out(driven(Twist(0.5, 0.0, 0.0), 6.0), SQUARE, AHEAD, nothing_passes) is None


def test_from_outside_it_is_asked_before_it_gets_farther_out() -> None:
    found = way_out(driven(Twist(-0.5, 0.0, 0.0), 6.0), SQUARE, AHEAD, nothing_passes)
    assert found is not None
    assert (found.contact.row, found.is_outside) == (0, True)
    assert found.contact.x_m == pytest.approx(-0.1)


def test_what_comes_in_and_would_go_out_again_is_barred_inside() -> None:
    rows = driven(Twist(0.5, 0.0, 0.0), 12.0)
    found = way_out(rows, SQUARE, AHEAD, lambda _fence: lambda _asked, pose: float(pose.x_m < 3.8))
    assert found is not None
    assert not found.is_outside
    assert rows[found.contact.row, 1] == pytest.approx(3.8, abs=0.01)


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-2.0, 2.0), st.floats(-3.0, 3.0))
def test_it_is_asked_for_the_twist_that_the_path_shows(vx: float, vy: float, wz: float, yaw: float) -> None:
    twist, rows = Twist(vx, vy, wz), driven(Twist(vx, vy, wz), 2.0, Pose(0.0, 0.0, yaw))
    for asked, pose in asked_of(rows, AHEAD):
        assert pose in [Pose(*row[1:]) for row in rows.tolist()]
        assert list(asked) == pytest.approx(list(twist), abs=2e-3)


def test_where_it_stands_nothing_is_asked() -> None:
    rows = driven(Twist(-0.5, 0.0, 0.0), 1.0)
    waiting = np.array([(t_s, 0.0, 0.0, 0.0) for t_s in np.arange(0.0, 1.0, 0.02).tolist()])
    rows[:, 0] += 0.98
    first = asked_of(np.concatenate([waiting, rows]), AHEAD)[0]
    assert first[0].vx_mps == pytest.approx(-0.5)


def test_a_long_way_is_looked_at_to_its_end() -> None:
    """In pieces: it has more points than fit into memory at once."""
    home = driven(Twist(0.5, 0.0, 0.0), 100.0, Pose(-60.0, 0.0, 0.0))
    away = driven(Twist(-0.5, 0.0, 0.0), 1.0, Pose(-10.0, 0.0, 0.0))
    away[:, 0] += 100.0
    found = way_out(
        np.concatenate([home, away]),
        SQUARE,
        AHEAD,
        lambda _fence: lambda asked, _pose: float(asked.vx_mps > 0.0),
    )
    assert found is not None
    assert (found.contact.row, found.is_outside) == (len(home), True)


@pytest.mark.parametrize(
    ("x_m", "out_m"),
    [
        (3.0, 0.0),
        (3.895, 0.0),
        (3.899, 0.0),
        (4.0, math.hypot(1.1, 0.1) - 1.0),
        (5.0, math.hypot(2.1, 0.1) - 1.0),
    ],
)
def test_how_far_it_stands_outside_is_measured_at_its_farthest_corner(x_m: float, out_m: float) -> None:
    assert outside_m(Pose(x_m, 0.0, 0.0), SQUARE, AHEAD) == pytest.approx(out_m, abs=1e-4)
