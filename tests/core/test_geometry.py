"""Planar geometry keeps its conventions."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose, Twist, displacement, wrap_angle

metres = st.floats(-100.0, 100.0)
angles = st.floats(-20.0, 20.0)
poses = st.builds(Pose, metres, metres, angles)
twists = st.builds(Twist, st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))


@given(angles)
def test_a_wrapped_angle_is_the_same_heading_within_half_a_turn(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


@given(poses, poses)
def test_relative_to_undoes_compose(origin: Pose, other: Pose) -> None:
    assert origin.compose(other).relative_to(origin) == pytest.approx(other, abs=1e-6)


@given(twists, st.floats(0.0, 5.0))
def test_a_screw_motion_is_the_limit_of_small_steps(twist: Twist, duration_s: float) -> None:
    steps = 2000
    pose = ORIGIN
    for _ in range(steps):
        half = pose.yaw_rad + twist.wz_radps * duration_s / steps / 2.0
        cos, sin, dt = math.cos(half), math.sin(half), duration_s / steps
        pose = Pose(
            pose.x_m + (cos * twist.vx_mps - sin * twist.vy_mps) * dt,
            pose.y_m + (sin * twist.vx_mps + cos * twist.vy_mps) * dt,
            pose.yaw_rad + twist.wz_radps * dt,
        )
    assert displacement(twist, duration_s) == pytest.approx(pose, abs=1e-4)


def test_two_full_turns_left_are_four_pi() -> None:
    assert ORIGIN.moved(Twist(0.0, 0.0, 1.0), 4.0 * math.pi).yaw_rad == pytest.approx(4.0 * math.pi)
