"""A plan that is driven faster or slower keeps its path: only when the robot is where changes."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from chatrobot.core.geometry import Pose, Twist
from chatrobot.plan.speed_scaling import SpeedScaling, speed_scaling
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.plan.trajectory import RampedTwist, Segment
from chatrobot.robots.load import load_profile

PROFILE = load_profile("turtlebot3_burger")
LIMITS = PROFILE.limits
START = Pose(1.0, 2.0, 0.5)
TWISTS = st.one_of(
    st.builds(Twist, st.floats(0.02, 0.2), st.just(0.0), st.floats(-1.0, 1.0)),
    st.builds(Twist, st.just(0.0), st.just(0.0), st.floats(0.1, 2.0)),
)
FACTORS = st.floats(0.05, 5.0)
SHARES = st.floats(0.0, 1.0)


def a_segment(twist: Twist, hold_s: float, *, is_timed: bool = False) -> Segment:
    return Segment(RampedTwist.within(LIMITS, twist, hold_s, is_timed=is_timed), START)


def by(factor: float) -> SpeedScaling:
    return SpeedScaling(factor, factor)


@given(TWISTS, st.floats(0.1, 30.0), FACTORS, FACTORS, SHARES, SHARES)
def test_a_motion_that_changes_its_speed_twice_ends_where_it_would_have_ended(
    twist: Twist, hold_s: float, first: float, second: float, share: float, later: float
) -> None:
    planned = a_segment(twist, hold_s)
    changed_s = share * planned.total_s
    once = by(first).segment(planned, changed_s, LIMITS)
    again_s = changed_s + later * (once.total_s - changed_s)
    twice = by(second).segment(once, again_s, LIMITS)
    for segment in (once, twice):
        assert segment.end_pose.distance_to(planned.end_pose) < 1e-6
        assert segment.at(segment.total_s)[1].is_zero
    for at_s in (0.25 * changed_s, changed_s):
        pose, velocity = planned.at(at_s)
        assert twice.at(at_s)[0].distance_to(pose) < 1e-9, "what has been driven stays"
        assert twice.at(at_s)[1].vx_mps == pytest.approx(velocity.vx_mps, abs=1e-9)


@given(TWISTS, st.floats(0.1, 30.0), FACTORS, SHARES)
def test_a_change_of_speed_keeps_to_the_limits(
    twist: Twist, hold_s: float, factor: float, share: float
) -> None:
    planned = a_segment(twist, hold_s)
    segment = by(factor).segment(planned, share * planned.total_s, LIMITS)
    step_s, slack = 0.01, 1.0 + 1e-6
    before = segment.at(0.0)[1]
    for tick in range(1, int(min(segment.total_s, 60.0) / step_s) + 2):
        now = segment.at(tick * step_s)[1]
        assert now.speed_mps <= LIMITS.max_speed_mps * slack
        assert abs(now.wz_radps) <= LIMITS.max_rate_radps * slack
        assert abs(now.vx_mps - before.vx_mps) <= LIMITS.acceleration_mps2 * step_s * slack
        assert abs(now.wz_radps - before.wz_radps) <= LIMITS.angular_acceleration_radps2 * step_s * slack
        before = now


@given(TWISTS, st.floats(0.5, 30.0), FACTORS, SHARES, SHARES)
def test_time_and_progress_are_each_others_inverse(
    twist: Twist, hold_s: float, factor: float, share: float, at: float
) -> None:
    planned = a_segment(twist, hold_s)
    ramp = by(factor).segment(planned, share * planned.total_s, LIMITS).ramp
    s = at * ramp.hold_s
    assert ramp.at(ramp.time_at(s))[0] == pytest.approx(s, abs=1e-6)


@given(TWISTS, st.floats(1.0, 30.0), FACTORS, SHARES, SHARES)
def test_it_brakes_on_its_path_whenever_it_is_told_to(
    twist: Twist, hold_s: float, factor: float, share: float, at: float
) -> None:
    planned = a_segment(twist, hold_s)
    changed = by(factor).segment(planned, share * planned.total_s, LIMITS)
    at_s = at * changed.total_s
    braked = changed.stop_early(at_s)
    assert braked.total_s <= changed.total_s + 1e-9
    assert braked.ramp.hold_s <= changed.ramp.hold_s + 1e-9
    assert braked.at(at_s)[0].distance_to(changed.at(at_s)[0]) < 1e-9


@given(st.floats(0.05, 0.95), SHARES)
def test_a_motion_of_a_given_time_lasts_as_long_when_it_becomes_slower(factor: float, share: float) -> None:
    planned = a_segment(Twist(0.1, 0.0, 0.0), 6.0, is_timed=True)
    changed_s = share * planned.total_s
    assume(changed_s < planned.ramp.down_start_s)
    segment = by(factor).segment(planned, changed_s, LIMITS)
    assert segment.total_s == pytest.approx(planned.total_s, abs=2.0 / planned.motion.ramp_per_s)
    assert segment.end_pose.distance_to(START) <= planned.end_pose.distance_to(START) + 1e-9


def test_no_factor_lifts_a_limit() -> None:
    motion = by(50.0).motion(RampedTwist.within(LIMITS, Twist(0.1, 0.0, 0.0), 10.0), LIMITS)
    assert motion.twist.vx_mps == pytest.approx(LIMITS.max_speed_mps)
    assert motion.twist.vx_mps * motion.hold_s == pytest.approx(1.0)


PLAN = parse_plan(
    "drive 2 m\nrepeat 2\nturn left 90 deg\narc left 90 deg radius 0.5 m\nend\ngo to 1 1 at 0.05 m/s"
)


def test_the_plan_of_another_speed_says_so_in_every_step() -> None:
    slower = SpeedScaling(linear_factor=0.5, angular_factor=0.5).plan(PLAN, PROFILE)
    assert speed_scaling(PLAN, slower, PROFILE) == SpeedScaling(0.5, 0.5)
    assert "go to 1 1 at 0.025 m/s" in format_plan(slower)
    faster = SpeedScaling(linear_factor=100.0).plan(PLAN, PROFILE)
    fastest = [step.speed_mps for step in faster.steps if hasattr(step, "speed_mps")]
    assert fastest == [LIMITS.max_speed_mps] * 2


def test_plans_that_differ_in_more_than_speeds_are_not_scaled() -> None:
    for text in ("drive 3 m", "drive 2 m\nturn left 90 deg", "turn left 90 deg", "drive back 2 m"):
        assert speed_scaling(parse_plan("drive 2 m"), parse_plan(text), PROFILE) is None
    assert math.isclose(by(2.0).times(by(0.5)).linear_factor, 1.0)
