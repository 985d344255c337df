"""Whoever dies or freezes, the robot stands within 250 ms. In real time, over a real wire, against a robot that
holds its last command for ever.

One blow of each kind; `make faults` strikes twenty times."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.processes import RunningRobot

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

PROMISE_S = 0.25


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[RunningRobot]:
    running = RunningRobot(tmp_path)
    yield running
    running.close()


def seconds_to_zero_after(robot: RunningRobot, strike: Callable[[], object]) -> float:
    said_s = robot.say("forward 100 m at 0.3 m/s")
    robot.velocities.wait_for_motion(said_s)
    began_s = time.monotonic()
    strike()
    return robot.velocities.seconds_to_zero(began_s)


@pytest.mark.parametrize("whom", ["console", "motion", "guard"])
@pytest.mark.parametrize("how", ["SIGKILL", "SIGSTOP"])
def test_the_robot_stands_within_250_ms(robot: RunningRobot, whom: str, how: str) -> None:
    (guard,) = robot.guard_pids()
    pid = {"console": robot.process.pid, "motion": robot.motion_pid, "guard": guard}[whom]
    assert seconds_to_zero_after(robot, lambda: os.kill(pid, getattr(signal, how))) <= PROMISE_S


def test_two_at_once_leave_one_who_stops_the_robot(robot: RunningRobot) -> None:
    pids = (*robot.guard_pids(), robot.process.pid)
    assert seconds_to_zero_after(robot, lambda: [os.kill(pid, signal.SIGKILL) for pid in pids]) <= PROMISE_S


def test_a_motion_that_thaws_does_not_drive_on(robot: RunningRobot) -> None:
    seconds_to_zero_after(robot, lambda: os.kill(robot.motion_pid, signal.SIGSTOP))
    thawed_s = time.monotonic()
    os.kill(robot.motion_pid, signal.SIGCONT)
    result = robot.wait_for_event("result", turn=1)
    assert result["outcome"] == "failed"
    assert robot.velocities.seconds_to_zero(thawed_s) <= 0.1
    robot.say("forward 10 cm")  # told anew, it does
    assert robot.wait_for_event("result", turn=2)["outcome"] == "completed"


def test_a_typed_stop_stops_what_moves(robot: RunningRobot) -> None:
    said_s = robot.say("forward 5 m")
    robot.velocities.wait_for_motion(said_s)
    stopped_s = robot.say("stop")
    assert robot.velocities.seconds_to_zero(stopped_s) <= PROMISE_S
    assert robot.wait_for_event("result", turn=1)["outcome"] == "stopped"
