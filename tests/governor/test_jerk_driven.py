"""A simulated robot whose profile limits jerk still arrives, and still stops in time."""

from __future__ import annotations

import math

import pytest
from tests.governor.situations import smooth

from chatrobot.plan.steps import Drive, Plan, Turn
from chatrobot.sim.shapes import rectangle
from chatrobot.testing.rig import Rig


@pytest.mark.parametrize("speed", [0.3, 1.0])
def test_a_plan_still_arrives_where_it_should(speed: float) -> None:
    rig = Rig(smooth())
    plan = Plan((Drive(distance_m=1.0, speed_mps=speed), Turn(angle_rad=math.pi / 2), Drive(distance_m=0.5)))
    assert rig.run(plan).outcome == "completed"
    assert rig.robot.true_pose == pytest.approx((1.0, 0.5, math.pi / 2), abs=0.015)


def test_a_wall_is_not_touched_by_a_robot_that_eases() -> None:
    rig = Rig(smooth())
    rig.robot.add_obstacle("wall", rectangle(2.1, 0.0, 0.2, 4.0))
    rig.live(0.3)
    executor = rig.run(Plan((Drive(distance_m=5.0, speed_mps=1.0),)))
    assert not rig.robot.in_contact
    assert executor.outcome == "stopped"
