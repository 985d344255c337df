"""A robot without odometry: driven on request alone, slowly and briefly, and nothing is told of it as measured."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.clock import TICK_S
from chatrobot.core.errors import UsageError
from chatrobot.core.event import event_from_json
from chatrobot.core.events import Finished, Notice
from chatrobot.core.geometry import Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import UNSEEN_S
from chatrobot.governor.governor import Governor
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.topic_link import TopicLink
from chatrobot.motion.safety.competing_controllers import CompetingControllers
from chatrobot.motion.safety.connection_monitor import ConnectionMonitor
from chatrobot.motion.safety.stop import PATIENCE_S
from chatrobot.robots.load import list_profiles, load_profile
from chatrobot.robots.open_loop import (
    OPEN_LOOP_MPS,
    OPEN_LOOP_RADPS,
    OPEN_LOOP_S,
    as_chosen,
    driven_open_loop,
)
from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget, RobotProfile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import check_known
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import TwistMessage
from chatrobot.wire.wire import Wire
from tests.dialogue.undo_rig import UndoRig
from tests.motion.far_robot import Rig

ZERO = TwistMessage(0.0, 0.0, 0.0)
UNCONFIRMED = "Stop sent. There is no odometry, so I cannot confirm that the robot stopped."


def without_odometry(profile: RobotProfile) -> RobotProfile:
    wiring = replace(profile.wiring, odom_topic="", imu_topic=None, scan_topic=None)
    return replace(profile, wiring=wiring, lidar=None)


def open_loop(profile: RobotProfile) -> RobotProfile:
    return driven_open_loop(without_odometry(profile))


@pytest.fixture
def rig() -> Rig:
    return Rig(open_loop)


def talk() -> UndoRig:
    return UndoRig(profile=driven_open_loop(load_profile("no_odometry")))


def moving_s(velocities: list[TwistMessage]) -> float:
    return sum(any(twist) for twist in velocities) * TICK_S


# --- on request alone ---


def test_a_robot_without_odometry_does_not_move_unless_that_was_asked_for() -> None:
    rig = Rig(without_odometry)
    end = rig.do("drive 0.3 m")
    assert (end.outcome, end.reason and end.reason.code) == ("refused", "needs_open_loop")
    assert not any(map(any, rig.velocities))


def test_nor_do_others_drive_it_through_us() -> None:
    rig = Rig(without_odometry)
    other = rig.hub.connect()
    for topic in ("chatrobot/cmd_vel", "chatrobot/joystick"):
        rig.each_step = lambda topic=topic: other.publish(topic, TwistMessage(0.1, 0.0, 0.0))  # type: ignore[misc]
        rig.pass_time(1.0)
    assert not any(map(any, rig.velocities))
    assert "needs_open_loop" in rig.notices()


@pytest.mark.parametrize("entry", [e for e in list_profiles() if e.load().has_odometry], ids=lambda e: e.name)
def test_a_robot_whose_profile_has_odometry_is_never_driven_open_loop(entry: Any) -> None:
    with pytest.raises(UsageError, match="has odometry"):
        as_chosen(entry.load(), NOT_CHOSEN, open_loop=True)


def test_lost_odometry_is_no_reason_to_drive_open_loop() -> None:
    rig = Rig()
    rig.begin("drive 5 m")
    rig.pass_time(1.0)
    rig.robot._odometry.read = lambda *_: None  # type: ignore[method-assign]
    rig.pass_time(3.0)
    count = len(rig.velocities)
    for _ in range(2):
        end = rig.do("drive 0.3 m")
        assert (end.outcome, end.measured) == ("failed", True)
    assert not any(map(any, rig.velocities[count:]))


def test_a_profile_file_cannot_ask_for_it() -> None:
    assert not any(entry.load().open_loop for entry in list_profiles())


# --- within its bounds ---


@given(st.lists(st.tuples(*[st.floats(-10.0, 10.0)] * 3), min_size=1, max_size=30))
def test_the_governor_sends_nothing_faster(asked: list[tuple[float, float, float]]) -> None:
    for name in ("wheeltec_mini_mec", "wheeltec_mini_akm", "turtlesim"):
        # The flag alone, without the limits that go with it: the governor has them of its own.
        governor = Governor(replace(without_odometry(load_profile(name)), open_loop=True), StopEpoch())
        governor.leases.open("lease", "console", math.inf, 0.0)
        assert governor.begin("lease", 0.0).refusal is None
        for tick, twist in enumerate(asked):
            sent = governor.govern(Twist(*twist), "lease", 0.1 * tick).sent.twist
            assert sent.speed_mps <= OPEN_LOOP_MPS + 1e-9
            assert abs(sent.wz_radps) <= OPEN_LOOP_RADPS + 1e-9


def test_a_text_that_is_known_to_last_longer_is_refused_with_the_number(rig: Rig) -> None:
    end = rig.do("drive 3 m")
    assert (end.outcome, end.reason and end.reason.code) == ("refused", "over_open_loop_time")
    assert end.reason is not None
    assert end.reason.values["max_s"] == OPEN_LOOP_S


@pytest.mark.parametrize("chosen", [math.inf, 600.0, 12.0, None])
def test_no_choice_makes_it_longer(chosen: float | None) -> None:
    budget = MotionBudget(max_time_s=chosen)
    profile = as_chosen(without_odometry(load_profile("wheeltec_mini_mec")), budget, open_loop=True)
    assert profile.safety.budget.changed(MotionBudget(max_time_s=math.inf)).time_s == OPEN_LOOP_S
    rig = Rig(lambda _: profile)
    rig.link.send("limit", max_time_s="none")
    rig.pass_time(0.1)
    assert rig.do("drive 3 m").outcome == "refused"


def test_a_shorter_time_may_be_chosen() -> None:
    budget = MotionBudget(max_time_s=2.0)
    profile = as_chosen(without_odometry(load_profile("wheeltec_mini_mec")), budget, open_loop=True)
    end = Rig(lambda _: profile).do("drive 1 m")
    assert (end.outcome, end.reason and end.reason.code) == ("refused", "over_max_time")


def test_what_does_not_end_by_itself_is_ended_in_time() -> None:
    """Parts that come while it is driven, each short enough."""
    rig = Rig(open_loop)
    rig.turn += 1
    rig.link.send("plan", 1, plan_text="drive 1 m", mode="queue", more=True)
    for _ in range(5):
        rig.pass_time(0.5)
        rig.link.send("plan", 1, plan_text="drive 1 m", mode="extend", more=True)
    rig.link.send("plan", 1, plan_text="drive 1 m", mode="extend", more=False)
    rig.pass_time(20.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("stopped", "open_loop_time_reached")
    assert moving_s(rig.velocities) <= OPEN_LOOP_S + 2 * TICK_S


def test_zeros_after_a_stop_are_repeated_for_a_bounded_time(rig: Rig) -> None:
    rig.begin("drive 1 m")
    rig.pass_time(1.0)
    rig.link.send("stop", why="stop")
    rig.pass_time(0.1)
    count = len(rig.velocities)
    rig.pass_time(20.0)
    zeros = rig.velocities[count:]
    assert zeros == [ZERO] * len(zeros)
    assert 0 < len(zeros) <= PATIENCE_S / TICK_S + 2


def test_the_end_of_a_plan_is_a_bounded_row_of_zeros(rig: Rig) -> None:
    rig.do("drive 0.2 m")
    rig.pass_time(10.0)
    last = max(i for i, twist in enumerate(rig.velocities) if any(twist))
    assert 2 <= len(rig.velocities) - 1 - last <= UNSEEN_S / TICK_S + 3


# --- where odometry turns up ---


class Knowing(Wire):
    """An end of a wire on which somebody may begin to tell odometry."""

    knows_others = True

    def __init__(self, inner: Any) -> None:
        self._inner, self.odometry = inner, list[str]()

    def publish(self, topic: str, message: Any) -> None:
        self._inner.publish(topic, message)

    def subscribe(self, topic: str, kind: Any, callback: Any) -> None:
        self._inner.subscribe(topic, kind, callback)

    def close(self) -> None:
        self._inner.close()

    def publishers_of(self, topic: str) -> list[str]:
        return self.odometry if topic == "odom" else []


def test_where_odometry_turns_up_the_robot_is_stopped_and_told_why(rig: Rig) -> None:
    wire = Knowing(rig.hub.connect())
    profile = open_loop(load_profile("wheeltec_mini_mec"))
    said: list[Reason] = []
    competitors = CompetingControllers(wire, "chatrobot_motion", "cmd_vel")
    connection_monitor = ConnectionMonitor(
        wire, competitors, rig.motion, profile, said.append, accept_others=False
    )
    connection_monitor.look_around()
    rig.begin("drive 1 m")
    rig.pass_time(1.0)
    assert any(rig.velocities[-1])
    wire.odometry = ["/base"]
    connection_monitor.look_around()
    rig.pass_time(0.1)
    assert not any(rig.velocities[-1])
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason and end.reason.code) == ("stopped", "odometry_there")
    rig.pass_time(3.0)
    again = rig.do("drive 0.2 m")
    assert (again.outcome, again.reason and again.reason.code) == ("refused", "odometry_there")


# --- nothing pretends to know a pose ---


@pytest.mark.parametrize(
    "plan_text",
    [
        "go to 1 0",
        "go to 0 0 from start",
        'remember "here"',
        "face 90 deg",
        "repeat 2\n  drive 0.1 m\n  go to 0 0\nend",
    ],
)
def test_what_needs_a_pose_is_refused_before_anything_moves(rig: Rig, plan_text: str) -> None:
    end = rig.do(plan_text)
    assert (end.outcome, end.reason and end.reason.code) == ("refused", "needs_odometry")
    assert not any(map(any, rig.velocities))


@pytest.mark.parametrize(
    "said", ["undo", "no, I meant right", "come back", "where are you?", "how far did you go?"]
)
def test_no_reply_pretends_to_know_where_it_is(said: str) -> None:
    rig = talk()
    rig.do("forward 0.3 m")
    before = rig.robot.true_pose
    result = rig.do(said)
    assert result.outcome in ("refused", "answered", "unclear")
    assert "no odometry" in result.reply
    assert rig.robot.true_pose == before


def test_a_paused_plan_is_stopped_and_not_gone_on_with() -> None:
    rig = talk()
    turn = rig.session.say("forward 1 m")
    rig.live(1.0)
    rig.session.say("pause")
    rig.live(4.0)
    assert rig.session.results[turn].outcome == "stopped"
    where = rig.robot.true_pose
    rig.do("continue")
    rig.live(2.0)
    assert rig.robot.true_pose == where


def test_a_world_is_refused_for_nobody_knows_where_in_it_the_robot_is() -> None:
    profile = open_loop(load_profile("wheeltec_mini_mec"))
    with pytest.raises(UsageError, match="without odometry"):
        check_known(load_world("home"), profile)
    check_known(load_world("empty"), profile)


def test_what_can_be_checked_is_rehearsed() -> None:
    assert talk().do("slide left 30 cm").outcome == "refused"


# --- what is told ---


def test_a_motion_is_told_as_commanded_and_not_as_measured() -> None:
    result = talk().do("forward 0.3 m")
    assert (result.outcome, result.measured) == ("completed", False)
    assert result.reply == "Commanded, not measured: drive forward 0.3 m."


def test_a_scaled_velocity_is_told_as_it_was_sent() -> None:
    result = talk().do("linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0")
    assert "0.20 m" in result.reply
    assert "Commanded, not measured" in result.reply


@pytest.mark.parametrize(
    ("said", "told"), [("stop", UNCONFIRMED), ("停下", "没有里程计，无法确认机器人已停下。")]
)
def test_a_stop_is_told_as_sent(said: str, told: str) -> None:
    rig = talk()
    moved = rig.session.say("forward 1 m")
    rig.live(1.0)
    stopped = rig.session.say(said)
    rig.live(3.0)
    assert told in rig.session.results[stopped].reply
    assert rig.session.results[moved].outcome == "stopped"
    assert (
        "Stop sent" in rig.session.results[moved].reply
        or "停止指令已发出" in rig.session.results[moved].reply
    )


def test_a_stop_of_what_never_moved_says_that_nothing_was_commanded() -> None:
    rig = talk()
    turn = rig.session.say("wait 5 s")
    rig.live(1.0)
    rig.session.say("stop")
    rig.live(1.0)
    assert rig.session.results[turn].reply.startswith("Nothing was commanded")


def test_a_motion_that_was_broken_off_at_its_very_beginning_was_commanded() -> None:
    rig = talk()
    turn = rig.session.say("forward 1 m")
    while not any(event.name == "started" for event in rig.events):
        rig.session._link.step()  # type: ignore[attr-defined]
        rig.session.pump(0.0)
    rig.session.say("stop")
    rig.live(3.0)
    assert rig.session.results[turn].reply.startswith("Stop sent")


def test_no_event_carries_a_number_that_nobody_measured() -> None:
    rig = talk()
    for said in ("forward 0.3 m", "what can you do?", "undo", "forward 1 km"):
        rig.do(said)
    told = [json.loads(json.dumps(event.to_json())) for event in rig.events]
    checked = [line for line in told if line["event"] in ("started", "finished", "result")]
    assert {line["event"] for line in checked} == {"started", "finished", "result"}
    for line in checked:
        assert line["measured"] is False
        for key in ("pose", "start", "path_m", "turned_rad"):
            assert line.get(key) is None
    assert not any(line["event"] in ("telemetry", "progress") for line in told)


def test_an_unmeasured_event_survives_the_wire() -> None:
    end = Finished(
        1, "completed", None, *[talk().session.understanding.pose] * 2, 0.0, 0.0, 1.0, 0.0, measured=False
    )
    assert event_from_json(json.loads(json.dumps(end.to_json()))) == end


def test_it_is_told_once_at_the_start_how_the_robot_is_driven(rig: Rig) -> None:
    assert rig.notices() == ["open_loop"]


def test_a_base_that_was_not_told_learns_it_from_motion() -> None:
    """As of a control node that was started so: a stop must not be told as seen."""
    rig = UndoRig()
    rig.session._hear(Notice(0, Reason("open_loop", {})))
    assert rig.do("stop").reply == UNCONFIRMED


def test_simulated_time_keeps_the_notice_for_who_asks_later() -> None:
    rig = talk()
    assert isinstance(rig.session._link, InProcessLink)
    rig.live(0.1)
    assert [event.reason.code for event in rig.events if isinstance(event, Notice)] == ["open_loop"]


def test_a_base_that_comes_later_hears_from_controls_beats_how_the_robot_is_driven() -> None:
    hub = MemoryHub()
    link = TopicLink(hub.connect(), "base", is_on_this_machine=True)
    link.open()
    notice = Reason("open_loop", {"speed_mps": 0.2, "rate_radps": 0.5, "max_s": 10.0})
    competitors = CompetingControllers(hub.connect(), "chatrobot_control", "cmd_vel", notice)
    competitors.note_source(link._sender.lease)
    competitors.beat()
    assert link.next_event(1.0) == Notice(0, notice)
    competitors.beat()
    assert link.next_event(0.05) is None, "once"
    link.close()
