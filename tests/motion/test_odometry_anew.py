"""A robot's end that is started anew counts from zero again: that is noticed, and nobody takes it for motion."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from tests.motion.far_robot import Rig

from chatrobot.core.geometry import Pose
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import Odometry, TwistMessage


def without_gyro(profile: RobotProfile) -> RobotProfile:
    return replace(profile, wiring=replace(profile.wiring, imu_topic=None))


@pytest.fixture
def rig() -> Rig:
    return Rig(without_gyro)


def start_anew(rig: Rig, gap_s: float) -> None:
    """The robot's end is gone for a while; then its odometry counts from where the robot stands."""
    rig.network.is_down = True
    rig.pass_time(gap_s)
    origin = rig.robot.true_pose
    estimator = rig.motion.sensors.estimator
    hear = estimator.on_odometry

    def hear_anew(message: Odometry) -> None:
        x_m, y_m, yaw_rad = Pose(*message[1:4]).relative_to(origin)
        hear(message._replace(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad))

    estimator.on_odometry = hear_anew  # type: ignore[method-assign]
    rig.network.is_down = False
    rig.pass_time(0.4)


def seen(rig: Rig) -> Pose:
    estimate = rig.motion.sensors.estimate
    assert estimate is not None
    return estimate.pose


@pytest.mark.parametrize("gap_s", [0.1, 0.6, 3.0, 60.0])
@pytest.mark.parametrize(
    ("plan_text", "code"), [("drive 1 m", "odometry_jumped"), ("turn left 90 deg", "odometry_swung")]
)
def test_a_robot_that_stands_is_where_it_was(rig: Rig, gap_s: float, plan_text: str, code: str) -> None:
    rig.do(plan_text)
    before = seen(rig)
    start_anew(rig, gap_s)
    assert seen(rig).distance_to(before) < 0.02
    assert seen(rig).yaw_rad == pytest.approx(before.yaw_rad, abs=0.02)
    told = rig.do("drive 0.1 m")
    assert told.reason is not None
    assert told.reason.code == code, "the next plan does not begin as though nothing had been"
    assert rig.do("drive 0.1 m").outcome == "completed"


@pytest.mark.parametrize("gap_s", [0.1, 1.0, 3.0])
def test_a_robot_that_was_moving_is_ended_where_it_was_seen_last(rig: Rig, gap_s: float) -> None:
    rig.begin("drive 5 m")
    rig.pass_time(3.0)
    before = seen(rig)
    start_anew(rig, gap_s)
    assert seen(rig).distance_to(before) < 0.05, "not at the origin"
    end = rig.end_of(1)
    assert end is not None
    assert end.outcome == "failed"


@pytest.mark.parametrize("velocity", [(0.3, 0.0, 0.0), (0.2, 0.1, 0.3), (0.0, 0.0, 0.6), (-0.1, 0.0, 0.2)])
def test_a_robot_that_drove_on_unseen_has_not_jumped(rig: Rig, velocity: tuple[float, float, float]) -> None:
    somebody = rig.hub.connect()
    somebody.publish("cmd_vel", TwistMessage(*velocity))
    rig.pass_time(1.0)
    rig.network.is_down = True
    rig.pass_time(3.0)
    rig.network.is_down = False
    rig.pass_time(0.4)
    assert rig.motion.sensors.estimator.fault is None
    assert seen(rig).distance_to(rig.robot.true_pose) < 0.02
    assert math.remainder(seen(rig).yaw_rad - rig.robot.true_pose.yaw_rad, math.tau) == pytest.approx(
        0.0, abs=0.02
    )
