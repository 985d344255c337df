"""The safety suite that every robot profile and every source of commands inherits by being registered."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Twist
from chatrobot.governor.governor import LONGEST_STEP_S
from chatrobot.governor.lease import PRIORITIES, RELEASERS
from chatrobot.governor.rule import Sensed
from chatrobot.robots.load import list_profiles
from chatrobot.robots.profile import Circle, RobotProfile, Safety
from chatrobot.wire.messages import LaserScan, TwistMessage
from tests.safety.driven import EPSILON, FRESH, Driven

ENTRIES = list_profiles()
SOURCES = [*PRIORITIES, "one that nobody has heard of"]


@pytest.fixture(params=ENTRIES, ids=lambda entry: entry.name)
def profile(request: pytest.FixtureRequest) -> RobotProfile:
    loaded: RobotProfile = request.param.load()
    return loaded


@pytest.fixture(params=SOURCES)
def robot(profile: RobotProfile, request: pytest.FixtureRequest) -> Driven:
    return Driven(profile, request.param)


def test_nothing_moves_before_it_begins(robot: Driven) -> None:
    assert robot.ask(Twist(0.1, 0.0, 0.0)) == "not_begun"
    assert robot.stands


@pytest.mark.parametrize(("huge", "source"), [(2.0, "console"), (99.0, "agent"), (1e300, SOURCES[-1])])
def test_no_axis_and_no_combination_is_ever_above_the_profile(
    profile: RobotProfile, huge: float, source: str
) -> None:
    """Of every source a test below says the same of narrowed limits; `test_fuzz.py` mixes them."""
    robot = Driven(profile, source).begin()
    limits, before = robot.profile.limits, TwistMessage(0.0, 0.0, 0.0)
    for signs in (
        (1, 1, 1),
        (1, 0, 0),
        (-1, 0, 0),
        (0, 1, 0),
        (0, 0, -1),
        (-1, 1, -1),
        (1, -1, 0),
        (1, 0, 1),
    ):
        for _ in range(60):
            robot.ask(Twist(*(huge * sign for sign in signs)))
            vx, vy, wz = sent = robot.out[-1]
            assert math.hypot(vx, vy) <= limits.max_speed_mps + EPSILON
            assert abs(vy) <= limits.max_sideways_mps + EPSILON
            assert abs(wz) <= limits.max_rate_radps + EPSILON
            assert abs(wz) * limits.min_turning_radius_m <= abs(vx) + EPSILON
            if any(sent):
                gained = math.hypot(vx - before.vx_mps, vy - before.vy_mps)
                assert gained <= limits.acceleration_mps2 * TICK_S + EPSILON
                turned = abs(wz - before.wz_radps)
                assert turned <= limits.angular_acceleration_radps2 * TICK_S + EPSILON
            before = sent


def test_zero_comes_at_once_from_full_speed(robot: Driven) -> None:
    robot.begin().at_full_speed()
    assert robot.ask(ZERO_TWIST) == ""
    assert robot.stands


@pytest.mark.parametrize("axis", range(3))
def test_a_number_that_is_none_stops_the_robot(robot: Driven, axis: int) -> None:
    for bad in (math.nan, math.inf, -math.inf):
        robot.begin().at_full_speed()
        numbers = [0.1, 0.0, 0.0]
        numbers[axis] = bad
        assert robot.ask(Twist(*numbers)) == "not_finite"
        assert robot.stands


def test_a_stop_voids_what_was_minted_and_the_motion_has_to_begin_again(robot: Driven) -> None:
    robot.begin().at_full_speed()
    old = robot.governor.govern(Twist(0.1, 0.0, 0.0), "lease", robot.now_s, ORIGIN, FRESH).sent
    robot.halt()
    assert robot.stands
    assert not robot.transport.send(old)
    assert robot.ask(Twist(0.1, 0.0, 0.0)) == "not_begun"
    assert robot.stands
    robot.begin().ask(Twist(9.0, 0.0, 0.0))
    assert 0.0 < robot.out[-1].vx_mps <= robot.profile.limits.acceleration_mps2 * LONGEST_STEP_S + EPSILON


def test_an_emergency_stop_holds_whoever_asks_until_a_person_releases_it(robot: Driven) -> None:
    robot.begin().at_full_speed()
    robot.governor.latch("bystander", "smoke")
    assert robot.ask(Twist(0.1, 0.0, 0.0)) == "emergency_stop"
    assert robot.stands
    assert robot.governor.begin("lease", robot.now_s).refusal == robot.governor.latched
    assert robot.governor.release(robot.source) == (robot.source in RELEASERS)
    assert (robot.governor.latched is None) == (robot.source in RELEASERS)


def test_a_lease_that_ends_or_lapses_ends_the_motion(robot: Driven) -> None:
    robot.begin().at_full_speed()
    assert robot.ask(Twist(0.1, 0.0, 0.0), after_s=0.31, beats=False) == "lease_lapsed"
    assert robot.stands
    robot.governor.leases.beat("lease", robot.now_s)
    robot.begin().ask(Twist(0.1, 0.0, 0.0))
    robot.governor.leases.end("lease")
    assert robot.ask(Twist(0.1, 0.0, 0.0)) == "lease_lapsed"
    assert robot.stands


def test_a_clock_that_goes_back_stops_the_robot(robot: Driven) -> None:
    robot.begin().at_full_speed()
    assert robot.ask(Twist(0.1, 0.0, 0.0), after_s=-0.1) == "clock_went_back"
    assert robot.stands


def test_no_source_gets_more_than_the_narrowed_limits(robot: Driven) -> None:
    limits = robot.profile.limits
    robot.governor.narrow(0.5 * limits.max_speed_mps, 0.5 * limits.max_rate_radps)
    robot.governor.narrow(9.0 * limits.max_speed_mps, 9.0 * limits.max_rate_radps)
    robot.begin()
    for _ in range(200):
        assert robot.ask(Twist(limits.max_speed_mps, 0.0, 0.0)) == "narrowed"
    assert robot.out[-1].vx_mps == pytest.approx(0.5 * limits.max_speed_mps)


def test_a_wall_of_returns_is_not_driven_into(robot: Driven) -> None:
    if robot.profile.lidar is None:
        assert robot.profile.wiring.scan_topic is None
        return  # a robot that cannot see: its profile says so, and docs/safety.md
    robot.begin().at_full_speed()
    lidar = robot.profile.lidar
    ranges = [math.inf] * 360
    ranges[round(180.0 - math.degrees(lidar.yaw_rad)) % 360] = front_m(robot.profile) + 0.035 - lidar.x_m
    near = LaserScan(robot.now_s, -math.pi, math.radians(1.0), 0.05, 8.0, ranges)
    for _ in range(3):
        robot.governor.take_scan(near, ORIGIN)
    assert robot.ask(Twist(robot.profile.limits.max_speed_mps, 0.0, 0.0)) == "obstacle"
    assert robot.stands


def test_a_lidar_that_says_nothing_makes_it_slow(robot: Driven) -> None:
    robot.begin()
    for _ in range(200):
        robot.ask(Twist(robot.profile.limits.max_speed_mps, 0.0, 0.0), sensed=Sensed({"scan": 9.0}))
    if robot.profile.lidar is not None:
        assert robot.out[-1].vx_mps <= robot.profile.safety.blind_speed_mps + EPSILON


def front_m(profile: RobotProfile) -> float:
    return max(x for x, _ in profile.footprint)


def switched_on(profile: RobotProfile, rule: str) -> tuple[Safety, Sensed]:
    """A profile's safety that forbids to drive forwards by that rule, and what the sensors say."""
    if rule == "sensors":
        return Safety(requires=("odom",)), Sensed({"scan": 0.0})
    return Safety(fence=Circle(-100.0, 0.0, 100.0 + front_m(profile) + 0.0005)), FRESH


@pytest.mark.parametrize("rule", ["sensors", "fence"])
def test_a_rule_that_a_profile_switches_on_holds_for_every_source(profile: RobotProfile, rule: str) -> None:
    safety, sensed = switched_on(profile, rule)
    for source in SOURCES:
        robot = Driven(replace(profile, safety=safety), source).begin()
        assert robot.ask(Twist(0.1, 0.0, 0.0), sensed=sensed) == rule
        assert robot.stands


def test_a_profile_that_is_registered_is_in_this_suite() -> None:
    assert {entry.name for entry in ENTRIES} == {entry.name for entry in list_profiles()}
    assert len(ENTRIES) >= 8
