"""Robots come and go: whatever the network does, the session tells, the robot stops, and all goes on afterwards.

The doubles stand between Motion and an honest simulated robot, in simulated time.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.motion.far_robot import Rig

from chatrobot.core.reason import Reason
from chatrobot.wire.messages import TwistMessage

FAST = TwistMessage(0.4, 0.0, 0.0)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_when_wifi_goes_the_plan_ends_and_says_why(rig: Rig) -> None:
    rig.drive_and_lose_the_network()
    rig.pass_time(0.5)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "odometry_silent")


def test_a_base_that_drove_on_meanwhile_is_halted_as_soon_as_it_is_seen_again(rig: Rig) -> None:
    rig.drive_and_lose_the_network()
    rig.pass_time(10.0)
    assert not rig.stands  # it holds its last command: nothing here could reach it
    rig.network.is_down = False
    rig.pass_time(0.6)
    assert rig.stands


def test_after_wifi_is_back_all_goes_on(rig: Rig) -> None:
    rig.drive_and_lose_the_network()
    rig.pass_time(10.0)
    assert rig.do("drive 0.3 m").outcome == "failed"
    rig.network.is_down = False
    rig.pass_time(1.0)
    end = rig.do("drive 0.3 m")
    assert end.outcome == "completed"
    assert end.path_m == pytest.approx(0.3, abs=0.02)


def test_who_leaves_a_robot_out_of_sight_leaves_its_guard_at_work(rig: Rig) -> None:
    said: list[str] = []
    rig.motion._guard.goodbye = lambda: said.append("goodbye")  # type: ignore[method-assign]
    rig.do("drive 0.1 m")
    rig.motion.leave()
    assert said == ["goodbye"]
    rig.begin("drive 2 m")
    rig.pass_time(1.0)
    rig.network.is_down = True
    rig.pass_time(4.0)
    rig.motion.leave()
    assert said == ["goodbye"], "its base may hold the last command for ever"


def test_who_leaves_a_robot_that_stood_when_it_was_last_seen_takes_the_guard_along(rig: Rig) -> None:
    """Ctrl-C at a simulated robot, and then at control: nobody is left who could move."""
    said: list[str] = []
    rig.motion._guard.goodbye = lambda: said.append("goodbye")  # type: ignore[method-assign]
    rig.do("drive 0.1 m")
    rig.pass_time(0.5)
    rig.network.is_down = True
    rig.pass_time(0.5)
    rig.motion.halt(Reason("stopped"))
    rig.pass_time(4.0)
    assert rig.motion.stop_confirmation.has_lost_sight
    rig.motion.leave()
    assert said == ["goodbye"]


def test_where_the_wire_is_closed_for_good_all_that_was_asked_for_has_failed(rig: Rig) -> None:
    rig.begin("drive 5 m")
    rig.begin("drive 1 m")
    rig.pass_time(1.0)
    rig.motion.give_up(Reason("wire_gone"))
    rig.events += rig.link.events  # type: ignore[attr-defined]
    ends = [rig.end_of(turn) for turn in (1, 2)]
    assert [(end.outcome, end.reason and end.reason.code) for end in ends if end] == [
        ("failed", "wire_gone")
    ] * 2
    assert ends[0] is not None
    assert ends[0].path_m > 0.1, "what it has done is told"


def test_a_robot_that_stood_all_the_while_gets_no_zeros_when_it_is_back(rig: Rig) -> None:
    """Somebody else may drive it by then."""
    rig.begin("drive 0.2 m")
    rig.pass_time(5.0)
    rig.network.is_down = True
    rig.pass_time(10.0)
    rig.network.is_down = False
    count = len(rig.velocities)
    rig.pass_time(1.0)
    assert len(rig.velocities) == count


def test_what_a_network_held_up_is_no_news(rig: Rig) -> None:
    """The robot's words of two seconds pour in at once: they say where it was."""
    rig.begin("drive 5 m at 0.5 m/s")
    rig.pass_time(1.0)
    rig.network.holds_back = True
    rig.pass_time(2.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "odometry_silent")
    rig.network.let_go()
    rig.pass_time(1.0)
    assert rig.stands
    assert rig.do("drive 0.3 m").outcome == "completed"


def test_odometry_that_comes_but_is_old_ends_the_plan(rig: Rig) -> None:
    rig.begin("drive 5 m at 0.5 m/s")
    rig.pass_time(1.0)
    rig.network.holds_back = True

    def trickle() -> None:
        """One message in two comes on: it falls ever further behind."""
        if rig.network.held:
            rig.network.held.pop(0)()

    rig.each_step = trickle
    rig.pass_time(4.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "odometry_silent")


@pytest.mark.parametrize("ahead_s", [3600.0, -3600.0, 0.3])
def test_a_robots_clock_may_be_set_while_it_drives(rig: Rig, ahead_s: float) -> None:
    rig.network.ahead_s = 7200.0
    rig.begin("drive 1 m")
    rig.pass_time(1.0)
    rig.network.ahead_s += ahead_s
    rig.pass_time(6.0)
    end = rig.end_of(1)
    assert end is not None
    if end.outcome == "completed":
        assert rig.robot.true_pose.x_m == pytest.approx(1.0, abs=0.03)
    assert rig.stands
    assert rig.do("drive 0.3 m").outcome == "completed"


def test_where_there_is_no_odometry_it_says_on_which_topic() -> None:
    silent = Rig(lambda profile: replace(profile, wiring=replace(profile.wiring, odom_topic="odom_combined")))
    end = silent.do("drive 0.3 m")
    assert end.reason is not None
    assert (end.outcome, end.reason.code, end.reason.values["topic"]) == (
        "failed",
        "no_odometry",
        "odom_combined",
    )
    assert silent.stands


def test_a_robot_that_does_not_answer_is_said_not_to() -> None:
    deaf = Rig(lambda profile: replace(profile, wiring=replace(profile.wiring, cmd_vel_topic="nobody")))
    end = deaf.do("drive 1 m")
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "does_not_move")


def test_a_plan_whose_robot_moves_on_at_its_end_is_not_completed(rig: Rig) -> None:
    somebody = rig.hub.connect()
    rig.begin("drive 0.3 m")
    rig.pass_time(0.8)
    rig.each_step = lambda: somebody.publish("cmd_vel", TwistMessage(0.0, 0.0, 0.4))
    rig.pass_time(8.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "moves_on")
    assert rig.motion.stop_confirmation.is_active, "zeros go on"
