"""Where odometry falls silent nothing of ours drives on: a plan, a program and another program's velocities alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from chatrobot.core.events import Limited, Notice
from chatrobot.core.geometry import Twist
from chatrobot.motion.planner import Planned, Planner
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.remembered_obstacles import RememberedObstacles
from chatrobot.programs.events import ProgramEvent, TwistAsked
from chatrobot.robots.profile import Circle, RobotProfile
from chatrobot.wire.messages import TwistMessage
from tests.motion.far_robot import Rig

ASKED = Twist(0.3, 0.0, 0.0)
FENCE_M = 1.2


class Drives:
    """A program that asks for the same velocity each time it is looked at."""

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        return [TwistAsked("cmd_vel", ASKED, now_s)]

    def close(self) -> None:
        pass


class Box:
    """Holds that program."""

    def attach(self, wire: Any) -> None:
        pass

    def rehearse(self, goal: ProgramGoal, planner: Planner, seen: RememberedObstacles | None) -> Planned:  # noqa: ARG002
        return planner.plan(goal.turn, "drive 0.5 m", goal.start)

    def launch(self, goal: ProgramGoal) -> Drives:  # noqa: ARG002 - the protocol's
        return Drives()


def blind_and_fenced(profile: RobotProfile) -> RobotProfile:
    """Without a lidar nothing but odometry keeps it from leaving its fence."""
    fenced = replace(profile.safety, fence=Circle(0.0, 0.0, FENCE_M))
    return replace(profile, lidar=None, wiring=replace(profile.wiring, scan_topic=None), safety=fenced)


def driven(rig: Rig, source: str, duration_s: float) -> None:
    """Let time pass while that source goes on asking."""
    for _ in range(round(duration_s / 0.02)):
        if source == "relay":
            rig.motion._relayed._programs.hear(ASKED, rig.motion._clock.now_s())
        elif source == "stick":
            rig.link.send("steer", vx_mps=ASKED.vx_mps)
        rig.pass_time(0.02)


@pytest.mark.parametrize("source", ["plan", "program", "relay", "stick"])
@pytest.mark.parametrize("change", [lambda profile: profile, blind_and_fenced], ids=["free", "fenced"])
def test_a_robot_whose_odometry_falls_silent_is_stopped(change: Any, source: str) -> None:
    rig = Rig(change)
    rig.motion.goals._programs = rig.motion._executor._programs = Box()  # type: ignore[assignment]
    if source == "plan":
        rig.begin("drive 1 m")
    elif source == "program":
        rig.turn = 1
        rig.link.send("program", 1, code="drives", mode="queue")
    driven(rig, source, 1.5)
    assert rig.robot.true_twist.vx_mps > 0.25
    at_m = rig.robot.true_pose.x_m
    rig.network.holds_back = True
    driven(rig, source, 5.0)
    assert rig.robot.true_twist.is_zero
    assert rig.robot.true_pose.x_m - at_m < 0.3 * 0.25 + 0.06, "zero after 0.2 s, and the way to stand"
    if source in ("relay", "stick"):
        told = [event.reason.code for event in rig.events if isinstance(event, Notice)]
        assert told.count("odometry_silent") == 1
    else:
        end = rig.end_of(1)
        assert end is not None
        assert end.outcome == "failed"
        assert end.reason is not None
        assert end.reason.code == "odometry_silent"


def test_it_is_told_to_stand_in_time_and_goes_on_where_the_silence_was_short() -> None:
    rig = Rig()
    rig.begin("drive 1 m")
    rig.pass_time(1.5)
    rig.network.holds_back = True
    rig.pass_time(0.22)
    assert rig.velocities[-1] == TwistMessage(0.0, 0.0, 0.0), "the robot then stands within 250 ms"
    rig.pass_time(0.16)
    assert rig.robot.true_twist.is_zero
    rig.network.let_go()
    rig.pass_time(6.0)
    end = rig.end_of(1)
    assert end is not None
    assert end.outcome == "completed"
    assert rig.robot.true_pose.x_m == pytest.approx(1.0, abs=0.02)
    assert "odometry" in [event.rule for event in rig.events if isinstance(event, Limited)], "and it is told"


def test_with_news_that_grows_old_it_only_ever_goes_slower() -> None:
    rig = Rig()
    rig.begin("drive 2 m")
    rig.pass_time(2.0)
    rig.network.holds_back = True
    before = len(rig.velocities)
    rig.pass_time(0.6)
    speeds = [velocity.vx_mps for velocity in rig.velocities[before:]]
    assert speeds == sorted(speeds, reverse=True)
    assert any(0.0 < speed < 0.25 for speed in speeds)
    assert speeds[-1] == 0.0


def test_what_others_send_is_let_through_again_once_odometry_is_back() -> None:
    rig = Rig()
    driven(rig, "relay", 1.0)
    rig.network.holds_back = True
    driven(rig, "relay", 1.0)
    assert rig.robot.true_twist.is_zero
    rig.network.let_go()
    rig.pass_time(0.5)  # they let go
    driven(rig, "relay", 1.0)
    assert rig.robot.true_twist.vx_mps > 0.25
