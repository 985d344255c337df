"""A simulated robot lies as it is told to, and always the same way for a seed."""

from __future__ import annotations

import contextlib
import math
import statistics

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sim_rig import Rig, world_of

from chatrobot.core.errors import UsageError
from chatrobot.sim.fault_injection import (
    GYRO_BIAS_RADPS,
    GYRO_NOISE_RADPS,
    LIDAR_NOISE_M,
    ODOM_JUMP_M,
    FaultInjection,
)
from chatrobot.sim.shapes import rectangle


def test_nothing_said_is_an_honest_robot() -> None:
    assert FaultInjection.parse("") == FaultInjection()
    assert FaultInjection().bias_radps == 0.0


def test_all_keys_are_read() -> None:
    assert FaultInjection.parse(
        "slip=0.03, latency_s=0.05,noise=on,seed=1,gyro_bias_radps=-0.002,dropout=0.1,one_wheel_slip=0.2,"
        "stuck_after_m=0.5,blocked=stall,odom_silent_after_s=3,odom_jump_after_s=4,odom_wrong=reversed"
    ) == FaultInjection(
        slip=0.03,
        latency_s=0.05,
        noise=True,
        seed=1,
        gyro_bias_radps=-0.002,
        dropout=0.1,
        one_wheel_slip=0.2,
        stuck_after_m=0.5,
        blocked="stall",
        odom_silent_after_s=3.0,
        odom_jump_after_s=4.0,
        odom_wrong="reversed",
    )


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("slipp=0.1", ("slipp", "slip", "latency_s", "seed")),
        ("slip=much", ("slip", "much", "share")),
        ("slip=1.5", ("slip", "1.5", "-0.5 to 1")),
        ("slip=nan", ("slip", "nan")),
        ("slip", ("slip", "no value")),
        ("noise=yes", ("noise", "yes", "on or off")),
        ("seed=1.5", ("seed", "whole number")),
        ("latency_s=-1", ("latency_s", "-1")),
        ("blocked=maybe", ("blocked", "spin or stall")),
        ("odom_wrong=slightly", ("odom_wrong", "reversed")),
        ("slip=0.1,slip=0.2", ("slip", "twice")),
    ],
)
def test_what_cannot_be_read_names_the_key_and_what_is_allowed(text: str, named: tuple[str, ...]) -> None:
    with pytest.raises(UsageError) as caught:
        FaultInjection.parse(text)
    for word in named:
        assert word in str(caught.value)


@given(st.text())
def test_any_text_is_read_or_refused(text: str) -> None:
    with contextlib.suppress(UsageError):
        FaultInjection.parse(text)


def test_encoders_overstate_by_the_slip() -> None:
    rig = Rig("slip=0.03")
    rig.command(0.4, 0.0, 0.5)
    rig.run(1.0)
    rig.command()
    rig.run(1.0)
    turned_rad = rig.odometry[-1].yaw_rad
    assert rig.robot.true_pose.yaw_rad == pytest.approx(0.97 * turned_rad)
    straight = Rig("slip=0.03")
    straight.command(0.4)
    straight.run(3.0)
    assert straight.robot.true_pose.x_m == pytest.approx(0.97 * straight.odometry[-1].x_m)


def test_the_gyro_sees_through_slipping_wheels() -> None:
    rig = Rig("slip=0.1")
    rig.command(wz_radps=1.0)
    rig.run(2.0)
    assert rig.gyro[-1].wz_radps == pytest.approx(0.9)
    assert rig.odometry[-1].wz_radps == pytest.approx(1.0)


def test_one_slipping_wheel_makes_it_veer_though_odometry_goes_straight() -> None:
    rig = Rig("one_wheel_slip=0.03")
    rig.command(0.5)
    rig.run(4.0)
    assert rig.odometry[-1].yaw_rad == 0.0
    wheel_path_m = rig.odometry[-1].x_m
    assert rig.robot.true_pose.yaw_rad == pytest.approx(0.03 * wheel_path_m / 0.2)
    assert rig.robot.true_pose.x_m < wheel_path_m


def test_late_messages_bear_the_time_they_were_measured() -> None:
    rig = Rig("latency_s=0.05")
    rig.run(1.0)
    assert [round(heard - o.stamp_s, 9) for heard, o in zip(rig.heard_at_s, rig.odometry)] == [0.05] * 95
    assert len(rig.gyro) == 95
    assert len(rig.truth) == 50


def test_a_latency_between_two_ticks_is_kept_to_the_millisecond() -> None:
    rig = Rig("latency_s=0.013")
    rig.run(0.2)
    assert {round(heard - o.stamp_s, 9) for heard, o in zip(rig.heard_at_s, rig.odometry)} == {0.013}


def run_of(faults: str) -> tuple[object, ...]:
    rig = Rig(faults, world_of(rectangle(6.0, 0.0, 0.2, 8.0)))
    rig.tour()
    return rig.odometry, rig.gyro, rig.scans, rig.truth


def test_the_same_seed_is_the_same_run() -> None:
    faults = "slip=0.03,latency_s=0.05,noise=on,dropout=0.2,seed=7"
    assert run_of(faults) == run_of(faults)


def test_another_seed_is_another_run() -> None:
    runs = [run_of(f"noise=on,dropout=0.2,seed={seed}") for seed in (1, 2)]
    for one, other in zip(runs[0][:3], runs[1][:3]):
        assert one != other


def test_noise_is_unbiased_but_for_the_gyro() -> None:
    rig = Rig("noise=on,seed=3")
    rig.command(0.5)
    rig.run(10.0)
    assert rig.odometry[-1].x_m == pytest.approx(rig.robot.true_pose.x_m, abs=0.005)
    assert rig.odometry[-1].x_m != rig.robot.true_pose.x_m
    bias_radps = statistics.fmean(sample.wz_radps for sample in rig.gyro)
    assert bias_radps == pytest.approx(FaultInjection.parse("noise=on,seed=3").bias_radps, abs=2e-4)
    assert statistics.stdev(s.wz_radps for s in rig.gyro) == pytest.approx(GYRO_NOISE_RADPS, rel=0.1)


def test_a_robot_that_stands_reports_that_it_stands_though_encoders_are_noisy() -> None:
    rig = Rig("noise=on")
    rig.run(2.0)
    assert {sample[1:] for sample in rig.odometry} == {(0.0,) * 6}


@given(st.integers())
def test_the_bias_of_a_noisy_gyro_is_small_and_its_own_for_each_seed(seed: int) -> None:
    faults = FaultInjection(noise=True, seed=seed)
    assert abs(faults.bias_radps) <= GYRO_BIAS_RADPS
    assert faults.bias_radps == FaultInjection(noise=True, seed=seed).bias_radps


def test_gyros_of_different_seeds_have_different_biases() -> None:
    assert len({FaultInjection(noise=True, seed=seed).bias_radps for seed in range(20)}) == 20


def test_a_bias_that_is_given_holds_without_noise() -> None:
    rig = Rig("gyro_bias_radps=0.02")
    rig.run(0.1)
    assert {sample.wz_radps for sample in rig.gyro} == {0.02}


def test_lidar_noise_is_as_large_as_stated() -> None:
    rig = Rig("noise=on", world_of(rectangle(3.0, 0.0, 0.2, 0.6)))
    rig.run(20.0)
    ahead = [scan.ranges_m[180] for scan in rig.scans]
    assert statistics.fmean(ahead) == pytest.approx(2.9, abs=0.005)
    assert statistics.stdev(ahead) == pytest.approx(LIDAR_NOISE_M, rel=0.2)


def test_lost_messages_are_the_share_that_was_asked_for() -> None:
    rig = Rig("dropout=0.3")
    rig.run(20.0)
    assert len(rig.odometry) == pytest.approx(1400, abs=80)
    assert len(rig.gyro) == 2000


def test_a_stuck_robot_goes_no_further_while_its_wheels_turn() -> None:
    rig = Rig("stuck_after_m=0.5")
    rig.command(0.5)
    rig.run(4.0)
    assert rig.robot.true_pose.x_m == pytest.approx(0.5, abs=1e-9)
    assert rig.robot.true_twist.is_zero
    assert rig.odometry[-1].x_m > 1.8
    rig.command(0.0, 0.0, 1.0)
    rig.run(1.0)
    assert rig.robot.true_pose.yaw_rad == 0.0


def test_a_stuck_robot_whose_wheels_stall_says_that_it_stands() -> None:
    rig = Rig("stuck_after_m=0.5,blocked=stall")
    rig.command(0.5)
    rig.run(4.0)
    assert rig.robot.true_pose.x_m == pytest.approx(0.5, abs=1e-9)
    assert rig.odometry[-1].x_m == pytest.approx(0.5, abs=1e-9)
    assert rig.odometry[-1].vx_mps == 0.0


def test_odometry_falls_silent_and_the_rest_goes_on() -> None:
    rig = Rig("odom_silent_after_s=1")
    rig.command(0.5)
    rig.run(2.0)
    assert rig.odometry[-1].stamp_s < 1.0
    assert rig.gyro[-1].stamp_s == pytest.approx(2.0)
    assert rig.robot.true_twist.vx_mps == 0.5


def test_odometry_jumps_once() -> None:
    rig = Rig("odom_jump_after_s=0.5")
    rig.run(1.0)
    assert {sample.y_m for sample in rig.odometry} == {0.0, ODOM_JUMP_M}
    assert rig.odometry[-1].y_m == ODOM_JUMP_M
    assert rig.robot.true_pose.y_m == 0.0


@pytest.mark.parametrize(
    ("wrong", "x_sign", "yaw_sign"), [("right", 1, 1), ("reversed", -1, 1), ("turn_reversed", 1, -1)]
)
def test_odometry_with_the_wrong_sign(wrong: str, x_sign: int, yaw_sign: int) -> None:
    rig = Rig(f"odom_wrong={wrong}")
    rig.command(0.5)
    rig.run(1.0)
    assert math.copysign(1.0, rig.odometry[-1].x_m) == x_sign
    assert math.copysign(1.0, rig.odometry[-1].vx_mps) == x_sign
    rig.command(wz_radps=0.5)
    rig.run(1.0)
    assert math.copysign(1.0, rig.odometry[-1].yaw_rad) == yaw_sign


def test_odometry_that_is_frozen_or_no_number() -> None:
    frozen, nan = Rig("odom_wrong=frozen"), Rig("odom_wrong=nan")
    for rig in (frozen, nan):
        rig.command(0.5)
        rig.run(1.0)
        assert rig.robot.true_pose.x_m > 0.3
        assert rig.odometry[-1].stamp_s == pytest.approx(1.0)
    assert frozen.odometry[-1][1:] == (0.0,) * 6
    assert all(math.isnan(value) for value in nan.odometry[-1][1:])
