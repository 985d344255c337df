"""Others drive the same robot: past us, or through us. Ours stays safe, and says who it is."""

from __future__ import annotations

import pytest
from tests.motion.far_robot import Rig

from chatrobot.core.events import Notice
from chatrobot.wire.messages import TwistMessage

FAST = TwistMessage(0.4, 0.0, 0.0)


class TestTwoPublishers:
    """Somebody else drives at 50 Hz, too, whatever we say."""

    @pytest.fixture
    def rig(self) -> Rig:
        rig = Rig()
        other = rig.hub.connect()
        rig.motion.stop_confirmation.others = "/teleop"
        rig.each_step = lambda: other.publish("cmd_vel", FAST)
        return rig

    def test_on_stop_zeros_go_on_and_the_other_is_named(self, rig: Rig) -> None:
        rig.link.send("stop")
        rig.pass_time(5.0)
        [said] = [event.reason for event in rig.events if isinstance(event, Notice)]
        assert (said.code, said.values["who"]) == ("not_ours_alone", "/teleop")
        count = len(rig.velocities)
        rig.pass_time(1.0)
        assert rig.velocities[count:].count(TwistMessage(0.0, 0.0, 0.0)) >= 45

    def test_nothing_of_ours_begins_while_it_does_not_stand(self, rig: Rig) -> None:
        rig.link.send("stop")
        rig.pass_time(3.0)
        end = rig.do("drive 0.3 m")
        assert (end.outcome, end.reason and end.reason.code) == ("refused", "not_ours_alone")

    def test_once_the_other_has_left_all_goes_on(self, rig: Rig) -> None:
        rig.link.send("stop")
        rig.pass_time(3.0)
        rig.each_step = lambda: None
        rig.pass_time(1.0)
        assert rig.stands
        assert rig.do("drive 0.3 m").outcome == "completed"

    def test_where_nobody_is_known_the_robot_is_said_to_move_on(self, rig: Rig) -> None:
        rig.motion.stop_confirmation.others = ""
        rig.link.send("stop")
        rig.pass_time(5.0)
        assert rig.notices() == ["moves_on"]

    def test_it_does_not_keep_motion_from_ending(self, rig: Rig) -> None:
        rig.link.send("stop")
        rig.pass_time(3.0)
        rig.link.close()


class TestVelocitiesThroughUs:
    """Somebody was started with -r cmd_vel:=chatrobot/cmd_vel."""

    ASKED = TwistMessage(3.0, 0.0, 0.0)

    @pytest.fixture
    def rig(self) -> Rig:
        rig = Rig()
        other = rig.hub.connect()
        self.asks = self.ASKED

        def ask() -> None:
            other.publish("chatrobot/cmd_vel", self.asks)

        rig.each_step = ask
        return rig

    def test_they_drive_within_the_limits(self, rig: Rig) -> None:
        rig.pass_time(2.0)
        assert rig.robot.true_twist.vx_mps == pytest.approx(1.0, abs=0.01)
        assert max(twist.vx_mps for twist in rig.velocities) <= 1.0

    def test_when_they_end_the_robot_stands(self, rig: Rig) -> None:
        rig.pass_time(2.0)
        rig.each_step = lambda: None
        rig.pass_time(0.34)
        assert not any(rig.velocities[-1])
        rig.pass_time(1.0)
        assert rig.stands
        count = len(rig.velocities)
        rig.pass_time(1.0)
        assert len(rig.velocities) == count

    def test_a_stop_holds_until_they_have_let_go(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        rig.link.send("stop")
        rig.pass_time(3.0)
        assert rig.stands
        self.asks = TwistMessage(0.0, 0.0, 0.0)
        rig.pass_time(0.1)
        self.asks = self.ASKED
        rig.pass_time(1.0)
        assert not rig.stands

    def test_silence_is_letting_go_too(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        rig.link.send("stop")
        rig.pass_time(2.0)
        ask, rig.each_step = rig.each_step, lambda: None
        rig.pass_time(0.4)
        rig.each_step = ask
        rig.pass_time(1.0)
        assert not rig.stands

    def test_a_plan_takes_their_place_and_keeps_it(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        end = rig.do("drive 0.3 m")
        assert (end.outcome, end.path_m) == ("completed", pytest.approx(0.3, abs=0.02))
        rig.pass_time(1.0)
        assert rig.stands

    def test_an_emergency_stop_holds_for_them_too(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        rig.link.send("emergency_stop")
        rig.pass_time(1.5)
        rig.each_step, before = (lambda: None), rig.each_step
        rig.pass_time(0.5)
        rig.each_step = before
        rig.pass_time(1.0)
        assert rig.stands

    def test_what_is_no_number_stops(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        self.asks = TwistMessage(float("nan"), 0.0, 0.0)
        rig.pass_time(1.5)
        assert rig.stands

    def test_a_motion_that_froze_does_not_drive_on(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        rig.clock.advance(0.5)
        rig.robot.step(0.5)
        rig.pass_time(2.0)
        assert rig.stands
