"""Every robot profile keeps the contract: a profile gets these tests by being found, built in or installed."""

from __future__ import annotations

import math

import pytest

from chatrobot.robots.load import DEFAULT_PROFILE, ProfileEntry, list_profiles, load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.testing.contracts import ProfileContract

ENTRIES = list_profiles()


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
class TestEveryProfile(ProfileContract):
    @pytest.fixture
    def profile(self, entry: ProfileEntry) -> RobotProfile:
        return entry.load()

    def test_it_is_found_by_its_name(self, entry: ProfileEntry, profile: RobotProfile) -> None:
        assert profile.name == entry.name
        assert load_profile(entry.name) == profile
        assert load_profile(str(entry.file)) == profile


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
