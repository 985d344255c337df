"""What every robot profile promises. A profile gets these tests by being found, built in or installed."""

from __future__ import annotations

import math
import pickle
from dataclasses import fields

import pytest

from chatrobot.robots.load import DEFAULT_PROFILE, ProfileEntry, list_profiles, load_profile
from chatrobot.robots.parse import OPTIONAL_LIMITS
from chatrobot.robots.profile import Limits, RobotProfile

ENTRIES = list_profiles()
BUILT_IN = {
    "generic_diff",
    "no_odometry",
    "originbot",
    "turtlebot3_burger",
    "turtlebot4",
    "turtlesim",
    "wheeltec_mini_akm",
    "wheeltec_mini_diff",
    "wheeltec_mini_mec",
}


@pytest.fixture(params=ENTRIES, ids=[entry.name for entry in ENTRIES])
def entry(request: pytest.FixtureRequest) -> ProfileEntry:
    found: ProfileEntry = request.param
    return found


@pytest.fixture
def profile(entry: ProfileEntry) -> RobotProfile:
    return entry.load()


def test_it_is_found_by_its_name(entry: ProfileEntry, profile: RobotProfile) -> None:
    assert profile.name == entry.name
    assert load_profile(entry.name) == profile
    assert load_profile(str(entry.file)) == profile


def test_every_limit_says_where_it_comes_from(profile: RobotProfile) -> None:
    given = {field.name for field in fields(Limits)} - OPTIONAL_LIMITS
    assert given <= profile.sources.keys()
    assert all(len(source) > 5 for source in profile.sources.values())


def test_what_is_meant_without_numbers_is_within_the_limits(profile: RobotProfile) -> None:
    assert 0 < profile.defaults.speed_mps <= profile.limits.max_speed_mps
    assert 0 < profile.defaults.rate_radps <= profile.limits.max_rate_radps
    assert profile.defaults.distance_m > 0
    assert 0 < profile.defaults.turn_rad <= 2 * math.pi


def test_it_can_brake_from_its_default_speed_within_half_a_metre(profile: RobotProfile) -> None:
    v, limits = profile.defaults.speed_mps, profile.limits
    assert v * limits.latency_s + v * v / (2 * limits.deceleration_mps2) < 0.5


def test_it_goes_only_where_its_wheels_can(profile: RobotProfile) -> None:
    assert profile.can_go_sideways == (profile.limits.max_sideways_mps > 0)
    assert profile.can_turn_on_the_spot == (profile.limits.min_turning_radius_m == 0)


def test_its_footprint_holds_its_centre(profile: RobotProfile) -> None:
    assert min(x for x, _ in profile.footprint) < 0 < max(x for x, _ in profile.footprint)
    assert min(y for _, y in profile.footprint) < 0 < max(y for _, y in profile.footprint)
    assert 0.05 < profile.footprint_radius_m < 5


def test_a_scanner_comes_with_a_topic_and_the_other_way_round(profile: RobotProfile) -> None:
    assert (profile.lidar is None) == (profile.wiring.scan_topic is None)


def test_a_person_approves_plans_unless_the_caller_decides_otherwise(profile: RobotProfile) -> None:
    assert profile.approval == "plan"


def test_it_can_be_handed_to_another_process(profile: RobotProfile) -> None:
    assert pickle.loads(pickle.dumps(profile)) == profile


def test_all_built_in_profiles_are_there() -> None:
    assert {entry.name for entry in ENTRIES if entry.origin == "built-in"} == BUILT_IN


def test_the_default_robot_is_the_simulated_mecanum_base() -> None:
    robot = load_profile(DEFAULT_PROFILE)
    assert robot.kinematics == "mecanum"
    assert (robot.defaults.speed_mps, robot.defaults.rate_radps) == (0.3, 0.6)
    assert (robot.defaults.distance_m, robot.defaults.turn_rad) == (0.5, math.pi / 2)
    assert (robot.limits.max_speed_mps, robot.limits.max_sideways_mps) == (1.0, 1.0)
    assert robot.limits.max_rate_radps == 2.0
    assert (robot.limits.acceleration_mps2, robot.limits.angular_acceleration_radps2) == (1.0, 2.0)
    assert robot.lidar is not None
    assert (robot.lidar.beams, robot.lidar.rate_hz) == (360, 10.0)
    assert (robot.lidar.min_range_m, robot.lidar.max_range_m) == (0.12, 8.0)
    wiring = robot.wiring
    topics = (
        wiring.cmd_vel_topic,
        wiring.odom_topic,
        wiring.imu_topic,
        wiring.scan_topic,
        wiring.bumper_topic,
    )
    assert topics == ("cmd_vel", "odom", "imu", "scan", "bumper")
    assert wiring.base_timeout_s is None


def test_the_turtle_goes_on_for_a_second_and_has_no_scanner() -> None:
    turtle = load_profile("turtlesim")
    assert turtle.wiring.base_timeout_s == 1.0
    assert turtle.wiring.cmd_vel_topic == "turtle1/cmd_vel"
    assert (turtle.wiring.odom_topic, turtle.wiring.odom_type) == ("turtle1/pose", "turtlesim/Pose")
    assert turtle.lidar is None
