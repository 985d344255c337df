"""The simulated robot moves as its base would and says what its sensors would."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest
from sim_rig import PROFILE, Rig, with_kinematics

from chatrobot.core.geometry import Pose


def test_it_begins_at_the_origin_and_stays_there_unasked() -> None:
    rig = Rig()
    rig.run(1.0)
    assert rig.robot.true_pose == Pose()
    assert rig.odometry[-1][1:] == (0.0,) * 6


def test_it_holds_its_last_command_for_ever() -> None:
    rig = Rig()
    rig.command(0.5)
    rig.run(60.0)
    assert rig.robot.true_pose.x_m > 29.5
    assert rig.robot.true_twist == (0.5, 0.0, 0.0)


def test_a_base_with_a_timeout_stops_by_itself() -> None:
    wiring = replace(PROFILE.wiring, base_timeout_s=0.3)
    rig = Rig(profile=replace(PROFILE, wiring=wiring))
    rig.command(1.0)
    rig.run(0.3)
    assert rig.robot.true_twist.vx_mps == pytest.approx(0.6)
    rig.run(1.0)
    assert rig.robot.true_twist.is_zero
    assert rig.robot.true_pose.x_m < 0.2


def test_each_command_winds_the_timeout_up_again() -> None:
    wiring = replace(PROFILE.wiring, base_timeout_s=0.3)
    rig = Rig(profile=replace(PROFILE, wiring=wiring))
    for _ in range(10):
        rig.command(0.5)
        rig.run(0.2)
    assert rig.robot.true_twist.vx_mps == 0.5


def test_truth_is_not_wrapped_and_odometry_is() -> None:
    rig = Rig()
    rig.command(wz_radps=2.0)
    rig.run(4.0)
    assert rig.robot.true_pose.yaw_rad > math.tau
    assert rig.truth[-1].yaw_rad == rig.robot.true_pose.yaw_rad
    assert abs(rig.odometry[-1].yaw_rad) <= math.pi
    assert math.cos(rig.odometry[-1].yaw_rad - rig.robot.true_pose.yaw_rad) == pytest.approx(1.0)


def test_honest_odometry_is_the_truth() -> None:
    rig = Rig()
    rig.tour()
    x, y, yaw = rig.robot.true_pose
    assert rig.odometry[-1][1:3] == pytest.approx((x, y))
    assert math.remainder(rig.odometry[-1].yaw_rad - yaw, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_sensors_keep_their_rates() -> None:
    rig = Rig()
    rig.run(2.0)
    assert (len(rig.odometry), len(rig.gyro), len(rig.truth), len(rig.scans)) == (200, 200, 100, 20)


@pytest.mark.parametrize("step_s", [0.001, 0.004, 0.01, 0.02, 0.05])
def test_the_length_of_a_step_changes_nothing(step_s: float) -> None:
    rig, other = Rig(), Rig()
    for each, step in ((rig, step_s), (other, 0.01)):
        each.command(0.5, 0.1, 0.8)
        each.run(2.0, step)
    assert rig.robot.true_pose == pytest.approx(other.robot.true_pose, abs=1e-4)
    assert [o.stamp_s for o in rig.odometry] == pytest.approx([o.stamp_s for o in other.odometry])


def test_stamps_are_of_its_clock() -> None:
    rig = Rig(start_s=1234.5)
    rig.run(0.1)
    assert rig.odometry[0].stamp_s == pytest.approx(1234.51)
    assert rig.odometry[-1].stamp_s == pytest.approx(rig.clock.now_s())


def test_the_gyro_sums_up_to_the_angle_turned() -> None:
    rig = Rig()
    rig.command(wz_radps=1.3)
    rig.run(2.0)
    assert sum(sample.wz_radps * 0.01 for sample in rig.gyro) == pytest.approx(rig.robot.true_pose.yaw_rad)


def test_a_mecanum_base_goes_sideways() -> None:
    rig = Rig()
    rig.command(vy_mps=0.3)
    rig.run(2.0)
    assert rig.robot.true_pose.y_m == pytest.approx(0.3 * 2.0 - 0.3**2 / (2 * 2.0))
    assert rig.robot.true_pose.x_m == 0.0


def test_a_differential_base_ignores_sideways() -> None:
    rig = Rig(profile=with_kinematics("differential"))
    rig.command(0.2, 0.3, 0.0)
    rig.run(2.0)
    assert rig.robot.true_pose.y_m == 0.0
    assert rig.odometry[-1].vy_mps == 0.0
    assert rig.robot.true_pose.x_m > 0.3


def test_an_ackermann_base_can_neither_spin_nor_go_sideways() -> None:
    rig = Rig(profile=with_kinematics("ackermann", turning_radius_m=0.5))
    rig.command(0.0, 0.3, 1.0)
    rig.run(2.0)
    assert rig.robot.true_pose == Pose()


@pytest.mark.parametrize("speed_mps", [0.4, -0.4])
def test_an_ackermann_base_turns_no_tighter_than_it_can(speed_mps: float) -> None:
    rig = Rig(profile=with_kinematics("ackermann", turning_radius_m=0.5))
    rig.command(speed_mps, 0.0, 2.0)
    rig.run(3.0)
    for sample in rig.truth:
        assert abs(sample.wz_radps) * 0.5 <= abs(sample.vx_mps) + 1e-9
    assert rig.robot.true_twist.wz_radps == pytest.approx(0.8)


def test_the_hardware_does_a_little_more_than_the_limits_but_not_anything() -> None:
    rig = Rig()
    rig.command(99.0, 0.0, 99.0)
    rig.run(5.0)
    assert rig.robot.true_twist == (1.5, 0.0, 3.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_command_that_is_no_number_is_not_obeyed(bad: float) -> None:
    rig = Rig()
    rig.command(0.3)
    rig.run(1.0)
    rig.command(bad, 0.0, 0.0)
    rig.run(1.0)
    assert rig.robot.true_twist == (0.3, 0.0, 0.0)


def test_it_brakes_at_least_as_hard_as_its_profile_says() -> None:
    rig = Rig()
    rig.command(1.0)
    rig.run(2.0)
    x_m = rig.robot.true_pose.x_m
    rig.command()
    rig.run(1.0)
    assert rig.robot.true_twist.is_zero
    assert rig.robot.true_pose.x_m - x_m <= 1.0**2 / (2 * 2.0) + 1e-9


def test_a_velocity_held_and_dropped_leads_as_far_as_velocity_times_time() -> None:
    profile = replace(PROFILE, limits=replace(PROFILE.limits, deceleration_mps2=1.5))
    rig = Rig(profile=profile)
    rig.command(0.3)
    rig.run(2.0)
    rig.command()
    rig.run(1.0)
    assert rig.robot.true_pose.x_m == pytest.approx(0.6)


def test_a_sleep_of_the_machine_moves_nothing() -> None:
    rig = Rig("latency_s=0.05")
    rig.command(0.5)
    rig.run(1.0)
    pose = rig.robot.true_pose
    rig.robot.skip(3600.0)
    assert rig.robot.true_pose == pose
    rig.run(0.1)
    assert rig.robot.true_pose.x_m == pytest.approx(pose.x_m + 0.05)
    assert rig.odometry[-1].stamp_s == pytest.approx(3601.05)


def test_a_sleep_of_the_machine_does_not_use_up_a_command() -> None:
    rig = Rig(profile=replace(PROFILE, wiring=replace(PROFILE.wiring, base_timeout_s=0.3)))
    rig.command(0.5)
    rig.run(0.29)
    rig.robot.skip(10.0)
    rig.run(0.005, 0.005)
    assert rig.robot.true_twist.vx_mps == 0.5
    rig.run(1.0)
    assert rig.robot.true_twist.is_zero


def test_time_that_passes_in_one_piece_still_gives_every_message() -> None:
    rig = Rig()
    rig.command(0.5)
    rig.robot.step(0.4)
    assert [round(o.stamp_s, 6) for o in rig.odometry] == [round(0.01 * i, 6) for i in range(1, 41)]


def test_a_mission_of_21_s_costs_next_to_nothing() -> None:
    taken_s = []
    for _ in range(3):
        rig = Rig()
        rig.command(0.3, 0.0, 0.2)
        start_s = time.process_time()
        rig.run(21.0)
        taken_s.append(time.process_time() - start_s)
    assert min(taken_s) < 0.06
