"""A simulated robot whose sensors nobody hears moves as ever, and speaks again when somebody listens."""

from __future__ import annotations

from typing import Any

import pytest

from chatrobot.core.clock import VirtualClock
from chatrobot.core.geometry import Pose
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import LaserScan, Odometry, TwistMessage


def driven(world: str = "empty", **listening: bool) -> tuple[SimRobot, list[Any]]:
    """A robot that went 2 s at 0.2 m/s and 0.3 rad/s, and what it said."""
    hub = MemoryHub()
    profile = load_profile("wheeltec_mini_mec")
    start = Pose(1.0, 0.5, 0.2)
    robot = SimRobot(profile, load_world(world), wire=hub.connect(), clock=VirtualClock(), start=start)
    said: list[Any] = []
    wire = hub.connect()
    for topic, kind in (("odom", Odometry), ("scan", LaserScan)):
        wire.subscribe(topic, kind, said.append)
    if listening:
        robot.listen_to(**listening)
    wire.publish("cmd_vel", TwistMessage(0.2, 0.0, 0.3))
    robot.step(2.0)
    return robot, said


def test_it_moves_the_same_whether_it_is_heard_or_not() -> None:
    heard, _ = driven()
    unheard, said = driven(sensors=False, lidar=False)
    assert not said
    assert list(unheard.true_pose) == pytest.approx(list(heard.true_pose), abs=1e-4)


def test_it_measures_on_when_somebody_listens_again() -> None:
    robot, said = driven(sensors=False, lidar=False)
    robot.listen_to(sensors=True, lidar=False)
    robot.step(0.1)
    assert [type(message) for message in said] == [Odometry] * 10
    assert said[-1].stamp_s == pytest.approx(2.1)
    assert said[-1][1:4] == pytest.approx(robot.true_pose, abs=1e-9)


def test_its_lidar_can_be_spared_alone() -> None:
    _, said = driven(sensors=True, lidar=False)
    assert not [message for message in said if isinstance(message, LaserScan)]
    assert len(said) == 200
