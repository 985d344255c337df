"""The governor's arithmetic holds every profile to its numbers, whatever is asked."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.governor.kernel import bounded, make_kernel
from chatrobot.robots.load import list_profiles
from chatrobot.robots.profile import RobotProfile

PROFILES = [entry.load() for entry in list_profiles()]
EPSILON = 1e-9

anything = st.floats(allow_nan=True, allow_infinity=True)
twists = st.builds(Twist, anything, anything, anything)
profiles = st.sampled_from(PROFILES)


def assert_within_speed(profile: RobotProfile, twist: Twist) -> None:
    limits = profile.limits
    assert twist.is_finite
    assert twist.speed_mps <= limits.max_speed_mps + EPSILON
    assert abs(twist.vy_mps) <= limits.max_sideways_mps + EPSILON
    assert abs(twist.wz_radps) <= limits.max_rate_radps + EPSILON
    if profile.kinematics == "differential":
        assert twist.vy_mps == 0.0
    if profile.kinematics == "ackermann":
        assert abs(twist.wz_radps) * limits.min_turning_radius_m <= abs(twist.vx_mps) + EPSILON


@given(profiles, st.lists(st.tuples(twists, st.floats(0.0, 0.04)), max_size=60))
def test_whatever_is_asked_speeds_and_accelerations_stay_within_the_profile(
    profile: RobotProfile, requests: list[tuple[Twist, float]]
) -> None:
    kernel = make_kernel(profile)
    sent = ZERO_TWIST
    for asked, dt_s in requests:
        before, sent = sent, kernel(sent, asked, dt_s)
        assert_within_speed(profile, sent)
        if sent.is_zero:
            continue  # zero is exempt: a stop is never slowed down
        change = math.hypot(sent.vx_mps - before.vx_mps, sent.vy_mps - before.vy_mps)
        assert change <= profile.limits.acceleration_mps2 * dt_s + EPSILON
        turn_change = abs(sent.wz_radps - before.wz_radps)
        assert turn_change <= profile.limits.angular_acceleration_radps2 * dt_s + EPSILON


@given(profiles, twists, st.floats(0.0, 1.0))
def test_asking_for_zero_yields_zero_at_once(profile: RobotProfile, before: Twist, dt_s: float) -> None:
    assert make_kernel(profile)(bounded(profile, before), ZERO_TWIST, dt_s).is_zero


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("axis", range(3))
def test_a_number_that_is_none_is_a_zero(bad: float, axis: int) -> None:
    asked = [0.1, 0.0, 0.1]
    asked[axis] = bad
    assert bounded(PROFILES[0], Twist(*asked)).is_zero


def test_a_twist_beyond_the_limits_keeps_its_direction() -> None:
    mecanum = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_mec")
    sent = bounded(mecanum, Twist(99.0, 49.5, 9.9))
    assert sent.speed_mps == pytest.approx(mecanum.limits.max_speed_mps)
    assert sent.vy_mps / sent.vx_mps == pytest.approx(0.5)
    assert sent.wz_radps / sent.vx_mps == pytest.approx(0.1)


def test_linear_and_angular_ramps_are_synchronised() -> None:
    mecanum = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_mec")
    kernel, asked, sent = make_kernel(mecanum), Twist(0.4, 0.0, 0.8), ZERO_TWIST
    for _ in range(40):
        sent = kernel(sent, asked, 0.02)
        assert sent.wz_radps / sent.vx_mps == pytest.approx(2.0)
    assert sent == asked


def test_an_ackermann_base_never_gets_a_spin() -> None:
    car = next(profile for profile in PROFILES if profile.kinematics == "ackermann")
    assert bounded(car, Twist(0.0, 0.0, 1.0)).is_zero


def test_the_ramp_of_an_ackermann_base_from_forward_to_backward_leads_through_standing() -> None:
    car = next(profile for profile in PROFILES if profile.kinematics == "ackermann")
    kernel = make_kernel(car)
    sent = Twist(0.2, 0.0, 0.2)
    seen = []
    for _ in range(60):
        sent = kernel(sent, Twist(-0.2, 0.0, 0.2), 0.02)
        assert_within_speed(car, sent)
        seen.append(sent)
    assert seen[-1] == pytest.approx(Twist(-0.2, 0.0, 0.2))
    assert min(twist.speed_mps for twist in seen) < 0.02


def test_a_base_that_is_slower_sideways_keeps_its_direction_too() -> None:
    mecanum = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_mec")
    slow = replace(mecanum, limits=replace(mecanum.limits, max_sideways_mps=0.2))
    assert bounded(slow, Twist(0.4, 0.4, 0.2)) == pytest.approx(Twist(0.2, 0.2, 0.1))
    assert bounded(slow, Twist(0.4, -0.2, 0.2)) == Twist(0.4, -0.2, 0.2)
    assert bounded(slow, Twist(9.0, 0.1, 0.0)).speed_mps == pytest.approx(1.0)


def with_wheels(profile: RobotProfile) -> RobotProfile:
    """Its wheels roll no faster than straight ahead or turning alone make them."""
    limits = profile.limits
    reach_m = limits.max_speed_mps / limits.max_rate_radps
    wheels = replace(limits, max_wheel_speed_mps=limits.max_speed_mps, wheel_reach_m=reach_m)
    return replace(profile, limits=wheels)


@given(st.sampled_from([with_wheels(profile) for profile in PROFILES]), st.lists(twists, max_size=30))
def test_no_wheel_rolls_faster_than_it_may_whatever_is_asked_together(
    profile: RobotProfile, requests: list[Twist]
) -> None:
    kernel, sent = make_kernel(profile), ZERO_TWIST
    for asked in requests:
        sent = kernel(sent, asked, 0.02)
        assert_within_speed(profile, sent)
        assert profile.limits.wheel_speed_mps(*sent) <= profile.limits.max_wheel_speed_mps + EPSILON


def test_driving_and_turning_together_share_what_the_wheels_can_do() -> None:
    robot = with_wheels(next(profile for profile in PROFILES if profile.name == "wheeltec_mini_diff"))
    assert bounded(robot, Twist(0.6, 0.0, 1.5)) == pytest.approx(Twist(0.3, 0.0, 0.75))
    assert bounded(robot, Twist(0.6, 0.0, 0.0)) == Twist(0.6, 0.0, 0.0)
    assert bounded(robot, Twist(0.0, 0.0, -1.5)) == Twist(0.0, 0.0, -1.5)


@pytest.mark.parametrize("ahead", [0.4, -0.4])
def test_a_base_that_brakes_more_weakly_than_it_gains_gets_the_weaker_ramp_down(ahead: float) -> None:
    robot = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_diff")
    limits = robot.limits
    assert limits.deceleration_mps2 < limits.acceleration_mps2
    kernel, sign = make_kernel(robot), math.copysign(1.0, ahead)
    slower = kernel(Twist(ahead, 0.0, 0.0), Twist(0.5 * ahead, 0.0, 0.0), 0.02)
    assert ahead - slower.vx_mps == pytest.approx(sign * limits.deceleration_mps2 * 0.02)
    faster = kernel(Twist(0.5 * ahead, 0.0, 0.0), Twist(ahead, 0.0, 0.0), 0.02)
    assert faster.vx_mps - 0.5 * ahead == pytest.approx(sign * limits.acceleration_mps2 * 0.02)
    back = kernel(Twist(ahead, 0.0, 0.0), Twist(-ahead, 0.0, 0.0), 0.02)
    assert ahead - back.vx_mps == pytest.approx(sign * limits.deceleration_mps2 * 0.02)


def test_braking_sideways_is_braking_and_setting_out_is_not() -> None:
    mecanum = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_mec")
    weak = replace(mecanum, limits=replace(mecanum.limits, acceleration_mps2=1.0, deceleration_mps2=0.5))
    kernel = make_kernel(weak)
    assert kernel(Twist(0.0, 0.5, 0.0), Twist(0.0, 0.1, 0.0), 0.02).vy_mps == pytest.approx(0.49)
    assert kernel(ZERO_TWIST, Twist(0.0, 0.5, 0.0), 0.02).vy_mps == pytest.approx(0.02)
    assert kernel(Twist(0.3, 0.0, 0.0), Twist(0.3, 0.5, 0.0), 0.02).vy_mps == pytest.approx(0.02)


def test_a_wheel_limit_gives_nothing_back_that_another_took() -> None:
    mecanum = next(profile for profile in PROFILES if profile.name == "wheeltec_mini_mec")
    limits = replace(mecanum.limits, max_speed_mps=0.5, max_wheel_speed_mps=1.2)
    assert bounded(replace(mecanum, limits=limits), Twist(2.0, 0.0, 0.0)) == Twist(0.5, 0.0, 0.0)
