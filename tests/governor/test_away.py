"""A robot in contact, within the margin of something, moves away slowly, nearer to nothing, or not at all."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.governor.situations import MECANUM, at

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.governor.contact import Footprint, comes_nearer
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE, NOTHING_SENSED, Situation
from chatrobot.governor.space_rules import AWAY_MPS, MARGIN_M, NEARER_M, RELEASE_M, ObstacleRule
from chatrobot.robots.load import load_profile

FRONT_M, SIDE_M = 0.135, 0.111
BODY = Footprint(MECANUM.footprint)
TICK_S = 0.02

assert MECANUM.lidar is not None
LIDAR = MECANUM.lidar


class Known(ObstacleMemory):
    """What the lidar has seen, given as points."""

    def __init__(self, *points: tuple[float, float]) -> None:
        super().__init__(LIDAR)
        self.points = np.array(points, dtype=float).reshape(-1, 2)


def rule(*points: tuple[float, float]) -> ObstacleRule:
    return ObstacleRule(MECANUM, Known(*points))


def fastest_mps(twist: Twist) -> float:
    """Of all points of the outline, at most."""
    return twist.speed_mps + abs(twist.wz_radps) * BODY.radius_m


WALL_AHEAD = [(FRONT_M + 0.02, y) for y in (-0.1, 0.0, 0.1)]


@pytest.mark.parametrize(
    "asked", [Twist(-0.5), Twist(-0.5, 0.2, 0.0), Twist(0.0, 0.3, 0.0), Twist(-1.0, 0.0, 0.5)]
)
def test_away_from_a_wall_and_along_it_is_slow(asked: Twist) -> None:
    ruling = rule(*WALL_AHEAD).judge(asked, at())
    assert fastest_mps(asked.scaled(ruling.factor)) == pytest.approx(AWAY_MPS)
    assert ruling.urgent
    assert ruling.reason is not None
    assert ruling.reason.code == "in_contact"
    assert ruling.reason.values == {"distance_m": 0.02, "speed_mps": AWAY_MPS}
    nearer = rule((FRONT_M + 0.0134, 0.0)).judge(Twist(-0.5), at())
    assert nearer.reason is not None
    assert nearer.reason.values["distance_m"] == 0.01


@pytest.mark.parametrize("asked", [Twist(0.3), Twist(0.02), Twist(0.2, 0.5, 0.0), Twist(0.0, 0.0, 0.5)])
def test_nearer_is_barred_however_slow(asked: Twist) -> None:
    ruling = rule(*WALL_AHEAD).judge(asked, at())
    assert ruling.factor == 0.0
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("obstacle_ahead", {"distance_m": 0.0})


def test_who_asks_for_less_is_not_limited() -> None:
    assert rule(*WALL_AHEAD).judge(Twist(-0.9 * AWAY_MPS), at()) is FREE
    assert rule(*WALL_AHEAD).judge(Twist(-AWAY_MPS), at()) is FREE
    slowed = rule(*WALL_AHEAD).judge(Twist(-1.1 * AWAY_MPS), at())
    assert slowed.factor == pytest.approx(1.0 / 1.1)


def test_contact_ends_at_the_margin() -> None:
    back = Twist(-0.5)
    assert rule((FRONT_M + MARGIN_M - 0.001, 0.0)).judge(back, at()).factor < 1.0
    assert rule((FRONT_M + MARGIN_M + 0.001, 0.0)).judge(back, at()) is FREE


def test_a_twist_too_small_to_measure_is_no_trouble() -> None:
    assert rule(*WALL_AHEAD).judge(Twist(0.0, 0.0, 5e-324), at()).factor in (0.0, 1.0)


def test_a_turn_is_slow_at_the_corners() -> None:
    """The point lies behind the corner that a turn to the left takes away from it."""
    beside = (FRONT_M - 0.01, SIDE_M + 0.02)
    free, barred = Twist(0.0, 0.0, 1.0), Twist(0.0, 0.0, -1.0)
    rulings = [rule(beside).judge(asked, at()).factor for asked in (free, barred)]
    assert sorted(factor > 0.0 for factor in rulings) == [False, True]
    assert max(rulings) * BODY.radius_m == pytest.approx(AWAY_MPS)


def test_between_two_things_nothing_goes_nearer_to_either() -> None:
    between = rule((FRONT_M + 0.02, 0.0), (-FRONT_M - 0.02, 0.0))
    assert between.judge(Twist(0.3), at()).factor == 0.0
    assert between.judge(Twist(-0.3), at()).factor == 0.0
    assert between.judge(Twist(0.0, 0.3, 0.0), at()).factor > 0.0
    behind = rule((FRONT_M + 0.01, 0.0), (-FRONT_M - 0.025, 0.0))
    assert behind.judge(Twist(-0.3), at()).factor == 0.0, (
        "it would end up nearer to the one than to the other now"
    )
    farther = rule((FRONT_M + 0.01, 0.0), (-FRONT_M - 0.05, 0.0))
    assert farther.judge(Twist(-0.3), at()).factor > 0.0
    assert farther.judge(Twist(-0.3), at(Pose(-0.019, 0.0, 0.0))).factor == 0.0, "and stays in the middle"


def test_a_slow_way_along_a_wall_may_not_lean_towards_it() -> None:
    wall = [(x / 50.0, SIDE_M + 0.02) for x in range(-30, 31)]
    along = rule(*wall)
    assert along.judge(Twist(0.05), at()).factor == 1.0
    assert along.judge(Twist(0.05, -0.01, 0.0), at()).factor > 0.0
    assert along.judge(Twist(0.05, 0.002, 0.0), at()).factor == 0.0
    assert along.judge(Twist(0.05, 0.0003, 0.0), at()).factor > 0.0, "feedback sways a little"


def test_a_new_motion_is_not_barred_by_the_way_of_the_one_before() -> None:
    front, side = (FRONT_M + MARGIN_M + 0.0005, 0.0), (0.0, SIDE_M + MARGIN_M + 0.01)
    stopped = rule(front, side)
    assert stopped.judge(Twist(0.3), at()).factor == 0.0
    leaning = Twist(-0.3, 0.1, 0.0)
    assert stopped.judge(leaning, at()).factor == 0.0, "all within the release counts while it is barred"
    assert stopped.judge(Twist(), Situation(None, NOTHING_SENSED, begins=True)) is FREE
    assert stopped.judge(leaning, at()).factor > 0.0


def test_a_way_out_that_is_found_is_not_barred_any_more() -> None:
    touching = rule(*WALL_AHEAD)
    assert touching.judge(Twist(0.3), at()).factor == 0.0
    assert touching.judge(Twist(-0.3), at()).factor > 0.0
    out = Pose(-0.5 * RELEASE_M - 0.02, 0.0, 0.0)
    assert touching.judge(Twist(0.3), at(out)).factor > 0.0, "it left"


def test_what_is_barred_in_contact_wants_room_before_it_opens() -> None:
    touching = rule((FRONT_M + 0.02, 0.0))
    assert touching.judge(Twist(0.3), at()).factor == 0.0
    out = Pose(-0.5 * RELEASE_M - 0.01, 0.0, 0.0)
    assert touching.judge(Twist(0.3), at(out)).factor == 0.0
    assert rule((FRONT_M + 0.02, 0.0)).judge(Twist(0.3), at(out)).factor > 0.0


def test_the_nearest_point_is_found_among_those_that_are_near() -> None:
    points = np.array([[5.0, 0.0], [FRONT_M + 0.02, 0.0], [FRONT_M + 0.01, 0.05], [0.0, 1.0]])
    assert BODY.nearest_m(points, MARGIN_M) == pytest.approx(0.01)
    assert BODY.nearest_m(points[:1], MARGIN_M) == math.inf
    assert BODY.nearest_m(np.empty((0, 2)), MARGIN_M) == math.inf
    just_outside = np.array([[BODY.radius_m + MARGIN_M + 0.001, 0.0]])
    assert BODY.nearest_m(just_outside, MARGIN_M) == math.inf
    at_the_corner = np.array([[0.0, BODY.radius_m + MARGIN_M - 0.001]])
    assert BODY.nearest_m(at_the_corner, MARGIN_M) < math.inf


def nearer(point: tuple[float, float], twist: Twist, nearest_m: float = 0.0, by_m: float = 0.001) -> bool:
    return comes_nearer(BODY, np.array([point, (0.5, 0.5)]), twist, 0.2, nearest_m, by_m)


def test_nearer_means_nearer_than_it_is_and_than_the_nearest_is() -> None:
    ahead = (FRONT_M + 0.02, 0.0)
    assert nearer(ahead, Twist(0.05), 0.02)
    assert not nearer(ahead, Twist(0.05), 0.02, by_m=0.011)
    assert not nearer(ahead, Twist(0.05), 0.009)
    assert nearer(ahead, Twist(0.05), 0.012)
    assert nearer(ahead, Twist(0.05), 0.03), "one that is nearer than that already comes no nearer than it is"
    assert not nearer(ahead, Twist(-0.05), 0.03)
    assert not comes_nearer(BODY, np.empty((0, 2)), Twist(0.05), 1.0, 0.02, 0.001)


def test_a_big_robot_sees_what_is_beside_it() -> None:
    big = Footprint(tuple((16.0 * x, 16.0 * y) for x, y in MECANUM.footprint))
    ahead = np.array([(16.0 * FRONT_M + 0.02, 0.0)])
    assert comes_nearer(big, ahead, Twist(0.05), 0.4, 0.02, NEARER_M)
    assert not comes_nearer(big, ahead, Twist(-0.05), 0.4, 0.02, NEARER_M)


def test_what_passes_a_corner_comes_nearest_between_two_looks() -> None:
    """Half way it is half a millimetre nearer than at either end; what is told is no more than that."""
    beside, past = (
        np.array([[FRONT_M + 0.02, FRONT_M + 0.019]]).T,
        np.array([[SIDE_M + 0.019, SIDE_M + 0.02]]).T,
    )
    assert BODY.clearance_m(beside, past).ravel() == pytest.approx([0.02, 0.02])
    assert BODY.kept_m(beside, past).ravel() == pytest.approx([0.019])
    outwards = np.array([[FRONT_M + 0.02, FRONT_M + 0.05, FRONT_M + 0.04]]).T
    assert BODY.kept_m(outwards, 0.0 * outwards).ravel() == pytest.approx([0.02, 0.04])


def test_what_does_not_move_keeps_its_clearance() -> None:
    lopsided = Footprint(((0.3, -0.1), (0.1, 0.2), (-0.2, 0.05)))
    x, y = np.array([[0.3, -0.3, 0.1, 0.0]] * 2), np.array([[0.2, 0.1, -0.4, 0.5]] * 2)
    assert lopsided.kept_m(x, y)[0] == pytest.approx(lopsided.clearance_m(x[0], y[0]))


def test_what_lies_beyond_the_circle_counts_beside_a_corner() -> None:
    """The half planes say 0.017 m, the corner is farther away, and the turn brings it nearer all the same."""
    corners = load_profile("wheeltec_mini_diff").footprint
    diff, corner = Footprint(corners), max(corners)
    outside = [
        (corner[0] + 0.017, corner[1] + math.copysign(beyond_m, corner[1]))
        for beyond_m in np.linspace(0.0, 0.0169, 20).tolist()
    ]
    outside = [point for point in outside if math.hypot(*point) > diff.radius_m + 0.017]
    assert any(
        comes_nearer(diff, np.array([point]), Twist(0.0, 0.0, wz), 0.4, 0.017, NEARER_M)
        for point in outside
        for wz in (0.2, -0.2)
    )


near = st.tuples(st.floats(0.0, math.tau), st.floats(-0.01, 0.05)).map(
    lambda at: (
        (math.cos(at[0]) * (FRONT_M + at[1])),
        (math.sin(at[0]) * (SIDE_M + at[1])),
    )
)
speeds = st.floats(-0.6, 0.6)


@settings(deadline=None, max_examples=100)
@given(st.lists(near, min_size=1, max_size=6), speeds, speeds, st.floats(-1.5, 1.5))
@example([(FRONT_M + 0.02, 0.0)], -0.5, 0.0, 0.0)
@example([(FRONT_M + 0.02, 0.1), (-FRONT_M - 0.02, -0.1)], 0.0, 0.0, 1.0)
@example([(0.1318589124545741, 0.10873664981170308)], 0.0, 0.0, 1.0)  # nearest between two looks ahead
def test_nothing_in_contact_is_approached_and_no_corner_is_fast(
    points: list[tuple[float, float]], vx: float, vy: float, wz: float
) -> None:
    """A second of whatever the rule lets through, at 50 Hz."""
    asked, pose, judged = Twist(vx, vy, wz), ORIGIN, rule(*points)
    for _ in range(50):
        before = clearances(points, pose)
        nearest_m = BODY.nearest_m(seen_from(points, pose), MARGIN_M)
        sent = asked.scaled(judged.judge(asked, at(pose)).factor)
        pose = pose.moved(sent, TICK_S)
        if nearest_m <= MARGIN_M:
            assert fastest_mps(sent) <= AWAY_MPS + 1e-9
            assert (clearances(points, pose) >= np.minimum(before, nearest_m) - NEARER_M).all()
        else:
            assert BODY.nearest_m(seen_from(points, pose), MARGIN_M) > MARGIN_M - 0.005


def seen_from(
    points: list[tuple[float, float]], pose: Pose
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.array([Pose(x, y).relative_to(pose)[:2] for x, y in points])


def clearances(points: list[tuple[float, float]], pose: Pose) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return BODY.clearance_m(*seen_from(points, pose).T)
