"""The lidar sees what stands around, from where it is mounted."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from sim_rig import PROFILE, Rig, world_of

from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import Lidar
from chatrobot.sim.edges import Edges
from chatrobot.sim.shapes import Circle, Polygon, Shape, rectangle
from chatrobot.wire.messages import LaserScan


def range_along(scan: LaserScan, angle_rad: float) -> float:
    """The range of the beam that looks along `angle_rad` in the lidar's frame."""
    beam = round((angle_rad - scan.angle_min_rad) / scan.angle_increment_rad)
    return scan.ranges_m[beam % len(scan.ranges_m)]


def mounted(lidar: Lidar) -> Rig:
    rig = Rig(
        world=world_of(rectangle(2.1, 0.0, 0.2, 1.0), rectangle(0.0, 3.1, 1.0, 0.2)),
        profile=replace(PROFILE, lidar=lidar),
    )
    rig.run(0.1)
    return rig


LIDAR = Lidar(x_m=0.0, y_m=0.0, yaw_rad=0.0, beams=360, min_range_m=0.05, max_range_m=12.0, rate_hz=10.0)


def test_it_sees_a_wall_at_the_right_range() -> None:
    scan = mounted(LIDAR).scans[-1]
    assert range_along(scan, 0.0) == 2.0
    assert range_along(scan, math.radians(10)) == pytest.approx(2.0 / math.cos(math.radians(10)), abs=1e-3)
    assert range_along(scan, math.pi / 2) == 3.0
    assert range_along(scan, math.pi) == math.inf
    assert range_along(scan, -math.pi / 2) == math.inf


def test_a_scan_says_how_its_beams_lie() -> None:
    scan = mounted(LIDAR).scans[-1]
    assert len(scan.ranges_m) == 360
    assert scan.angle_min_rad == -math.pi
    assert scan.angle_increment_rad == pytest.approx(math.radians(1.0))
    assert (scan.range_min_m, scan.range_max_m) == (0.05, 12.0)


def test_it_looks_from_where_it_is_mounted() -> None:
    scan = mounted(replace(LIDAR, x_m=0.1, y_m=-0.05)).scans[-1]
    assert range_along(scan, 0.0) == pytest.approx(1.9)
    assert range_along(scan, math.pi / 2) == pytest.approx(3.05)


def test_a_lidar_mounted_backwards_sees_the_front_behind_itself() -> None:
    scan = mounted(replace(LIDAR, yaw_rad=math.pi)).scans[-1]
    assert range_along(scan, math.pi) == pytest.approx(2.0)
    assert range_along(scan, -math.pi / 2) == pytest.approx(3.0)
    assert range_along(scan, 0.0) == math.inf


def test_what_is_too_far_or_too_near_is_infinite_either_way() -> None:
    scan = mounted(replace(LIDAR, max_range_m=2.5, min_range_m=2.001)).scans[-1]
    assert range_along(scan, 0.0) == -math.inf
    assert range_along(scan, math.pi / 2) == math.inf
    assert range_along(scan, math.radians(10)) == pytest.approx(2.031)


def test_it_turns_with_the_robot() -> None:
    rig = mounted(LIDAR)
    rig.command(wz_radps=1.0)
    rig.run(1.0)
    rig.command()
    rig.run(1.0)
    bearing = -rig.robot.true_pose.yaw_rad
    assert range_along(rig.scans[-1], bearing) == pytest.approx(2.0, abs=0.01)


def test_it_sees_what_appears_and_no_longer_what_has_gone() -> None:
    rig = Rig()
    rig.run(0.1)
    assert set(rig.scans[-1].ranges_m) == {math.inf}
    rig.robot.add_obstacle("person", Circle(1.2, 0.0, 0.2))
    rig.run(0.1)
    assert range_along(rig.scans[-1], 0.0) == 1.0
    rig.robot.remove_obstacle("person")
    rig.run(0.1)
    assert set(rig.scans[-1].ranges_m) == {math.inf}


def test_a_profile_without_a_lidar_scans_nothing() -> None:
    rig = Rig(profile=replace(PROFILE, lidar=None))
    rig.run(1.0)
    assert rig.scans == []


EYES = st.builds(Pose, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-4.0, 4.0))
SHAPES = st.lists(
    st.one_of(
        st.builds(
            rectangle,
            st.floats(-4.0, 4.0),
            st.floats(-4.0, 4.0),
            st.floats(0.1, 2.0),
            st.floats(0.1, 2.0),
            st.floats(-4.0, 4.0),
        ),
        st.builds(Circle, st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), st.floats(0.1, 1.0)),
    ),
    min_size=1,
    max_size=4,
)


@given(EYES, SHAPES)
def test_a_ray_ends_on_an_outline_and_passes_none_before(eye: Pose, shapes: list[Shape]) -> None:
    assume(
        all(abs(shape.distance_m(eye.x_m, eye.y_m)) > 1e-6 for shape in shapes)
    )  # on it: in or out is chance
    beams = 16
    for beam, reach_m in enumerate(Edges(shapes).raycast(eye, beams).tolist()):
        angle = eye.yaw_rad - math.pi + math.tau * beam / beams
        if math.isfinite(reach_m):
            assert nearest_outline_m(shapes, eye, angle, reach_m) == pytest.approx(0.0, abs=1e-6)
        free_m = min(reach_m, 6.0) - 0.01
        inside = [shape.distance_m(eye.x_m, eye.y_m) < 0.0 for shape in shapes]
        for step in range(int(free_m / 0.05)):
            x, y = eye.x_m + step * 0.05 * math.cos(angle), eye.y_m + step * 0.05 * math.sin(angle)
            now = [shape.distance_m(x, y) for shape in shapes]
            assert all((gap < 0.0) == was or abs(gap) < 0.01 for gap, was in zip(now, inside))


def nearest_outline_m(shapes: list[Polygon | Circle], eye: Pose, angle: float, reach_m: float) -> float:
    x, y = eye.x_m + reach_m * math.cos(angle), eye.y_m + reach_m * math.sin(angle)
    return min(abs(shape.distance_m(x, y)) for shape in shapes)
