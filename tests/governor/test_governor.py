"""Leases, the latch, the stop epoch and the verdicts of the governor."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.governor.governor import LONGEST_STEP_S, Governor
from chatrobot.governor.rule import Sensed
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import LaserScan

PROFILE = replace(load_profile("wheeltec_mini_mec"), lidar=None)
SLOW = Twist(0.3, 0.0, 0.0)


def governor_with_lease(term_s: float = 0.3) -> tuple[Governor, StopEpoch]:
    epoch = StopEpoch()
    governor = Governor(PROFILE, epoch)
    governor.leases.open("lease", "console", term_s, 0.0)
    governor.begin("lease", 0.0)
    return governor, epoch


def test_nothing_moves_without_a_lease() -> None:
    governor = Governor(PROFILE, StopEpoch())
    verdict = governor.govern(SLOW, "nobody's", 0.0)
    assert (verdict.action, verdict.rule) == ("refused", "lease_lapsed")
    assert verdict.sent.twist.is_zero


def test_a_lease_without_beats_ends_after_its_term_and_a_beat_revives_it() -> None:
    governor, _ = governor_with_lease()
    assert governor.govern(SLOW, "lease", 0.3).action != "refused"
    assert governor.govern(SLOW, "lease", 0.31).action == "refused"
    governor.leases.beat("lease", 0.4)
    governor.begin("lease", 0.4)
    assert governor.govern(SLOW, "lease", 0.4).action != "refused"


def test_a_beat_from_the_past_does_not_lengthen_a_lease() -> None:
    governor, _ = governor_with_lease()
    governor.leases.beat("lease", -5.0)
    assert governor.govern(SLOW, "lease", 0.31).action == "refused"


def test_an_ended_lease_cannot_be_beaten_back_to_life() -> None:
    governor, _ = governor_with_lease()
    governor.leases.end("lease")
    governor.leases.beat("lease", 0.1)
    assert governor.govern(SLOW, "lease", 0.1).action == "refused"


def test_the_first_tick_moves_at_once() -> None:
    governor, _ = governor_with_lease()
    sent = governor.govern(SLOW, "lease", 0.0).sent.twist
    assert sent.vx_mps == PROFILE.limits.acceleration_mps2 * TICK_S


def test_a_late_tick_buys_no_jump_in_velocity() -> None:
    governor, _ = governor_with_lease(term_s=10.0)
    first = governor.govern(SLOW, "lease", 0.0).sent.twist
    second = governor.govern(Twist(1.0, 0.0, 0.0), "lease", 5.0).sent.twist
    step = second.vx_mps - first.vx_mps
    assert step <= PROFILE.limits.acceleration_mps2 * LONGEST_STEP_S + 1e-9


def test_a_clock_that_goes_back_stops_the_robot_which_then_begins_at_zero() -> None:
    governor, _ = governor_with_lease(term_s=math.inf)
    first = governor.govern(SLOW, "lease", 1.0).sent.twist
    back = governor.govern(SLOW, "lease", 0.5)
    assert (back.rule, back.sent.twist) == ("clock_went_back", ZERO_TWIST)
    assert governor.govern(SLOW, "lease", 0.52).sent.twist == first


def test_an_emergency_stop_holds_until_it_is_released_and_says_who_set_it() -> None:
    governor, _ = governor_with_lease()
    governor.latch("console", "not-aus")
    assert governor.govern(SLOW, "lease", 0.0).rule == "emergency_stop"
    assert governor.latched is not None
    assert governor.latched.values["source"] == "console"
    assert governor.release("console")
    assert governor.govern(SLOW, "lease", 0.0).action == "limited"


def test_after_a_stop_ramps_begin_at_zero_again() -> None:
    governor, epoch = governor_with_lease(term_s=10.0)
    for tick in range(30):
        governor.govern(SLOW, "lease", tick * TICK_S)
    epoch.stop()
    assert governor.govern(SLOW, "lease", 30 * TICK_S).rule == "not_begun"
    governor.begin("lease", 30 * TICK_S)
    assert governor.govern(SLOW, "lease", 30 * TICK_S).sent.twist.vx_mps <= 0.02 + 1e-9


def test_what_was_limited_says_by_which_rule() -> None:
    governor, _ = governor_with_lease(term_s=10.0)
    assert governor.govern(Twist(99.0, 0.0, 0.0), "lease", 0.0).rule == "speed"
    assert governor.govern(SLOW, "lease", TICK_S).rule == "acceleration"
    assert governor.govern(Twist(math.nan, 0.0, 0.0), "lease", 2 * TICK_S).rule == "not_finite"
    assert governor.govern(ZERO_TWIST, "lease", 3 * TICK_S).action == "passed"


def test_rounding_is_no_limit_and_a_little_too_fast_is_one() -> None:
    governor, _ = governor_with_lease(term_s=10.0)
    for tick in range(60):
        governor.govern(Twist(1.0, 0.0, 0.0), "lease", tick * TICK_S)
    exact = governor.govern(Twist(1.0 + 1e-9, 0.0, 1e-12), "lease", 60 * TICK_S)
    assert exact.rule == "acceleration", "which is no news"
    assert governor.govern(Twist(1.00001, 0.0, 0.0), "lease", 61 * TICK_S).rule == "speed"


def test_a_pose_that_is_none_is_no_pose() -> None:
    robot = load_profile("wheeltec_mini_mec")
    governor = Governor(robot, StopEpoch(), area=((-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)))
    governor.leases.open("lease", "console", 0.3, 0.0)
    governor.begin("lease", 0.0)
    for bad in (Pose(math.nan, 0.0, 0.0), Pose(0.0, math.inf, 0.0), Pose(0.0, 0.0, -math.inf), None):
        verdict = governor.govern(SLOW, "lease", 0.0, bad)
        assert (verdict.rule, verdict.sent.twist.is_zero) == ("fence", True)


@pytest.mark.parametrize("now_s", [math.nan, math.inf, -math.inf])
def test_a_clock_that_shows_no_time_stops_the_robot(now_s: float) -> None:
    governor, _ = governor_with_lease(term_s=math.inf)
    governor.govern(SLOW, "lease", 1.0)
    for _ in range(3):
        assert governor.govern(Twist(1.0, 0.0, 0.0), "lease", now_s).sent.twist.vx_mps <= 0.02
    assert governor.govern(SLOW, "lease", 2.0).sent.twist.vx_mps <= 0.04


def test_a_scan_is_nothing_to_a_robot_without_a_lidar() -> None:
    governor, _ = governor_with_lease()
    governor.take_scan(LaserScan(0.0, -math.pi, 0.1, 0.1, 8.0, [0.2] * 63), ORIGIN)
    assert governor.govern(SLOW, "lease", 0.0, ORIGIN).rule == "acceleration"
    assert governor.seen_points.shape == (0, 2)


def test_it_tells_what_its_lidar_has_seen() -> None:
    governor = Governor(load_profile("wheeltec_mini_mec"), StopEpoch())
    assert governor.seen_points.shape == (0, 2)
    ranges = [math.inf] * 360
    ranges[180] = 2.0
    governor.take_scan(LaserScan(0.0, -math.pi, math.radians(1.0), 0.1, 8.0, ranges), Pose(1.0, 0.5, 0.0))
    assert governor.seen_points[0] == pytest.approx([1.0 + 0.032 + 2.0, 0.5])


@pytest.mark.parametrize("pose", [Pose(1e308, 0.0, 0.0), Pose(0.0, -2e6, 0.0), Pose(0.0, 0.0, math.nan)])
def test_a_pose_that_nobody_can_be_at_is_as_good_as_none(pose: Pose) -> None:
    """Else what the lidar saw would lie infinitely far away."""
    governor = Governor(load_profile("wheeltec_mini_mec"), StopEpoch())
    governor.leases.open("lease", "console", math.inf, 0.0)
    governor.begin("lease", 0.0)
    free = LaserScan(0.0, -math.pi, math.radians(1.0), 0.1, 8.0, [math.inf] * 360)
    governor.take_scan(free, ORIGIN)
    verdict = governor.govern(SLOW, "lease", 0.02, pose, Sensed({"scan": 0.0, "odom": 0.0}))
    assert verdict.rule == "blind"
    assert governor.govern(SLOW, "lease", 0.04, ORIGIN, Sensed({"scan": 0.0})).rule == "acceleration"
