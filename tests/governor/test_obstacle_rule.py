"""The obstacle rule by itself: points in `odom`, a pose, a twist, a factor."""

from __future__ import annotations

import math

import pytest
from tests.governor.situations import MECANUM, at

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.governor.governor import Governor, StopEpoch
from chatrobot.governor.kernel import Braking
from chatrobot.governor.obstacle_memory import ObstacleMemory
from chatrobot.governor.rule import FREE
from chatrobot.governor.space_rules import MARGIN_M, RELEASE_M, ObstacleRule
from chatrobot.wire.messages import LaserScan

AHEAD = Twist(1.0, 0.0, 0.0)
FRONT_M = 0.135
assert MECANUM.lidar is not None
LIDAR = MECANUM.lidar


def scan_of(*points: tuple[float, float]) -> LaserScan:
    """A scan, made at the origin, that sees just these points (to a degree)."""
    ranges = [math.inf] * 360
    for x, y in points:
        away = (x - LIDAR.x_m, y - LIDAR.y_m)
        ranges[round(math.degrees(math.atan2(away[1], away[0])) + 180.0) % 360] = math.hypot(*away)
    return LaserScan(0.0, -math.pi, math.radians(1.0), 0.12, 8.0, ranges)


def rule_that_saw(*points: tuple[float, float]) -> ObstacleRule:
    seen = ObstacleMemory(LIDAR)
    seen.take(scan_of(*points), ORIGIN)
    return ObstacleRule(MECANUM, seen)


def test_it_brakes_for_the_way_that_is_left() -> None:
    ruling = rule_that_saw((0.6, 0.0)).judge(AHEAD, at())
    way_m = 0.6 - FRONT_M - MARGIN_M
    assert ruling.factor == pytest.approx(Braking(MECANUM.limits, AHEAD).factor_within(way_m), abs=0.005)
    assert ruling.urgent
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values["distance_m"]) == (
        "obstacle_ahead",
        pytest.approx(way_m, abs=0.01),
    )
    half = rule_that_saw((0.3, 0.0)).judge(Twist(0.5, 0.0, 0.0), at())
    assert half.reason is not None
    assert half.reason.values["distance_m"] == pytest.approx(0.135, abs=0.011)
    assert half.reason.values["distance_m"] == round(float(half.reason.values["distance_m"]), 2)
    slanting = rule_that_saw((0.4, 0.3)).judge(AHEAD, at(Pose(0.0, 0.0, math.atan2(0.3, 0.4))))
    assert slanting.factor == pytest.approx(rule_that_saw((0.5, 0.0)).judge(AHEAD, at()).factor, abs=0.02)
    assert rule_that_saw((0.4, 0.3)).judge(AHEAD, at(Pose(0.0, 0.0, -0.64))).factor == 1.0


def test_the_pose_is_minded_place_and_heading() -> None:
    rule = rule_that_saw((0.6, 0.0))
    straight = rule.judge(AHEAD, at()).factor
    assert rule.judge(AHEAD, at(Pose(0.3, 0.0, 0.0))).factor < straight
    assert rule.judge(AHEAD, at(Pose(0.6, -0.6, math.pi / 2))).factor == pytest.approx(straight, abs=0.01)
    assert rule.judge(AHEAD, at(Pose(0.0, 0.0, math.pi / 2))).factor == 1.0
    assert rule.judge(AHEAD, at(Pose(1.2, 0.0, math.pi))).factor == pytest.approx(straight, abs=0.01)
    assert rule.judge(AHEAD, at(Pose(0.0, 0.5, 0.0))).factor == 1.0


def test_nothing_seen_no_pose_and_no_motion_are_free() -> None:
    assert rule_that_saw().judge(AHEAD, at()).factor == 1.0
    assert rule_that_saw((0.2, 0.0)).judge(AHEAD, at(None)).factor == 1.0
    assert rule_that_saw((0.2, 0.0)).judge(ZERO_TWIST, at()).factor == 1.0
    assert ObstacleRule(MECANUM, ObstacleMemory(LIDAR)).judge(AHEAD, at()) is FREE
    assert rule_that_saw((7.0, 0.0)).judge(AHEAD, at()) is FREE


def test_a_way_that_was_barred_must_be_a_little_freer_before_it_opens() -> None:
    rule = rule_that_saw((FRONT_M + MARGIN_M + 0.0005, 0.0))
    slow = Twist(0.3, 0.0, 0.0)
    assert rule.judge(slow, at()).factor == 0.0
    back = Pose(-0.5 * RELEASE_M, 0.0, 0.0)
    fresh = rule_that_saw((FRONT_M + MARGIN_M + 0.0005, 0.0))
    assert fresh.judge(slow, at(back)).factor > 0.0
    assert rule.judge(slow, at(back)).factor == 0.0
    assert rule.judge(slow, at(Pose(-1.5 * RELEASE_M, 0.0, 0.0))).factor > 0.0
    assert rule.judge(slow, at(back)).factor > 0.0, "it is no longer barred"


def test_a_wall_that_appears_too_near_for_the_ramp_is_met_with_zero_at_once() -> None:
    governor = Governor(MECANUM, StopEpoch())
    governor.leases.open("lease", "console", math.inf, 0.0)
    governor.begin("lease", 0.0)
    sensed = at(ORIGIN, scan=0.1).sensed
    governor.take_scan(scan_of(), ORIGIN)
    for tick in range(60):
        verdict = governor.govern(AHEAD, "lease", tick * TICK_S, ORIGIN, sensed)
    assert verdict.sent.twist.vx_mps == pytest.approx(1.0)
    governor.take_scan(scan_of((0.3, 0.0)), ORIGIN)
    late = governor.govern(AHEAD, "lease", 60 * TICK_S, ORIGIN, sensed)
    assert (late.rule, late.action, late.sent.twist) == ("obstacle", "limited", ZERO_TWIST)
    assert 0.0 < late.allowed.vx_mps < 0.6
    onwards = governor.govern(AHEAD, "lease", 61 * TICK_S, ORIGIN, sensed)
    assert 0.0 < onwards.sent.twist.vx_mps <= 0.02 + 1e-9
