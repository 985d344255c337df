"""What wheels make of commands, whatever the commands are."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sim_rig import with_kinematics

from chatrobot.core.geometry import Pose, Twist, displacement
from chatrobot.robots.profile import Kinematics
from chatrobot.sim.bases import Base

SPEEDS = st.floats(-2.0, 2.0)
TWISTS = st.builds(Twist, SPEEDS, SPEEDS, st.floats(-4.0, 4.0))
ANYTHING = st.builds(Twist, st.floats(), st.floats(), st.floats())
DURATIONS = st.floats(1e-4, 2.0)
KINEMATICS: list[Kinematics] = ["differential", "mecanum", "ackermann"]


def base(kinematics: Kinematics) -> Base:
    return Base(with_kinematics(kinematics, 0.4 if kinematics == "ackermann" else 0.0))


@given(st.sampled_from(KINEMATICS), st.lists(st.tuples(ANYTHING, DURATIONS), max_size=8))
def test_no_command_takes_a_base_beyond_its_hardware(
    kinematics: Kinematics, commands: list[tuple[Twist, float]]
) -> None:
    wheels = base(kinematics)
    for twist, duration_s in commands:
        before = wheels.wheel_twist
        wheels.command(twist)
        segments = wheels.step(duration_s)
        assert math.fsum(seconds for _, seconds in segments) == pytest.approx(duration_s)
        after = wheels.wheel_twist
        assert after.is_finite
        assert after.speed_mps <= 1.5 + 1e-9
        assert abs(after.wz_radps) <= 3.0 + 1e-9
        change_mps = math.hypot(after.vx_mps - before.vx_mps, after.vy_mps - before.vy_mps)
        assert change_mps <= 2.0 * duration_s + 1e-9
        for part, _ in (*segments, (after, 0.0)):
            if kinematics != "mecanum":
                assert part.vy_mps == 0.0
            if kinematics == "ackermann":
                assert abs(part.wz_radps) * 0.4 <= abs(part.vx_mps) + 1e-9


@given(st.sampled_from(KINEMATICS), TWISTS)
def test_a_command_that_is_held_is_reached_and_kept(kinematics: Kinematics, twist: Twist) -> None:
    wheels = base(kinematics)
    wheels.command(twist)
    wheels.step(10.0)
    reached = wheels.wheel_twist
    assert wheels.step(1.0) == [(reached, 1.0)]
    if kinematics == "mecanum" and twist.speed_mps <= 1.5 and abs(twist.wz_radps) <= 3.0:
        assert reached == twist


@given(TWISTS, TWISTS, st.integers(1, 20))
def test_cutting_a_step_into_pieces_changes_nothing(first: Twist, second: Twist, pieces: int) -> None:
    whole, cut = base("mecanum"), base("mecanum")
    for wheels in (whole, cut):
        wheels.command(first)
        wheels.step(0.7)
        wheels.command(second)
    path_whole = path(whole.step(1.0))
    path_cut = path([part for _ in range(pieces) for part in cut.step(1.0 / pieces)])
    assert cut.wheel_twist == pytest.approx(whole.wheel_twist, abs=1e-9)
    assert path_cut == pytest.approx(path_whole, abs=1e-9)


def path(segments: list[tuple[Twist, float]]) -> tuple[float, float, float]:
    """The velocities summed up over time, each for itself."""
    return (
        math.fsum(twist.vx_mps * seconds for twist, seconds in segments),
        math.fsum(twist.vy_mps * seconds for twist, seconds in segments),
        math.fsum(twist.wz_radps * seconds for twist, seconds in segments),
    )


@given(TWISTS, DURATIONS, DURATIONS)
def test_a_screw_in_two_pieces_is_the_screw_in_one(twist: Twist, first_s: float, second_s: float) -> None:
    whole = displacement(twist, first_s + second_s)
    assert displacement(twist, first_s).moved(twist, second_s) == pytest.approx(whole, abs=1e-9)


@given(TWISTS, DURATIONS)
def test_a_screw_run_backwards_returns(twist: Twist, duration_s: float) -> None:
    assert Pose().moved(twist, duration_s).moved(twist.scaled(-1.0), duration_s) == pytest.approx(
        Pose(), abs=1e-9
    )


@given(st.floats(0.05, 2.0), st.floats(0.05, 3.0))
def test_a_full_circle_closes(speed_mps: float, rate_radps: float) -> None:
    end = displacement(Twist(speed_mps, 0.0, rate_radps), math.tau / rate_radps)
    assert end == pytest.approx(Pose(0.0, 0.0, math.tau), abs=1e-9)


@given(TWISTS, DURATIONS)
def test_a_screw_is_what_many_small_steps_come_to(twist: Twist, duration_s: float) -> None:
    pose, steps = Pose(), 2000
    for _ in range(steps):  # midpoint rule: second order in the step
        middle = pose.yaw_rad + 0.5 * twist.wz_radps * duration_s / steps
        cos, sin = math.cos(middle), math.sin(middle)
        pose = Pose(
            pose.x_m + (cos * twist.vx_mps - sin * twist.vy_mps) * duration_s / steps,
            pose.y_m + (sin * twist.vx_mps + cos * twist.vy_mps) * duration_s / steps,
            pose.yaw_rad + twist.wz_radps * duration_s / steps,
        )
    assert displacement(twist, duration_s) == pytest.approx(pose, abs=1e-5)


def test_wheels_that_stall_stand_and_push_on() -> None:
    wheels = base("mecanum")
    wheels.command(Twist(0.5))
    wheels.step(1.0)
    wheels.stall()
    assert wheels.wheel_twist.is_zero
    assert not wheels.is_standing
    wheels.step(1.0)
    assert wheels.wheel_twist == Twist(0.5)


def test_tiny_differences_of_velocity_come_to_an_end() -> None:
    wheels = base("mecanum")
    for tiny in (5e-324, 1e-300, 1e-30, 0.0):
        wheels.command(Twist(tiny, -tiny, tiny))
        assert math.fsum(seconds for _, seconds in wheels.step(0.01)) == pytest.approx(0.01)
