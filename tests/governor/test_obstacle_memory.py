"""What the lidar saw, where it looks, and what it can no longer see but that is still there."""

from __future__ import annotations

import math

import pytest
from tests.governor.situations import MECANUM

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.governor.obstacle_memory import (
    FORGET_AFTER_M,
    NEAR_M,
    SCANS_KEPT,
    SEEN_THROUGH_M,
    ObstacleMemory,
)
from chatrobot.robots.profile import Lidar
from chatrobot.wire.messages import LaserScan

assert MECANUM.lidar is not None
MOUNTED = MECANUM.lidar
NEAREST_M, FARTHEST_M = 0.12, 8.0
PLAIN = Lidar(0.0, 0.0, 0.0, 360, NEAREST_M, FARTHEST_M, 10.0)
"""In the middle of the robot, looking ahead."""

DEGREE = math.radians(1.0)
NOTHING_M = math.inf


def around(sees: dict[int, float], elsewhere_m: float = NOTHING_M) -> LaserScan:
    """A scan all around, a beam a degree from -180 on; `sees` tells ranges by the beam's direction in degrees."""
    ranges = [elsewhere_m] * 360
    for direction_deg, range_m in sees.items():
        ranges[direction_deg + 180] = range_m
    return LaserScan(0.0, -math.pi, DEGREE, NEAREST_M, FARTHEST_M, ranges)


def sector(from_deg: float, beams: int, step_deg: float = 1.0, range_m: float = NOTHING_M) -> LaserScan:
    first, step = math.radians(from_deg), math.radians(step_deg)
    return LaserScan(0.0, first, step, NEAREST_M, FARTHEST_M, [range_m] * beams)


def seen_by(lidar: Lidar, *scans: LaserScan, pose: Pose = ORIGIN) -> ObstacleMemory:
    seen = ObstacleMemory(lidar)
    for scan in scans:
        seen.take(scan, pose)
    return seen


def points_of(seen: ObstacleMemory) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in seen.points]


# --- where a point is ---


def test_a_point_is_where_robot_mounting_and_beam_put_it() -> None:
    lidar = Lidar(0.1, 0.2, math.pi / 2, 360, NEAREST_M, FARTHEST_M, 10.0)
    seen = seen_by(lidar, around({-90: 1.0}), pose=Pose(5.0, -3.0, math.pi / 2))
    # The lidar is 0.1 m ahead and 0.2 m left of a robot that looks along +y, and the beam looks along the robot's x.
    assert points_of(seen) == [pytest.approx((5.0 - 0.2, -3.0 + 0.1 + 1.0))]


def test_two_beams_have_two_directions() -> None:
    assert sorted(points_of(seen_by(PLAIN, around({0: 2.0, 30: 1.0})))) == [
        pytest.approx((math.cos(30 * DEGREE), 0.5)),
        pytest.approx((2.0, 0.0)),
    ]


def test_beams_are_counted_from_the_first() -> None:
    seen = seen_by(PLAIN, sector(30.0, 2, 60.0, range_m=1.0))
    assert points_of(seen) == [
        pytest.approx((math.cos(math.radians(30.0)), 0.5)), pytest.approx((0.0, 1.0))
    ]  # fmt: skip


def test_one_beam_is_a_scan() -> None:
    assert points_of(seen_by(PLAIN, sector(0.0, 1, range_m=1.0))) == [pytest.approx((1.0, 0.0))]


@pytest.mark.parametrize(
    ("range_m", "counts"),
    [(NEAREST_M, True), (FARTHEST_M, True), (NEAREST_M - 1e-6, False), (FARTHEST_M + 1e-6, False)],
)
def test_what_is_out_of_range_is_no_point(range_m: float, counts: bool) -> None:
    assert bool(points_of(seen_by(PLAIN, around({0: range_m})))) is counts


def test_a_far_point_counts_for_three_scans() -> None:
    assert SCANS_KEPT == 3
    scans = [around({0: 2.0}), *[around({})] * 3]
    assert len(points_of(seen_by(PLAIN, *scans[:3]))) == 1
    assert points_of(seen_by(PLAIN, *scans)) == []


# --- a cheap lidar, that says zero for what is too near ---


@pytest.mark.parametrize(
    ("then", "is_still_there"), [(0.0, True), (math.nan, True), (-1.0, True), (math.inf, False), (3.0, False)]
)
def test_a_near_thing_that_a_cheap_lidar_no_longer_tells_of_is_still_there(
    then: float, is_still_there: bool
) -> None:
    """Zero, NaN (JSON's null, too) and nonsense tell nothing; infinity (REP-117) and a farther thing do."""
    seen = ObstacleMemory(MOUNTED)
    for stamp_s, ahead_m in enumerate((0.2, *[then] * 5)):
        ranges_m = [math.inf] * 360
        ranges_m[180] = ahead_m
        seen.take(LaserScan(float(stamp_s), -math.pi, math.radians(1.0), 0.12, 8.0, ranges_m), ORIGIN)
    near = [point for point in seen.points.tolist() if math.hypot(*point) < 1.0]
    assert bool(near) is is_still_there


def test_what_was_near_and_now_returns_zero_is_remembered_until_it_is_seen_through() -> None:
    lidar = Lidar(0.0, 0.0, 0.0, 4, 0.12, 8.0, 10.0)
    seen = ObstacleMemory(lidar)

    def scan(ahead_m: float) -> LaserScan:
        return LaserScan(0.0, -math.pi, math.pi / 2.0, 0.12, 8.0, [math.inf, math.inf, ahead_m, math.inf])

    seen.take(scan(0.2), ORIGIN)
    for step in range(1, 8):
        seen.take(scan(0.0), Pose(0.012 * step, 0.0, 0.0))
    assert len(seen.points) > 0
    assert seen.points[:, 0] == pytest.approx(0.2)
    for _ in range(4):
        seen.take(scan(3.0), Pose(0.1, 0.0, 0.0))
    assert min(seen.points[:, 0]) == pytest.approx(3.1)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_lidar_that_turns_clockwise_is_read_the_same_way(direction: float) -> None:
    seen = ObstacleMemory(MOUNTED)
    ranges = [math.inf] * 360
    ranges[90 if direction > 0.0 else 270] = 0.2  # to the right in both
    scan = LaserScan(0.0, -math.pi * direction, math.radians(direction), 0.12, 8.0, ranges)
    seen.take(scan, ORIGIN)
    seen.take(scan._replace(ranges_m=[0.0] * 360), ORIGIN)
    assert seen.points == pytest.approx(seen.points[0].reshape(1, 2).repeat(len(seen.points), axis=0))
    assert tuple(seen.points[0]) == pytest.approx((MOUNTED.x_m, -0.2), abs=1e-9)


@pytest.mark.parametrize(
    "broken",
    [
        LaserScan(0.0, -math.pi, 0.0, 0.1, 8.0, [1.0] * 360),
        LaserScan(0.0, -math.pi, math.nan, 0.1, 8.0, [1.0] * 360),
        LaserScan(0.0, math.inf, 0.1, 0.1, 8.0, [1.0] * 360),
        LaserScan(0.0, -math.pi, 0.1, 0.1, 8.0, []),
    ],
)
def test_a_scan_that_makes_no_sense_has_seen_nothing(broken: LaserScan) -> None:
    seen = ObstacleMemory(MOUNTED)
    seen.take(LaserScan(0.0, -math.pi, math.radians(1.0), 0.1, 8.0, [1.0] * 360), ORIGIN)
    assert seen.coverage.latest is not None
    seen.take(broken, ORIGIN)
    assert seen.coverage.latest is None


def kept_after(first: LaserScan, then: LaserScan, poses: tuple[Pose, Pose] = (ORIGIN, ORIGIN)) -> bool:
    """Whether what the first scan saw is still known when it has fallen out of the scans that count."""
    seen = ObstacleMemory(PLAIN)
    seen.take(first, poses[0])
    for _ in range(SCANS_KEPT + 1):
        seen.take(then, poses[1])
    return any(math.dist(point, points_of(seen_by(PLAIN, first))[0]) < 1e-6 for point in points_of(seen))


@pytest.mark.parametrize("more_m", [-0.001, 0.001])
def test_what_was_a_little_beyond_the_minimum_range_is_remembered_and_what_was_farther_is_not(
    more_m: float,
) -> None:
    assert kept_after(around({0: NEAREST_M + NEAR_M + more_m}), around({0: 0.0})) is (more_m < 0.0)


@pytest.mark.parametrize(("then_m", "kept"), [(3.0, False), (0.26, False), (0.151, False), (0.149, True)])
def test_its_beam_tells_anew_of_it_unless_something_nearer_is_in_between(then_m: float, kept: bool) -> None:
    assert SEEN_THROUGH_M == 0.1
    assert kept_after(around({0: 0.25}), around({0: then_m})) is kept


@pytest.mark.parametrize("more_m", [-0.001, 0.001])
@pytest.mark.parametrize("bearing_deg", [100, -100, 180])
def test_what_left_the_field_of_view_is_remembered_within_a_metre(bearing_deg: int, more_m: float) -> None:
    first = around({bearing_deg - 360 if bearing_deg == 180 else bearing_deg: FORGET_AFTER_M + more_m})
    assert kept_after(first, sector(-90.0, 181)) is (more_m < 0.0)
    assert not kept_after(first, around({})), "all around it looks there, and sees that it is gone"


def test_a_beam_looks_where_the_lidar_stands_now() -> None:
    """It turned left and went 5 cm and 10 cm: what was ahead is to the right now, and its own beam decides."""
    moved = Pose(0.05, 0.1, math.pi / 2)
    thing = around({27: math.hypot(0.2, 0.1)})  # at (0.2, 0.1), as far as a degree tells
    assert kept_after(thing, around({-89: 0.0}), (ORIGIN, moved))
    assert not kept_after(thing, around({-90: 2.0, -89: 2.0, -91: 2.0}, elsewhere_m=0.0), (ORIGIN, moved))
    assert kept_after(thing, around({0: 2.0, 27: 2.0, -63: 2.0}, elsewhere_m=0.0), (ORIGIN, moved))


def test_between_the_last_beam_and_the_first_the_first_decides_where_it_is_nearer() -> None:
    thing = LaserScan(0.0, math.radians(179.7), DEGREE, NEAREST_M, FARTHEST_M, [0.25])
    assert not kept_after(thing, around({-180: 2.0}, elsewhere_m=0.0))
    assert kept_after(thing, around({179: 2.0}, elsewhere_m=0.0))


def test_a_beam_beyond_the_last_looks_at_nothing() -> None:
    assert kept_after(around({91: 0.5}), sector(-90.0, 181))
    assert not kept_after(around({90: 0.5}), sector(-90.0, 181))


def test_the_nearest_beam_decides() -> None:
    thing = around({10: 0.2})
    coarse = sector(-180.0, 90, 4.0, range_m=0.0)
    for beam, gone in ((47, True), (48, False), (46, False)):  # 47 looks along 8 degrees
        ranges = [0.0] * 90
        ranges[beam] = 2.0
        shifted = coarse._replace(ranges_m=ranges, angle_min_rad=math.radians(-179.0))  # and 47 along 9
        assert kept_after(thing, shifted) is not gone


@pytest.mark.parametrize(
    "pose", [Pose(math.nan, 0.0, 0.0), Pose(0.0, math.inf, 0.0), Pose(0.0, 0.0, math.nan)]
)
def test_a_scan_from_nowhere_has_seen_nothing_and_takes_nothing_away(pose: Pose) -> None:
    seen = seen_by(PLAIN, around({0: 2.0}))
    seen.take(around({}), pose)
    assert seen.coverage.latest is None
    assert len(points_of(seen)) == 1


def test_a_look_is_from_where_the_lidar_is() -> None:
    lidar = Lidar(0.1, 0.2, 0.3, 360, NEAREST_M, FARTHEST_M, 10.0)
    seen = seen_by(lidar, sector(-20.0, 41, -2.0), pose=Pose(5.0, -3.0, math.pi / 2))
    look = seen.coverage.latest
    assert look is not None
    assert look.lidar == pytest.approx((5.0 - 0.2, -3.0 + 0.1, math.pi / 2 + 0.3))
    assert (look.first_rad, look.step_rad, look.beams) == (math.radians(-20.0), math.radians(-2.0), 41)


def test_before_its_first_scan_it_has_seen_nothing() -> None:
    assert points_of(ObstacleMemory(PLAIN)) == []
    assert ObstacleMemory(PLAIN).coverage.latest is None
