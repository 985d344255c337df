"""A wall in the way: the robot stops before it touches, in every direction, at every speed up to the limit."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from chatrobot.core.geometry import ORIGIN
from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn
from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.robots.profile import RobotProfile, Safety
from chatrobot.sim.shapes import Circle, Shape, rectangle
from chatrobot.testing.rig import Rig

FAR_M = 2.0


def wall_ahead(direction_rad: float, distance_m: float) -> Shape:
    """A wall across the way, its near side `distance_m` from the robot's centre."""
    centre = distance_m + 0.1
    return rectangle(
        centre * math.cos(direction_rad), centre * math.sin(direction_rad), 0.2, 4.0, direction_rad
    )


def drive_at_wall(rig: Rig, step: Step, direction_rad: float) -> None:
    rig.robot.add_obstacle("wall", wall_ahead(direction_rad, FAR_M))
    rig.live(0.3)
    executor = rig.run(Plan((step,)))
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"
    assert executor.reason is not None
    assert executor.reason.code == "obstacle_ahead"


@pytest.mark.parametrize(
    ("direction_deg", "speed"), [(0, 0.1), (0, 1.0), (45, 1.0), (90, 0.3), (180, 1.0), (-90, 1.0)]
)
def test_the_robot_stops_before_a_wall(direction_deg: int, speed: float) -> None:
    direction = math.radians(direction_deg)
    rig = Rig(faults="noise=on,seed=2")
    drive_at_wall(rig, Drive(distance_m=5.0, direction_rad=direction, speed_mps=speed), direction)
    pose = rig.robot.true_pose
    assert math.hypot(pose.x_m, pose.y_m) > 1.0, "it should come near before it stops"


def braking_m(rig: Rig, speed_mps: float) -> float:
    """Latency, a scan's period and a tick, then the profile's deceleration; and the margin."""
    limits = rig.profile.limits
    assert rig.profile.lidar is not None
    late_s = limits.latency_s + 1.0 / rig.profile.lidar.rate_hz + 0.05
    slowest = min(limits.acceleration_mps2, limits.deceleration_mps2)
    return speed_mps * late_s + speed_mps**2 / (2.0 * slowest) + 0.08


@pytest.mark.parametrize("direction_deg", [0, 90, -150])
@pytest.mark.parametrize("speed", [0.1, 0.6, 1.0])
def test_a_wall_that_appears_in_time_to_brake_is_not_touched(speed: float, direction_deg: int) -> None:
    rig, direction = Rig(faults="noise=on,seed=5"), math.radians(direction_deg)
    reach = max(x * math.cos(direction) + y * math.sin(direction) for x, y in rig.profile.footprint)

    def appear(t_s: float) -> None:
        if t_s == pytest.approx(2.0, abs=0.011):
            pose = rig.robot.true_pose
            gone = pose.x_m * math.cos(direction) + pose.y_m * math.sin(direction)
            rig.robot.add_obstacle("wall", wall_ahead(direction, gone + reach + braking_m(rig, speed)))

    executor = rig.run(Plan((Drive(distance_m=8.0, direction_rad=direction, speed_mps=speed),)), appear)
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"


@pytest.mark.parametrize(
    "robot", [r for r in (e.load() for e in list_profiles()) if r.lidar], ids=lambda r: r.name
)
@pytest.mark.parametrize(("direction_deg", "share"), [(0, 1.0), (180, 0.3)])
def test_a_wall_that_appears_is_not_touched_by_any_robot_that_sees(
    robot: RobotProfile, direction_deg: int, share: float
) -> None:
    rig, direction = Rig(robot, faults="noise=on,seed=6"), math.radians(direction_deg)
    speed, sign = share * robot.limits.max_speed_mps, math.cos(direction)
    reach = max(sign * x for x, _ in robot.footprint)

    def appear(t_s: float) -> None:
        if t_s == pytest.approx(2.0, abs=0.011):
            gone = sign * rig.robot.true_pose.x_m
            rig.robot.add_obstacle("wall", wall_ahead(direction, gone + reach + braking_m(rig, speed)))

    executor = rig.run(Plan((Drive(distance_m=8.0, direction_rad=direction, speed_mps=speed),)), appear)
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"


@pytest.mark.parametrize("left", [True, False])
@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0])
def test_a_post_that_appears_beside_a_turning_robot_in_time_to_brake_is_not_touched(
    rate: float, left: bool
) -> None:
    rig = Rig("wheeltec_mini_mec", faults="noise=on,seed=7")
    limits, sign = rig.profile.limits, 1.0 if left else -1.0
    corner_x, corner_y = rig.profile.footprint[1]
    late_s = limits.latency_s + 0.15
    angle = rate * late_s + rate**2 / (2.0 * limits.angular_acceleration_radps2) + 0.25

    def appear(t_s: float) -> None:
        if t_s == pytest.approx(1.5, abs=0.011):
            bearing = rig.robot.true_pose.yaw_rad + sign * (math.atan2(corner_y, corner_x) + angle)
            away = math.hypot(corner_x, corner_y) - 0.01
            away = away + 0.03
            post = Circle(away * math.cos(bearing), away * math.sin(bearing), 0.03)
            rig.robot.add_obstacle("post", post)

    executor = rig.run(Plan((Turn(angle_rad=4.0 * math.pi, left=left, rate_radps=rate),)), appear)
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"


def test_turning_stops_before_a_corner_of_the_footprint_touches() -> None:
    rig = Rig("wheeltec_mini_diff")
    side = max(y for _, y in rig.profile.footprint)
    rig.robot.add_obstacle("post", Circle(0.0, side + 0.05, 0.03))
    rig.live(0.3)
    executor = rig.run(Plan((Turn(angle_rad=math.pi),)))
    assert not rig.robot.in_contact
    assert executor.reason is not None
    assert executor.reason.code == "obstacle_ahead"


def test_a_robot_that_stands_close_to_a_wall_may_leave_it() -> None:
    rig = Rig()
    front = max(x for x, _ in rig.profile.footprint)
    rig.robot.add_obstacle("wall", rectangle(front + 0.11, 0.0, 0.2, 3.0))
    rig.live(0.3)
    assert rig.run(Plan((Drive(distance_m=0.5, direction_rad=math.pi),))).outcome == "completed"


def test_somebody_who_walks_past_delays_the_plan_and_does_not_end_it() -> None:
    rig = Rig()
    rig.robot.add_obstacle("person", Circle(1.0, 0.0, 0.2))
    rig.live(0.3)

    def walk_on(t_s: float) -> None:
        if t_s > 4.0:
            rig.robot.remove_obstacle("person")

    executor = rig.run(Plan((Drive(distance_m=2.0),)), walk_on)
    assert executor.outcome == "completed"
    assert rig.robot.true_pose.x_m == pytest.approx(2.0, abs=0.02)


def test_a_curve_stops_before_what_stands_on_it_and_passes_what_does_not() -> None:
    rig = Rig()
    rig.robot.add_obstacle("inside of the curve", Circle(0.0, 1.0, 0.1))
    rig.live(0.3)
    assert rig.run(Plan((Arc(1.0, math.pi / 2),))).outcome == "completed"
    rig = Rig()
    rig.robot.add_obstacle("on the curve", Circle(1.0, 1.0, 0.1))
    rig.live(0.3)
    assert rig.run(Plan((Arc(1.0, math.pi / 2),))).outcome == "stopped"
    assert not rig.robot.in_contact


# --- a cheap lidar ---

CHEAP = "noise=on,seed=3,lidar_zeros=on"
WITH_LIDAR = [robot for robot in (entry.load() for entry in list_profiles()) if robot.lidar is not None]
WAYS = [
    pytest.param(robot, direction, share, id=f"{robot.name}-{direction}-{share}")
    for number, robot in enumerate(WITH_LIDAR)
    for direction in ((0, -90, 135) if robot.can_go_sideways else (180,) if number % 2 else (0,))
    for share in ((0.5, 1.0) if direction == 0 else (1.0,))
]


@pytest.mark.parametrize(("robot", "direction_deg", "share"), WAYS)
def test_zeros_do_not_hide_a_wall(robot: RobotProfile, direction_deg: int, share: float) -> None:
    direction, rig = math.radians(direction_deg), Rig(robot, CHEAP)
    speed = share * robot.limits.max_speed_mps
    drive_at_wall(rig, Drive(distance_m=5.0, direction_rad=direction, speed_mps=speed), direction)


@pytest.mark.parametrize("yaw_deg", [-120, 90, 180])
def test_a_lidar_that_is_mounted_turned_sees_the_wall_where_it_is(yaw_deg: int) -> None:
    robot = load_profile("wheeltec_mini_mec")
    assert robot.lidar is not None
    turned = replace(robot, lidar=replace(robot.lidar, yaw_rad=math.radians(yaw_deg)))
    drive_at_wall(Rig(turned, CHEAP), Drive(distance_m=5.0, speed_mps=1.0), 0.0)


@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0])
def test_turning_stops_before_a_post_that_vanishes_inside_the_minimum_range(rate: float) -> None:
    rig = Rig("wheeltec_mini_mec", CHEAP)
    side = max(y for _, y in rig.profile.footprint)
    rig.robot.add_obstacle("post", Circle(0.0, side + 0.06, 0.03))
    rig.live(0.3)
    executor = rig.run(Plan((Turn(angle_rad=math.pi, rate_radps=rate),)))
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"


# --- where the lidar does not look ---


def half_blind(blind_speed_mps: float, fov_deg: float = 180.0) -> Rig:
    robot = replace(load_profile("wheeltec_mini_mec"), safety=Safety(blind_speed_mps=blind_speed_mps))
    rig = Rig(robot, f"{CHEAP},lidar_fov_deg={fov_deg}")
    rig.robot.add_obstacle(
        "far", rectangle(7.0, 0.0, 0.5, 4.0)
    )  # a cheap lidar that sees nothing says nothing
    return rig


@pytest.mark.parametrize("speed", [0.3, 0.6, 1.0])
def test_a_way_that_the_lidar_does_not_see_is_refused_where_the_profile_says_so(speed: float) -> None:
    rig = half_blind(0.0)
    rig.robot.add_obstacle("wall", wall_ahead(math.pi, 0.5))
    rig.live(0.3)
    executor = rig.run(Plan((Drive(distance_m=3.0, direction_rad=math.pi, speed_mps=speed),)))
    assert not rig.robot.in_contact
    assert rig.robot.true_pose == pytest.approx(ORIGIN, abs=1e-3)
    assert executor.reason is not None
    assert executor.reason.code == "not_seen"


@pytest.mark.parametrize("direction_deg", [180, 150, -120])
def test_a_way_that_the_lidar_does_not_see_is_driven_slowly(direction_deg: int) -> None:
    rig = half_blind(0.1)
    executor = rig.run(
        Plan((Drive(distance_m=0.5, direction_rad=math.radians(direction_deg), speed_mps=1.0),))
    )
    assert executor.outcome == "completed"
    assert max(twist.speed_mps for twist in rig.sent) <= 0.1 + 1e-9


def test_a_way_that_the_lidar_sees_is_driven_as_asked() -> None:
    rig = half_blind(0.0)
    assert rig.run(Plan((Drive(distance_m=1.0, speed_mps=0.6),))).outcome == "completed"
    assert max(twist.speed_mps for twist in rig.sent) > 0.55


def test_a_turn_whose_rear_corners_swing_through_the_unseen_is_slow() -> None:
    rig = half_blind(0.1)
    assert rig.run(Plan((Turn(angle_rad=0.5, rate_radps=1.5),))).outcome == "completed"
    fastest = max(abs(twist.wz_radps) for twist in rig.sent)
    assert fastest * rig.profile.footprint_radius_m <= 0.1 + 1e-9


@pytest.mark.parametrize("direction_deg", [0, 45, 90])
def test_what_was_seen_before_it_left_the_field_of_view_still_counts(direction_deg: int) -> None:
    """It turns its back on a wall that it has seen, then drives backwards: within a metre it remembers."""
    rig = half_blind(0.1, fov_deg=270.0)
    rig.robot.add_obstacle("wall", wall_ahead(math.radians(direction_deg), 0.6))
    rig.live(0.4)
    turn = Turn(angle_rad=math.pi - math.radians(direction_deg), left=False, rate_radps=0.5)
    executor = rig.run(Plan((turn, Drive(distance_m=1.0, direction_rad=math.pi, speed_mps=0.5))))
    assert not rig.robot.in_contact
    assert executor.reason is not None
    assert executor.reason.code in ("obstacle_ahead", "not_seen")


@pytest.mark.parametrize("fov_deg", [90.0, 180.0])
@pytest.mark.parametrize("left", [1.0, -1.0])
def test_what_stands_beside_it_and_was_never_seen_is_met_at_blind_speed(fov_deg: float, left: float) -> None:
    """It sets out at a slant; where that leads to is in view, and what stands beside it is not."""
    rig = half_blind(0.1, fov_deg)
    rig.robot.add_obstacle("box", rectangle(-0.05, left * 0.25, 0.1, 0.1))
    rig.live(0.3)
    touched_at_mps: list[float] = []

    def watch(_t_s: float) -> None:
        if rig.robot.in_contact and not touched_at_mps:
            touched_at_mps.append(rig.sent[-1].speed_mps)

    rig.run(Plan((Drive(distance_m=1.0, direction_rad=left * math.radians(40.0), speed_mps=1.0),)), watch)
    assert touched_at_mps, "nothing but the blind speed protects it: it was not in the way"
    assert touched_at_mps[0] <= 0.1 + 1e-9


def test_narrow_eyes_slow_it_only_until_they_have_seen_what_lies_before_its_feet() -> None:
    rig = half_blind(0.1, fov_deg=60.0)
    assert rig.run(Plan((Drive(distance_m=2.0, speed_mps=0.8),))).outcome == "completed"
    speeds = [twist.speed_mps for twist in rig.sent]
    assert max(speeds) > 0.75
    assert speeds[20] == pytest.approx(0.1, abs=0.001)
