"""Where its lidar does not look, the robot goes at blind speed: the rule by itself."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from tests.governor.situations import MECANUM, at

from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE, Situation
from chatrobot.governor.space_rules import (
    LOOK_AHEAD_M,
    LOOK_AHEAD_S,
    OUTWARDS_M,
    OUTWARDS_MPS,
    SHARES,
    BlindRule,
    _outline,
)
from chatrobot.robots.profile import Lidar, Safety
from chatrobot.wire.messages import LaserScan

BLIND_MPS = 0.1
BOX = ((0.2, -0.1), (0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1))
RADIUS_M = math.hypot(0.2, 0.1)
LIDAR = Lidar(0.0, 0.0, 0.0, 360, 0.12, 8.0, 10.0)
ROBOT = replace(MECANUM, footprint=BOX, lidar=LIDAR, safety=Safety(blind_speed_mps=BLIND_MPS))
FRESH = at(scan=0.5)


def sector(from_deg: float, to_deg: float) -> LaserScan:
    """Beams between those directions, half a degree each, that see nothing."""
    beams = round((to_deg - from_deg) * 2.0) + 1
    return LaserScan(0.0, math.radians(from_deg), math.radians(0.5), 0.12, 8.0, [math.inf] * beams)


def rule_of(
    from_deg: float, to_deg: float, lidar: Lidar = LIDAR, before: LaserScan | None = None
) -> BlindRule:
    """Of a robot at the origin whose lidar looks between those directions, and looked as `before` a moment ago."""
    seen = ObstacleMemory(lidar)
    if before is not None:
        seen.take(before, ORIGIN)
    seen.take(sector(from_deg, to_deg), ORIGIN)
    return BlindRule(replace(ROBOT, lidar=lidar), seen)


def share(rule: BlindRule, asked: Twist, situation: Situation = FRESH) -> float:
    return rule.judge(asked, situation).factor


EVERYWHERE = sector(-180.0, 180.0)
ALL_AROUND = rule_of(-180.0, 180.0)
AHEAD = rule_of(-90.0, 90.0)


@pytest.mark.parametrize(
    "asked",
    [ZERO_TWIST, Twist(-BLIND_MPS, 0.0, 0.0), Twist(0.0, 0.0, BLIND_MPS / RADIUS_M), Twist(-0.06, 0.08, 0.0)],
)
def test_at_blind_speed_it_may_go_anywhere_without_a_look(asked: Twist) -> None:
    assert AHEAD.judge(asked, at(None)) is FREE


@pytest.mark.parametrize(
    ("asked", "fastest_mps"),
    [
        (Twist(-0.5, 0.0, 0.0), 0.5),
        (Twist(0.0, 0.0, 2.0), 2.0 * RADIUS_M),
        (Twist(0.0, 0.0, -2.0), 2.0 * RADIUS_M),
        (Twist(-0.3, 0.4, -1.0), 0.5 + RADIUS_M),
    ],
)
def test_no_point_of_it_goes_faster_than_blind_speed_where_nothing_looks(
    asked: Twist, fastest_mps: float
) -> None:
    ruling = AHEAD.judge(asked, FRESH)
    assert ruling.factor == pytest.approx(BLIND_MPS / fastest_mps)
    assert ruling.urgent
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("not_seen", {"speed_mps": BLIND_MPS})


@pytest.mark.parametrize(
    ("situation", "free"),
    [
        (at(scan=0.5), True),
        (at(scan=0.501), False),
        (at(scan=math.nan), False),
        (at(odom=0.1), False),
        (at(None, scan=0.1), False),
    ],
)
def test_a_look_counts_while_it_is_fresh_and_its_place_is_known(situation: Situation, free: bool) -> None:
    asked = Twist(0.5, 0.0, 0.0)
    assert (share(ALL_AROUND, asked, situation) == 1.0) is free
    assert (share(AHEAD, asked, situation) == 1.0) is free


def test_a_lidar_that_has_seen_nothing_yet_does_not_look() -> None:
    assert share(BlindRule(ROBOT, ObstacleMemory(LIDAR)), Twist(0.5, 0.0, 0.0)) < 1.0


@pytest.mark.parametrize(
    ("asked", "free"),
    [
        (Twist(0.5, 0.0, 0.0), True),
        (Twist(0.5, 0.0, 0.02), True),  # the tail swings, but hardly
        (Twist(0.5, 0.0, 0.3), True),  # a little, on a wide curve
        (Twist(0.4, 0.0, 1.5), False),  # now it swings
        (Twist(-0.5, 0.0, 0.0), False),
        (Twist(0.0, 0.5, 0.0), False),
        (Twist(0.5, 0.5, 0.0), False),  # its rear end passes what is beside it before it comes into view
        (Twist(0.0, 0.0, 1.0), False),
    ],
)
def test_what_looks_ahead_sees_the_way_ahead(asked: Twist, free: bool) -> None:
    assert (share(AHEAD, asked) == 1.0) is free
    mirrored = Twist(asked.vx_mps, -asked.vy_mps, -asked.wz_radps)
    assert (share(AHEAD, mirrored) == 1.0) is free
    assert share(ALL_AROUND, asked) == 1.0


def needed_deg(asked: Twist, before: LaserScan | None) -> float:
    """The narrowest field of view about the way ahead that is enough for it, to half a degree."""
    for half_deg in range(1, 360):
        if share(rule_of(-0.5 * half_deg, 0.5 * half_deg, before=before), asked) == 1.0:
            return 0.5 * half_deg
    raise AssertionError("nothing is")


@pytest.mark.parametrize("speed_mps", [0.11, 0.2, 0.399, 0.401, 0.8])
def test_ahead_it_must_look_half_a_second_and_at_least_twenty_centimetres_before_its_corners(
    speed_mps: float,
) -> None:
    reach_m = max(LOOK_AHEAD_M, LOOK_AHEAD_S * speed_mps)
    far = math.degrees(math.atan2(0.1, 0.2 + reach_m))
    assert needed_deg(Twist(speed_mps, 0.0, 0.0), EVERYWHERE) == pytest.approx(far, abs=0.5)
    # What lies before that it must have looked at, too: the nearest that counts is as far out as hardly counts.
    nearest_m = next(share for share in SHARES * reach_m if share > OUTWARDS_M)
    near = math.degrees(math.atan2(0.1, 0.2 + nearest_m))
    assert needed_deg(Twist(speed_mps, 0.0, 0.0), None) == pytest.approx(near, abs=0.5)


def test_a_look_from_elsewhere_a_moment_ago_counts_for_what_it_comes_by() -> None:
    """Narrow eyes saw the floor before its feet while it came: from half a metre back, or from where it turned."""
    ahead = Twist(0.4, 0.0, 0.0)
    for was_at, then, fine in (
        (Pose(-0.5, 0.0, 0.0), ORIGIN, True),
        (Pose(-0.1, 0.0, 0.0), ORIGIN, False),
        (Pose(-0.5, 0.0, math.pi), ORIGIN, False),
        (Pose(5.0, -3.5, math.pi / 2), Pose(5.0, -3.0, math.pi / 2), True),
        (Pose(5.0, -2.5, math.pi / 2), Pose(5.0, -3.0, math.pi / 2), False),
    ):
        seen = ObstacleMemory(LIDAR)
        for pose in (was_at, then):
            seen.take(sector(-15.0, 15.0), pose)
        assert (share(BlindRule(ROBOT, seen), ahead, Situation(then, FRESH.sensed)) == 1.0) is fine, was_at


def test_what_it_saw_a_moment_ago_is_not_enough_for_where_it_leads_to() -> None:
    assert share(rule_of(-90.0, 90.0, before=EVERYWHERE), Twist(-0.5, 0.0, 0.0)) < 1.0


def test_sideways_the_middle_of_its_side_is_looked_at_too() -> None:
    """Beams to the left that leave out one corner, or just what is beside the middle."""
    left = Twist(0.0, 0.4, 0.0)
    corner = math.degrees(math.atan2(0.3, 0.2))
    assert share(rule_of(corner - 1.0, 181.0 - corner, before=EVERYWHERE), left) == 1.0
    assert share(rule_of(corner + 1.0, 181.0 - corner, before=EVERYWHERE), left) < 1.0
    assert share(rule_of(corner - 1.0, 179.0 - corner, before=EVERYWHERE), left) < 1.0
    hole = rule_of(100.0, 440.0 - 1.0, before=EVERYWHERE)  # all around but for 80 to 100 degrees
    assert share(hole, left) < 1.0
    assert share(hole, Twist(0.0, -0.4, 0.0)) == 1.0


def test_where_the_lidar_is_mounted_counts() -> None:
    """From the front right corner it must look along that side, and over to the left one."""
    lidar, ahead = Lidar(0.2, -0.1, 0.0, 360, 0.12, 8.0, 10.0), Twist(0.4, 0.0, 0.0)
    assert share(rule_of(0.0, 46.0, lidar, EVERYWHERE), ahead) == 1.0
    assert share(rule_of(0.0, 44.0, lidar, EVERYWHERE), ahead) < 1.0
    assert share(rule_of(1.0, 46.0, lidar, EVERYWHERE), ahead) < 1.0


def test_a_turn_swings_each_corner_its_own_way() -> None:
    for x, y in BOX:
        ahead_s = max(LOOK_AHEAD_S, LOOK_AHEAD_M / RADIUS_M)
        for sign in (1.0, -1.0):
            end_deg = math.degrees(math.atan2(y + sign * x * ahead_s, x - sign * y * ahead_s))
            gap = rule_of(end_deg + 2.0, end_deg + 358.0, before=EVERYWHERE)
            assert share(gap, Twist(0.0, 0.0, sign)) < 1.0, (x, y, sign)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_side_that_hardly_comes_out_is_not_looked_for(sign: float) -> None:
    """Half a second ahead, the side may be three centimetres out; the rear end is still behind the lidar then."""
    far_back = replace(ROBOT, footprint=((0.2, -0.1), (0.2, 0.1), (-0.6, 0.1), (-0.6, -0.1)))
    rule = BlindRule(far_back, AHEAD._obstacle_memory)
    assert share(rule, Twist(0.5, sign * 0.0, 0.0)) == 1.0
    assert share(rule, Twist(0.5, sign * (OUTWARDS_M - 0.001) / LOOK_AHEAD_S, 0.0)) == 1.0
    assert share(rule, Twist(0.5, sign * (OUTWARDS_M + 0.001) / LOOK_AHEAD_S, 0.0)) < 1.0


@pytest.mark.parametrize(("out_mps", "free"), [(0.001, True), (0.019, True), (0.021, False)])
def test_a_side_that_hardly_moves_is_not_looked_for_however_far_that_would_lead(
    out_mps: float, free: bool
) -> None:
    """It turns about the middle of its left side, and nobody looks where that would drift to in ten seconds."""
    assert OUTWARDS_MPS == 0.02
    but_left = rule_of(95.0, 445.0, before=EVERYWHERE)
    assert (share(but_left, Twist(0.1, out_mps, 1.0)) == 1.0) is free


def test_the_outline_is_ends_and_middles_with_what_is_outwards() -> None:
    expected = {
        ((0.2, -0.1), (1.0, 0.0)), ((0.2, 0.0), (1.0, 0.0)), ((0.2, 0.1), (1.0, 0.0)),
        ((0.2, 0.1), (0.0, 1.0)), ((0.0, 0.1), (0.0, 1.0)), ((-0.2, 0.1), (0.0, 1.0)),
        ((-0.2, 0.1), (-1.0, 0.0)), ((-0.2, 0.0), (-1.0, 0.0)), ((-0.2, -0.1), (-1.0, 0.0)),
        ((-0.2, -0.1), (0.0, -1.0)), ((0.0, -0.1), (0.0, -1.0)), ((0.2, -0.1), (0.0, -1.0)),
    }  # fmt: skip
    assert {(point, normal) for point, normal in _outline(BOX)} == expected
    slanting = _outline(((0.4, 0.0), (0.0, 0.3), (-0.2, -0.3)))
    assert slanting[1] == (pytest.approx((0.2, 0.15)), pytest.approx((0.6, 0.8)))
    assert all(math.hypot(*normal) == pytest.approx(1.0) for _, normal in slanting)


def test_where_it_stands_makes_no_difference() -> None:
    pose = Pose(5.0, -3.0, 2.0)
    seen = ObstacleMemory(LIDAR)
    seen.take(sector(-90.0, 90.0), pose)
    there = Situation(pose, FRESH.sensed)
    assert share(BlindRule(ROBOT, seen), Twist(0.5, 0.0, 0.0), there) == 1.0
    assert share(BlindRule(ROBOT, seen), Twist(-0.5, 0.0, 0.0), there) == pytest.approx(0.2)
    # Half of what is around, from straight ahead to straight back over the left: only leftwards is seen.
    seen.take(EVERYWHERE, pose)
    seen.take(sector(0.0, 180.0), pose)
    assert share(BlindRule(ROBOT, seen), Twist(0.0, 0.5, 0.0), there) == 1.0
    assert share(BlindRule(ROBOT, seen), Twist(0.0, -0.5, 0.0), there) == pytest.approx(0.2)
