"""The footprint stays inside the fence, whatever the direction, and may always come back."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.governor.situations import MECANUM, at, with_safety

from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.governor.contact import seconds_until_below
from chatrobot.governor.rule import FREE
from chatrobot.governor.space_rules import FenceRule
from chatrobot.plan.steps import Drive, Plan, Turn
from chatrobot.robots.profile import Circle, Safety
from chatrobot.testing.rig import Rig

CIRCLE = Circle(0.0, 0.0, 1.0)
SQUARE = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
CORNER = ((-1.0, -1.0), (1.0, -1.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0), (-1.0, 1.0))
"""Not convex: it bends in towards the robot."""


def farthest_m(rig: Rig) -> float:
    """Of the robot's corners from the middle of the circle, by the truth."""
    corners = [rig.robot.true_pose.compose(Pose(x, y)) for x, y in rig.profile.footprint]
    return max(math.hypot(corner.x_m, corner.y_m) for corner in corners)


@pytest.mark.parametrize("speed", [0.2, 1.0])
@pytest.mark.parametrize("direction_deg", [0, 45, 90, 180, -100])
@pytest.mark.parametrize("fence", [CIRCLE, SQUARE, CORNER], ids=["circle", "square", "corner"])
def test_the_robot_stops_before_the_fence(
    fence: Circle | tuple[tuple[float, float], ...], direction_deg: int, speed: float
) -> None:
    rig = Rig(with_safety(Safety(fence=fence)))
    executor = rig.run(
        Plan((Drive(distance_m=4.0, direction_rad=math.radians(direction_deg), speed_mps=speed),))
    )
    assert executor.outcome == "stopped"
    assert executor.reason is not None
    assert executor.reason.code == "leaves_fence"
    spare = FenceRule(rig.profile, fence)._clearance
    corners = [rig.robot.true_pose.compose(Pose(x, y))[:2] for x, y in rig.profile.footprint]
    assert spare(np.array(corners)).min() >= -0.001
    assert math.hypot(*rig.robot.true_pose[:2]) > 0.05, "it should come near before it stops"


def test_along_the_fence_nothing_is_limited() -> None:
    rule = FenceRule(MECANUM, SQUARE)
    assert rule.judge(Twist(0.5, 0.0, 0.0), at(Pose(0.0, 0.85, 0.0))) is FREE


def test_inside_the_fence_nothing_is_limited() -> None:
    rig = Rig(with_safety(Safety(fence=CIRCLE)))
    assert rig.run(Plan((Drive(distance_m=0.5), Turn(angle_rad=math.pi)))).outcome == "completed"
    assert farthest_m(rig) < 1.0


def test_a_turn_may_not_swing_a_corner_over_the_fence() -> None:
    narrow = ((-0.2, -0.12), (0.2, -0.12), (0.2, 0.12), (-0.2, 0.12))
    rule = FenceRule(MECANUM, narrow)
    ruling = rule.judge(Twist(0.0, 0.0, 1.0), at())
    assert ruling.factor < 0.5
    assert ruling.reason is not None
    assert ruling.reason.values["distance_m"] == 0.01


def test_a_robot_outside_may_come_back_and_go_no_farther() -> None:
    rule = FenceRule(MECANUM, CIRCLE)
    outside = at(Pose(1.5, 0.0, 0.0))
    assert rule.judge(Twist(-0.3, 0.0, 0.0), outside).factor == 1.0
    assert rule.judge(Twist(0.3, 0.0, 0.0), outside).factor == 0.0
    half_out = at(Pose(0.95, 0.0, 0.0))
    assert rule.judge(Twist(-0.3, 0.0, 0.0), half_out).factor == 1.0
    away = rule.judge(Twist(0.3, 0.0, 0.0), half_out)
    assert away.factor == 0.0
    assert away.reason is not None
    assert (away.reason.code, away.reason.values) == ("outside_fence", {"distance_m": 0.09})


def test_a_robot_at_the_edge_is_told_of_the_edge() -> None:
    """Odometry knows no place to the millimetre."""
    edge = Pose(1.0 - max(x for x, _ in MECANUM.footprint) + 0.002, 0.0, 0.0)
    ruling = FenceRule(MECANUM, SQUARE).judge(Twist(0.3, 0.0, 0.0), at(edge))
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("leaves_fence", {"distance_m": 0.0})


def test_without_a_pose_nothing_moves_inside_a_fence_and_zero_is_always_fine() -> None:
    rule = FenceRule(MECANUM, CIRCLE)
    ruling = rule.judge(Twist(0.1, 0.0, 0.0), at(None))
    assert ruling.factor == 0.0
    assert ruling.reason is not None
    assert (ruling.reason.code, ruling.reason.values) == ("sensor_silent", {"sensor": "odom"})
    assert rule.judge(ZERO_TWIST, at(None)).factor == 1.0


def test_the_fence_is_where_it_is_and_not_around_the_origin() -> None:
    rule = FenceRule(MECANUM, Circle(5.0, -3.0, 1.0))
    assert rule.judge(Twist(0.3, 0.0, 0.0), at(Pose(5.0, -3.0, 0.7))).factor == 1.0
    assert rule.judge(Twist(0.3, 0.0, 0.0), at(ORIGIN)).factor == 1.0, "it points towards the fence"
    assert rule.judge(Twist(-0.3, 0.0, 0.0), at(ORIGIN)).factor == 0.0
    assert rule.judge(Twist(0.0, -0.5, 0.0), at(Pose(5.0, -3.0, 0.0))).factor == 1.0
    at_its_side = at(Pose(5.0, -3.8, 0.0))
    assert rule.judge(Twist(0.0, 0.5, 0.0), at_its_side).factor == 1.0
    assert rule.judge(Twist(0.0, -0.5, 0.0), at_its_side).factor < 1.0


@pytest.mark.parametrize("wz", [0.0, 2.0])
def test_a_robot_that_brakes_weakly_looks_that_far(wz: float) -> None:
    """It needs 1.7 m, so it must not wait until the fence is near."""
    weak = replace(MECANUM, limits=replace(MECANUM.limits, deceleration_mps2=0.3))
    rule = FenceRule(weak, Circle(0.0, 0.0, 1.6 + weak.footprint_radius_m))
    assert rule.judge(Twist(1.0, 0.0, 0.0), at()).factor < 1.0
    assert rule.judge(Twist(0.0, 0.0, wz), at()).factor == 1.0


def test_the_time_to_the_edge_is_interpolated() -> None:
    def seconds_to_edge(*spare_m: float) -> float:
        return seconds_until_below(np.array(spare_m)[:, None], np.array([0.0, 1.0, 2.0, 3.0]), 0.0)

    assert seconds_to_edge(3.0, 2.0, 1.0, -1.0) == pytest.approx(2.5)
    assert seconds_to_edge(3.0, 2.0, 1.0, 0.5) == math.inf
    assert seconds_to_edge(-1.0, -1.5, -2.0, -3.0) == 0.0
    assert seconds_to_edge(-1.0, -0.9, -0.5, -1.5) == 2.0


def test_the_area_of_the_world_is_a_fence_too() -> None:
    rig = Rig(MECANUM, area=SQUARE)
    executor = rig.run(Plan((Drive(distance_m=4.0),)))
    assert executor.reason is not None
    assert executor.reason.code == "leaves_fence"
    assert rig.robot.true_pose.x_m < 1.0 - 0.135 + 0.001
