"""Walls stop the robot, not its wheels."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sim_rig import PROFILE, Rig, world_of

from chatrobot.core.geometry import Pose, Twist
from chatrobot.sim.contact import CONTACT_M
from chatrobot.sim.edges import Edges, Footprint
from chatrobot.sim.shapes import Circle, polygon, rectangle

FRONT_M = 0.15
SIDE_M = 0.1


@pytest.mark.parametrize(
    "shape",
    [
        rectangle(1.1, 0.0, 0.2, 4.0),
        rectangle(1.0 + 0.05, 0.0, 4.0, 0.1, math.pi / 2),
        Circle(1.5, 0.0, 0.5),
        polygon(((1.0, -0.3), (1.0, 0.3), (2.0, 0.0))),
    ],
    ids=["wall", "turned wall", "circle", "triangle"],
)
def test_it_stops_where_its_front_touches(shape: object) -> None:
    rig = Rig(world=world_of(shape))  # type: ignore[arg-type]
    rig.command(0.5)
    rig.run(5.0)
    assert rig.robot.true_pose.x_m == pytest.approx(1.0 - FRONT_M, abs=2 * CONTACT_M)
    assert rig.robot.true_pose.x_m < 1.0 - FRONT_M + 1e-9
    assert rig.robot.true_twist.is_zero
    assert rig.robot.in_contact


def test_its_wheels_spin_on() -> None:
    rig = Rig(world=world_of(rectangle(1.1, 0.0, 0.2, 4.0)))
    rig.command(0.5)
    rig.run(5.0)
    assert rig.odometry[-1].x_m > 2.2
    assert rig.odometry[-1].vx_mps == 0.5
    assert rig.gyro[-1].wz_radps == 0.0


def test_wheels_that_stall_say_where_it_really_is() -> None:
    rig = Rig("blocked=stall", world_of(rectangle(1.1, 0.0, 0.2, 4.0)))
    rig.command(0.5)
    rig.run(5.0)
    assert rig.odometry[-1].x_m == pytest.approx(rig.robot.true_pose.x_m, abs=1e-6)
    assert rig.odometry[-1].vx_mps == 0.0


def test_the_bumper_tells_when_it_hits_and_when_it_comes_free() -> None:
    rig = Rig(world=world_of(rectangle(1.1, 0.0, 0.2, 4.0)))
    rig.command(0.5)
    rig.run(3.0)
    assert rig.bumps == [True]
    rig.command()
    rig.run(1.0)
    assert rig.bumps == [True]
    rig.command(-0.5)
    rig.run(1.0)
    assert rig.bumps == [True, False]
    assert rig.robot.true_pose.x_m < 0.6


def test_it_can_turn_away_only_as_far_as_its_corners_allow() -> None:
    rig = Rig(world=world_of(rectangle(0.0, SIDE_M + 0.02 + 0.5, 4.0, 1.0)))
    rig.command(wz_radps=0.5)
    rig.run(4.0)
    corner = math.atan2(SIDE_M, FRONT_M)
    blocked_at = math.asin((SIDE_M + 0.02) / math.hypot(FRONT_M, SIDE_M)) - corner
    assert rig.robot.true_pose.yaw_rad == pytest.approx(blocked_at, abs=0.002)
    assert rig.robot.in_contact


def test_a_wall_that_appears_stops_it_and_one_that_disappears_lets_it_go() -> None:
    rig = Rig()
    rig.command(0.5)
    rig.run(1.0)
    rig.robot.add_obstacle("wall", rectangle(1.1, 0.0, 0.2, 4.0))
    rig.run(4.0)
    assert rig.robot.true_pose.x_m == pytest.approx(1.0 - FRONT_M, abs=2 * CONTACT_M)
    assert rig.robot.remove_obstacle("wall")
    rig.run(2.0)
    assert rig.robot.true_pose.x_m > 1.5
    assert rig.bumps == [True, False]
    assert not rig.robot.remove_obstacle("wall")


def test_a_person_who_steps_aside_moves_under_the_same_name() -> None:
    rig = Rig()
    rig.robot.add_obstacle("person", Circle(1.0, 0.0, 0.2))
    rig.robot.add_obstacle("person", Circle(1.0, 2.0, 0.2))
    rig.command(0.5)
    rig.run(4.0)
    assert rig.robot.true_pose.x_m > 1.8


@settings(max_examples=40, deadline=None)
@given(
    st.floats(-math.pi, math.pi),
    st.floats(0.05, 1.5),
    st.floats(-3.0, 3.0),
    st.floats(0.6, 1.2),
    st.floats(0.02, 0.3),
)
def test_whatever_it_does_it_never_stands_inside_an_obstacle(
    direction_rad: float, speed_mps: float, rate_radps: float, distance_m: float, size_m: float
) -> None:
    shapes = [
        rectangle(distance_m * math.cos(a), distance_m * math.sin(a), size_m, size_m, a)
        if index % 2
        else Circle(distance_m * math.cos(a), distance_m * math.sin(a), size_m)
        for index, a in enumerate(math.tau * i / 10 for i in range(10))
    ]
    rig = Rig(world=world_of(*shapes))
    rig.command(speed_mps * math.cos(direction_rad), speed_mps * math.sin(direction_rad), rate_radps)
    edges, body = Edges(shapes), Footprint(PROFILE.footprint)
    for _ in range(30):
        rig.run(0.1)
        assert not edges.touch(body, rig.robot.true_pose)


POSES = st.builds(Pose, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-4.0, 4.0))


@given(POSES, POSES, st.floats(0.01, 1.0), st.floats(0.01, 1.0))
def test_touching_agrees_with_points_along_both_outlines(
    robot: Pose, box: Pose, length_m: float, width_m: float
) -> None:
    shape = rectangle(box.x_m, box.y_m, length_m, width_m, box.yaw_rad)
    touching = Edges([shape]).touch(Footprint(PROFILE.footprint), robot)
    footprint = polygon(
        tuple((p.x_m, p.y_m) for p in (robot.compose(Pose(x, y)) for x, y in PROFILE.footprint))
    )
    gap_m = min(footprint.distance_m(x, y) for x, y in along(shape.points))
    if gap_m < -1e-6:
        assert touching
    if gap_m > 0.02:  # the points are 10 mm apart at most
        assert not touching


def along(points: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    return [
        (ax + (bx - ax) * i / 100, ay + (by - ay) * i / 100)
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1])
        for i in range(100)
    ]


def test_a_fast_robot_does_not_jump_through_a_thin_wall() -> None:
    rig = Rig(world=world_of(rectangle(2.0, 0.0, 0.005, 4.0)))
    rig.command(1.5)
    rig.robot.step(5.0)
    assert rig.robot.true_pose.x_m < 2.0
    assert rig.robot.true_twist == Twist()
