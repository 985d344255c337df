"""A plan that was stopped: what the robot truly did, and what is left, are told apart as odometry measured it."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.plan.context import LoweringContext
from chatrobot.plan.split import Parts, split
from chatrobot.plan.steps import Drive, ObstacleWithin, Plan, Turn
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.robots.load import load_profile
from chatrobot.robots.open_loop import driven_open_loop
from chatrobot.sim.shapes import rectangle
from chatrobot.testing.rig import Rig

PLANS = [
    "drive 2 m",
    "drive 1.5 m left at 0.4 m/s",
    "turn right 200 deg",
    "arc left 250 deg radius 0.6 m",
    "arc back right 60 deg radius 2 m",
    "drive 1 m\nturn left 90 deg\ndrive 0.5 m back",
    "repeat 3\n  drive 0.4 m\n  turn left 120 deg\nend",
    "twist 0.2 0.1 0.3 for 6 s",
    "wait 2 s\ndrive 1 m\nwait 2 s",
    "go to 1 1 facing 90 deg\ndrive 0.5 m",
    "face 170 deg\ndrive 0.5 m\nface 0 deg from start",
]


def parts(rig: Rig, executor: Executor, plan: Plan, start: Pose) -> Parts:
    reached = executor.reached
    estimate = rig.sensors.estimate
    assert reached is not None
    assert estimate is not None
    return split(plan.steps, reached, LoweringContext(rig.profile, estimate.pose, start))


def stopped_after(rig: Rig, plan: Plan, duration_s: float, *, gently: bool = False) -> Parts:
    """Drive `plan`, stop it after so long, see the robot stand."""
    began_at = rig.sensors.estimate
    assert began_at is not None
    if gently:

        def brake(t_s: float) -> None:
            if t_s >= duration_s:
                rig.executor.ramp_down(Reason("replaced"))

        executor = rig.run(plan, brake)
        rig.halt()
    else:
        executor = rig.run(plan, halt_after_s=duration_s)
    return parts(rig, executor, plan, began_at.pose)


def assert_near(pose: Pose, other: Pose, within_m: float = 0.03, within_deg: float = 1.5) -> None:
    assert pose.distance_to(other) < within_m
    off_rad = math.remainder(pose.yaw_rad - other.yaw_rad, 2.0 * math.pi)
    assert abs(math.degrees(off_rad)) < within_deg


@pytest.mark.parametrize(("plan_text", "gently"), list(zip(PLANS, itertools.cycle([False, True]))))
def test_the_executed_part_leads_where_it_stopped_and_the_remaining_part_to_the_end(
    plan_text: str, gently: bool
) -> None:
    plan = parse_plan(plan_text)
    whole, again = Rig(), Rig()
    whole.run(plan)
    stopped_s = whole.clock.now_s() * 0.45
    rig = Rig()
    done = stopped_after(rig, plan, stopped_s, gently=gently)
    stood = rig.robot.true_pose
    assert done.executed is not None
    assert done.remaining is not None
    again.run(done.executed)
    assert_near(again.robot.true_pose, stood)
    rig.run(done.remaining)
    assert_near(rig.robot.true_pose, whole.robot.true_pose)


def test_what_was_driven_to_its_end_is_the_whole_plan() -> None:
    for text in PLANS:
        rig = Rig()
        plan = parse_plan(text)
        executor = rig.run(plan)
        told = parts(rig, executor, plan, Pose())
        assert told.executed is not None
        assert format_plan(told.executed) == text.replace(" from start", "")
        assert told.remaining is None


def test_it_is_measured_not_timed() -> None:
    """The wheels slip: where the reference is and where odometry saw the robot are two things."""
    rig = Rig(faults="slip=0.05,latency_s=0.05,seed=1")
    done = stopped_after(rig, parse_plan("drive 2 m"), 4.0)
    estimate = rig.sensors.estimate
    assert estimate is not None
    assert done.executed == Plan((Drive(distance_m=round(estimate.pose.x_m, 4)),))


def test_a_condition_that_came_true_leaves_the_distance_that_was_driven() -> None:
    rig = Rig()
    rig.robot.add_obstacle("wall", rectangle(2.0, 0.0, 0.2, 2.0))
    rig.live(0.3)
    plan = Plan((Drive(until=ObstacleWithin(0.5)), Turn(angle_rad=math.pi / 2)))
    done = parts(rig, rig.run(plan), plan, Pose())
    assert done.remaining is None
    assert done.executed is not None
    drive, turn = done.executed.steps
    assert isinstance(drive, Drive)
    assert drive.until is None
    assert drive.distance_m == pytest.approx(rig.robot.true_pose.x_m, abs=0.01)
    assert turn == plan.steps[1]


def test_without_odometry_nothing_is_told() -> None:
    profile = load_profile("wheeltec_mini_mec")
    blind = driven_open_loop(replace(profile, wiring=replace(profile.wiring, odom_topic=None)))
    assert Rig(blind).run(parse_plan("drive 1 m")).reached is None
