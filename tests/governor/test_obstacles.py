"""A wall in the way: the robot stops before it touches, in every direction, at every speed up to the limit."""

from __future__ import annotations

import math

import pytest
from tests.rig import Rig

from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn
from chatrobot.sim.shapes import Circle, Shape, rectangle

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


@pytest.mark.parametrize("speed", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("direction_deg", [0, 45, 90, 180, -90])
def test_the_robot_stops_before_a_wall(speed: float, direction_deg: int) -> None:
    direction = math.radians(direction_deg)
    rig = Rig(lies="noise=on,seed=2")
    drive_at_wall(rig, Drive(distance_m=5.0, direction_rad=direction, speed_mps=speed), direction)
    pose = rig.robot.true_pose
    assert math.hypot(pose.x_m, pose.y_m) > 1.0, "it should come near before it stops"


@pytest.mark.parametrize("appears_after_s", [2.0, 3.0])
@pytest.mark.parametrize("speed", [0.3, 0.6, 1.0])
def test_a_wall_that_appears_in_time_to_brake_is_not_touched(speed: float, appears_after_s: float) -> None:
    rig = Rig(lies="noise=on,seed=5")
    limits = rig.profile.limits
    front = max(x for x, _ in rig.profile.footprint)
    needed = speed * (limits.latency_s + 0.15) + speed**2 / (2.0 * limits.deceleration_mps2) + front + 0.08

    def appear(t_s: float) -> None:
        if t_s == pytest.approx(appears_after_s, abs=0.011):
            rig.robot.add_obstacle("wall", rectangle(rig.robot.true_pose.x_m + needed + 0.1, 0.0, 0.2, 3.0))

    executor = rig.run(Plan((Drive(distance_m=8.0, speed_mps=speed),)), appear)
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
