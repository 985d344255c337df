"""However a motion ends, the last that the robot is sent is exactly zero; and its end is told once it stands."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from tests.motion.far_robot import Rig
from tests.safety.test_who_drives import Crowd

from chatrobot.core.events import Finished
from chatrobot.core.reason import Reason
from chatrobot.robots.open_loop import driven_open_loop
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import TwistMessage

CREEP = TwistMessage(0.0, 0.0, 0.0094)
"""So slow that a robot counts as standing by its speed."""


def begin(rig: Rig, plan_text: str, duration_s: float) -> None:
    """A plan that is under way for so long."""
    rig.begin(plan_text)
    rig.pass_time(duration_s)


def told_end(rig: Rig) -> Finished:
    end = rig.end_of(1)
    assert end is not None
    return end


def stop(rig: Rig) -> None:
    rig.link.send("stop")


def complete(rig: Rig) -> None:
    rig.pass_time(8.0)


def replace_it(rig: Rig) -> None:
    rig.link.send("plan", 2, plan_text="wait 0.1 s", mode="replace")


def lose_the_source(rig: Rig) -> None:
    rig.link.beats = False


def bring_it_to_jump(rig: Rig) -> None:
    rig.motion.sensors.estimator.fault = Reason("odometry_jumped", {"jump_m": 1.0})


def bump(rig: Rig) -> None:
    rig.motion.sensors.bumped = True


ENDS: list[Callable[[Rig], None]] = [
    stop,
    complete,
    replace_it,
    lose_the_source,
    bring_it_to_jump,
    bump,
]
PLANS = ["turn left 90 deg", "drive 0.5 m", "arc left 120 deg radius 0.4 m", "twist 0.004 0 0.015 for 1 s"]


@pytest.mark.parametrize("plan_text", PLANS)
@pytest.mark.parametrize("end", ENDS)
def test_after_any_end_the_last_command_is_exactly_zero(end: Callable[[Rig], None], plan_text: str) -> None:
    rig = Rig()
    begin(rig, plan_text, 0.6)
    end(rig)
    rig.pass_time(1.0)
    assert rig.velocities[-1] == TwistMessage(0.0, 0.0, 0.0)
    assert rig.robot.true_twist.is_zero
    count = len(rig.velocities)
    rig.pass_time(1.0)
    assert len(rig.velocities) == count, "it was seen standing, and then it is quiet"


@pytest.mark.parametrize("topic", ["chatrobot/cmd_vel", "chatrobot/joystick"])
def test_others_who_let_go_while_they_creep_leave_a_zero_behind(topic: str) -> None:
    rig = Rig()
    other = rig.hub.connect()
    rig.each_step = lambda: other.publish(topic, CREEP)
    rig.pass_time(1.0)
    assert rig.robot.true_twist.wz_radps == pytest.approx(CREEP.wz_radps)
    rig.each_step = lambda: None
    rig.pass_time(1.0)
    assert rig.velocities[-1] == TwistMessage(0.0, 0.0, 0.0)
    assert rig.robot.true_twist.is_zero


def blind(profile: RobotProfile) -> RobotProfile:
    return driven_open_loop(replace(profile, wiring=replace(profile.wiring, odom_topic="", imu_topic="")))


def test_a_robot_that_nobody_sees_is_sent_zeros_too() -> None:
    rig = Rig(blind)
    rig.do("turn left 50 deg")
    assert rig.velocities[-1] == TwistMessage(0.0, 0.0, 0.0)
    assert rig.robot.true_twist.is_zero


# --- when it is told ---


@pytest.mark.parametrize("after_s", [0.3, 1.0, 2.2])
@pytest.mark.parametrize("end", [stop, replace_it, lose_the_source, bring_it_to_jump, bump])
def test_what_is_told_of_a_motion_that_was_broken_off_is_where_it_stands(
    end: Callable[[Rig], None], after_s: float
) -> None:
    rig = Rig()
    begin(rig, "arc right 300 deg radius 0.5 m at 0.9 m/s", after_s)
    end(rig)
    rig.pass_time(1.5)
    told = told_end(rig)
    true = rig.robot.true_pose
    assert math.degrees(told.turned_rad) == pytest.approx(math.degrees(true.yaw_rad), abs=0.1)
    assert told.path_m == pytest.approx(-0.5 * true.yaw_rad, abs=0.005)
    assert told.pose.distance_to(true) < 0.005


def test_the_zero_does_not_wait_for_what_is_told() -> None:
    rig = Rig()
    begin(rig, "drive 5 m", 2.0)
    stop(rig)
    assert rig.velocities[-1] == TwistMessage(0.0, 0.0, 0.0), "it is out before anything else is done"
    assert rig.end_of(1) is None
    rig.pass_time(0.4)
    assert told_end(rig).outcome == "stopped"


def test_ends_are_told_in_their_order(tmp_path: Path) -> None:
    crowd = Crowd(tmp_path, "console")
    for turn in (1, 2, 3):
        crowd.say("console", "plan", turn, plan_text="drive 5 m")
    crowd.live(1.5)
    crowd.say("console", "stop")
    crowd.say("console", "plan", 4, plan_text="turn left 10 deg")
    crowd.live(3.0)
    told = [event.turn for event in crowd.events if isinstance(event, Finished)]
    assert told == [1, 2, 3, 4]
    assert crowd.end_of(4).outcome == "completed"


def when_told(rig: Rig, patience_s: float) -> float:
    """Seconds until turn 1 has been told to have ended."""
    for step in range(round(patience_s / 0.02)):
        if rig.end_of(1) is not None:
            return step * 0.02
        rig.pass_time(0.02)
    raise AssertionError(f"nothing was told within {patience_s} s")


def test_a_robot_that_does_not_stand_is_not_waited_for_longer_than_two_seconds() -> None:
    rig = Rig()
    other = rig.hub.connect()
    begin(rig, "drive 5 m", 1.0)
    rig.each_step = lambda: other.publish("cmd_vel", TwistMessage(0.3, 0.0, 0.0))
    stop(rig)
    assert when_told(rig, 3.0) == pytest.approx(2.0, abs=0.1)


def test_a_robot_that_is_out_of_sight_is_not_waited_for() -> None:
    rig = Rig()
    begin(rig, "drive 5 m", 1.0)
    rig.network.is_down = True
    rig.pass_time(0.3)
    stop(rig)
    assert when_told(rig, 3.0) <= 0.1


def test_a_joystick_that_takes_over_is_not_waited_for() -> None:
    rig = Rig()
    other = rig.hub.connect()
    begin(rig, "drive 5 m", 1.0)
    rig.each_step = lambda: other.publish("chatrobot/joystick", TwistMessage(0.0, 0.0, 0.5))
    assert when_told(rig, 3.0) <= 0.2
