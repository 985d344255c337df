"""Where the lidar looks now, and where it looked a moment ago."""

from __future__ import annotations

import math

import numpy as np
import pytest

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.governor.obstacle_memory import (
    APART_M,
    APART_RAD,
    SCANS_VALID,
    VIEWS_KEPT,
    Floats,
    LidarView,
    ScanCoverage,
)

DEGREE = math.radians(1.0)


def look(from_deg: float, beams: int, step_deg: float = 1.0, lidar: Pose = ORIGIN) -> LidarView:
    return LidarView(lidar, math.radians(from_deg), math.radians(step_deg), beams)


def towards(direction_deg: float, lidar: Pose = ORIGIN) -> Floats:
    """A point two metres away in that direction of `odom`."""
    direction = math.radians(direction_deg)
    return np.array([[lidar.x_m + 2.0 * math.cos(direction), lidar.y_m + 2.0 * math.sin(direction)]])


@pytest.mark.parametrize(
    ("beams", "all_around"), [(361, True), (360, True), (358, True), (357, False), (180, False), (1, False)]
)
@pytest.mark.parametrize("turns", [1.0, -1.0])
def test_all_around_has_no_gap_wider_than_two_beams(beams: int, all_around: bool, turns: float) -> None:
    step_deg = turns * 1.0000001  # what it adds up to is no round number
    assert look(-180.0 * turns, beams, step_deg).is_all_around is all_around


def test_all_around_is_every_direction() -> None:
    around = look(-180.0, 358)
    assert all(around.covers(towards(direction)).all() for direction in range(-180, 540, 5))


@pytest.mark.parametrize("lidar", [ORIGIN, Pose(3.0, -2.0, 0.5), Pose(-1.0, 4.0, -2.5)])
@pytest.mark.parametrize("turns", [1.0, -1.0])
def test_a_look_covers_what_lies_between_its_first_beam_and_its_last(lidar: Pose, turns: float) -> None:
    from_20_to_40 = look(-20.0 * turns, 61, turns, lidar)
    ahead_deg = math.degrees(lidar.yaw_rad)
    for direction_deg, coverage in [
        (-19.9, 1),
        (0.0, 1),
        (39.9, 1),
        (-20.2, 0),
        (40.2, 0),
        (180.0, 0),
        (-90, 0),
    ]:
        point = towards(direction_deg * turns + ahead_deg, lidar)
        assert from_20_to_40.covers(point).tolist() == [bool(coverage)], direction_deg


def test_each_point_is_judged_by_itself() -> None:
    points = np.concatenate([towards(0.0), towards(90.0), towards(10.0)])
    assert look(-20.0, 61).covers(points).tolist() == [True, False, True]
    assert look(-180.0, 360).covers(points).tolist() == [True, True, True]
    assert repr(ScanCoverage().covers_now(points).tolist()) == "[False, False, False]"
    assert repr(ScanCoverage().covered_lately(points).tolist()) == "[False, False, False]"


AHEAD = towards(0.0)


def noted(*all_looks: LidarView) -> ScanCoverage:
    coverage = ScanCoverage()
    for one in all_looks:
        coverage.note(one)
    return coverage


def test_now_is_the_latest_look_and_lately_is_the_earlier_ones_too() -> None:
    coverage = noted(look(-30.0, 61), look(60.0, 61, lidar=Pose(-1.0)))
    assert coverage.latest is not None
    assert coverage.latest.lidar == Pose(-1.0)
    assert not coverage.covers_now(AHEAD).any()
    assert coverage.covered_lately(AHEAD).all()
    beside = towards(90.0, Pose(-1.0))
    assert coverage.covers_now(beside).all()
    assert coverage.covered_lately(beside).all()
    assert coverage.covered_lately(np.concatenate([AHEAD, towards(-90.0)])).tolist() == [True, False]
    assert coverage.covered_lately(np.concatenate([AHEAD, beside])).tolist() == [True, True]


@pytest.mark.parametrize(
    ("by", "kept"),
    [
        (Pose(APART_M), True),
        (Pose(0.0, -APART_M), True),
        (Pose(0.9 * APART_M), False),
        (Pose(0.0, 0.0, APART_RAD), True),
        (Pose(0.0, 0.0, -APART_RAD), True),
        (Pose(0.0, 0.0, 0.9 * APART_RAD), False),
        (Pose(0.0, 0.0, 2.0 * math.pi - 0.9 * APART_RAD), False),
    ],
)
def test_a_look_is_kept_where_it_is_from_elsewhere(by: Pose, kept: bool) -> None:
    """The second look sees ahead; the first and the last don't."""
    away = look(60.0, 61)
    ahead = LidarView(by, -0.5 - by.yaw_rad, 0.1, 11)
    coverage = noted(away, ahead, LidarView(Pose(-9.0), 2.0, 0.1, 5))
    assert coverage.covered_lately(AHEAD).all() == kept


def test_turned_means_turned_from_there() -> None:
    """Whichever way it looks: this one looked away, hardly turned, and saw what lies ahead by the way."""
    away = LidarView(Pose(0.0, 0.0, 2.0), 0.0, 0.1, 5)
    ahead = LidarView(Pose(0.0, 0.0, 2.0 + 0.5 * APART_RAD), -2.3, 0.1, 11)
    assert not noted(away, ahead, LidarView(Pose(-9.0), 2.0, 0.1, 5)).covered_lately(AHEAD).any()


def test_creeping_counts_from_the_look_that_was_kept() -> None:
    steps = [LidarView(Pose(0.4 * APART_M * step), -0.5, 0.1, 11 if step == 3 else 1) for step in range(5)]
    coverage = noted(*steps)
    assert not coverage.covers_now(towards(5.0)).any()
    assert coverage.covered_lately(towards(5.0)).all()


def test_an_earlier_look_counts_for_so_many_scans() -> None:
    away = look(60.0, 61, lidar=Pose(-1.0))
    assert noted(look(-30.0, 61), *[away] * (SCANS_VALID - 1)).covered_lately(AHEAD).all()
    assert not noted(look(-30.0, 61), *[away] * SCANS_VALID).covered_lately(AHEAD).any()


def test_a_robot_that_stands_still_remembers_what_it_looks_at() -> None:
    coverage = noted(*[look(-30.0, 61)] * (SCANS_VALID + 3), look(60.0, 61, lidar=Pose(-1.0)))
    assert coverage.covered_lately(AHEAD).all()


def test_only_so_many_looks_are_kept() -> None:
    def elsewhere(count: int) -> list[LidarView]:
        return [look(60.0, 1, lidar=Pose(-1.0 - step)) for step in range(count)]

    assert noted(look(-30.0, 61), *elsewhere(VIEWS_KEPT - 1)).covered_lately(AHEAD).all()
    assert not noted(look(-30.0, 61), *elsewhere(VIEWS_KEPT)).covered_lately(AHEAD).any()


def test_what_is_forgotten_was_never_looked_at() -> None:
    coverage = noted(look(-30.0, 61), look(-30.0, 61, lidar=Pose(1.0)))
    coverage.forget()
    assert coverage.latest is None
    assert not coverage.covered_lately(AHEAD).any()
    coverage.note(look(60.0, 61))
    assert not coverage.covered_lately(AHEAD).any()
