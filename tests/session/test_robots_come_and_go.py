"""Robots come and go: whatever the network does, the session tells, the robot stops, and all goes on afterwards.

The doubles stand between Motion and an honest simulated robot, in simulated time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event, Finished, Notice
from chatrobot.core.reason import Reason
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.session.guard_link import SimulatedGuard
from chatrobot.session.joint import SimulatedJoint
from chatrobot.session.motion import Motion
from chatrobot.session.planner import Planner
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Message, TwistMessage
from chatrobot.wire.ros_messages import stamped
from chatrobot.wire.stamps import StampTranslator
from chatrobot.wire.wire import M, Wire

FAST = TwistMessage(0.4, 0.0, 0.0)


@dataclass
class Network:
    """What lies between a far Motion and its robot.

    `is_down` loses everything both ways; `holds_back` keeps what the robot says until it ends; `ahead_s` is how much
    the robot's clock is ahead of ours.
    """

    clock: VirtualClock
    is_down: bool = False
    holds_back: bool = False
    ahead_s: float = 0.0
    held: list[Callable[[], None]] = field(default_factory=list)

    def let_go(self) -> None:
        """All that was held back pours in at once."""
        self.holds_back = False
        held, self.held = self.held, []
        for deliver in held:
            deliver()


class FarWire:
    """An end of the wire on the other side of that network; translates stamps as every network's backend does."""

    def __init__(self, inner: Wire, network: Network) -> None:
        self._inner, self._network = inner, network

    def publish(self, topic: str, message: Message) -> None:
        if not self._network.is_down:
            self._inner.publish(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        translator, network = StampTranslator(), self._network

        def deliver(message: Any) -> None:
            timed = stamped(message)
            if timed is not None:
                sent_s = timed.stamp_s
                message = timed._replace(stamp_s=translator.local_s(sent_s, network.clock.now_s()))
            callback(message)

        def hear(message: Any) -> None:
            timed = stamped(message)
            if timed is not None:
                message = timed._replace(stamp_s=1e6 + timed.stamp_s + network.ahead_s)
            if network.holds_back:
                network.held.append(lambda: deliver(message))
            elif not network.is_down:
                deliver(message)

        self._inner.subscribe(topic, kind, hear)

    def close(self) -> None:
        self._inner.close()


class Rig:
    """Motion on one side, the robot on the other; the robot holds its last command for ever."""

    def __init__(self, change: Callable[[RobotProfile], RobotProfile] = lambda profile: profile) -> None:
        profile = change(load_profile("wheeltec_mini_mec"))
        self.clock, self.hub = VirtualClock(), MemoryHub()
        self.network = Network(self.clock)
        self.robot = SimRobot(
            load_profile("wheeltec_mini_mec"),
            load_world("empty"),
            wire=self.hub.connect(),
            clock=self.clock,
        )
        self.velocities: list[TwistMessage] = []
        self.hub.connect().subscribe("cmd_vel", TwistMessage, self.velocities.append)
        self.events: list[Event] = []
        self.each_step: Callable[[], None] = lambda: None
        wire, guard = FarWire(self.hub.connect(), self.network), SimulatedGuard(self.clock)

        def build(emit: Callable[[Event], None]) -> Motion:
            planner = Planner(profile, load_world("empty"))
            self.motion = Motion(profile, wire, self.clock, planner, guard, emit, lambda job: job())
            return self.motion

        self.joint = SimulatedJoint(
            build, wire, self.clock, self._advance, guard, self.hub.connect(), "cmd_vel"
        )
        self.turn = 0
        self.pass_time(0.4)

    def _advance(self, duration_s: float) -> None:
        self.each_step()
        self.robot.step(duration_s)

    def pass_time(self, duration_s: float) -> None:
        ends_s = self.clock.now_s() + duration_s
        while self.clock.now_s() < ends_s - 1e-9:
            event = self.joint.next_event(0.02)
            if event is not None:
                self.events.append(event)

    def begin(self, plan_text: str) -> None:
        self.turn += 1
        self.joint.send("plan", self.turn, plan_text=plan_text, mode="queue")

    def end_of(self, turn: int) -> Finished | None:
        ends = (event for event in self.events if isinstance(event, Finished) and event.turn == turn)
        return next(ends, None)

    def do(self, plan_text: str, patience_s: float = 30.0) -> Finished:
        self.begin(plan_text)
        ends_s = self.clock.now_s() + patience_s
        while self.clock.now_s() < ends_s:
            self.pass_time(0.02)
            end = self.end_of(self.turn)
            if end is not None:
                return end
        raise AssertionError(f"turn {self.turn} did not end")

    def notices(self) -> list[str]:
        return [event.reason.code for event in self.events if isinstance(event, Notice)]

    @property
    def stands(self) -> bool:
        return self.robot.true_twist.speed_mps < 0.005

    def drive_and_lose_the_network(self) -> None:
        self.begin("drive 5 m at 0.5 m/s")
        self.pass_time(2.0)
        assert not self.stands
        self.network.is_down = True


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


def test_where_the_wire_is_closed_for_good_all_that_was_asked_for_has_failed(rig: Rig) -> None:
    rig.begin("drive 5 m")
    rig.begin("drive 1 m")
    rig.pass_time(1.0)
    rig.motion.give_up(Reason("wire_gone"))
    rig.events += rig.joint._events  # type: ignore[attr-defined]
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
    assert rig.motion.zeroing.is_active, "zeros go on"


class TestTwoPublishers:
    """Somebody else drives at 50 Hz, too, whatever we say."""

    @pytest.fixture
    def rig(self) -> Rig:
        rig = Rig()
        other = rig.hub.connect()
        rig.motion.zeroing.others = "/teleop"
        rig.each_step = lambda: other.publish("cmd_vel", FAST)
        return rig

    def test_on_stop_zeros_go_on_and_the_other_is_named(self, rig: Rig) -> None:
        rig.joint.send("stop")
        rig.pass_time(5.0)
        [said] = [event.reason for event in rig.events if isinstance(event, Notice)]
        assert (said.code, said.values["who"]) == ("not_ours_alone", "/teleop")
        count = len(rig.velocities)
        rig.pass_time(1.0)
        assert rig.velocities[count:].count(TwistMessage(0.0, 0.0, 0.0)) >= 45

    def test_nothing_of_ours_begins_while_it_does_not_stand(self, rig: Rig) -> None:
        rig.joint.send("stop")
        rig.pass_time(3.0)
        end = rig.do("drive 0.3 m")
        assert (end.outcome, end.reason and end.reason.code) == ("refused", "not_ours_alone")

    def test_once_the_other_has_left_all_goes_on(self, rig: Rig) -> None:
        rig.joint.send("stop")
        rig.pass_time(3.0)
        rig.each_step = lambda: None
        rig.pass_time(1.0)
        assert rig.stands
        assert rig.do("drive 0.3 m").outcome == "completed"

    def test_where_nobody_is_known_the_robot_is_said_to_move_on(self, rig: Rig) -> None:
        rig.motion.zeroing.others = ""
        rig.joint.send("stop")
        rig.pass_time(5.0)
        assert rig.notices() == ["moves_on"]

    def test_it_does_not_keep_motion_from_ending(self, rig: Rig) -> None:
        rig.joint.send("stop")
        rig.pass_time(3.0)
        rig.joint.close()


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
        rig.joint.send("stop")
        rig.pass_time(3.0)
        assert rig.stands
        self.asks = TwistMessage(0.0, 0.0, 0.0)
        rig.pass_time(0.1)
        self.asks = self.ASKED
        rig.pass_time(1.0)
        assert not rig.stands

    def test_silence_is_letting_go_too(self, rig: Rig) -> None:
        rig.pass_time(1.0)
        rig.joint.send("stop")
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
        rig.joint.send("emergency_stop")
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
