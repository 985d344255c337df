"""Programs in a session, while they run or are being written: approved, stopped, paused, given arguments."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from tests.dialogue.program_rig import ARGUED, ASKED, BROKEN, DANCE, House
from tests.programs.scripted_model import ScriptedModel, fenced, program

from chatrobot.core.events import (
    Event,
    ModelCalled,
    Paused,
    ProgramLog,
    ProgramRehearsed,
    ProgramWritten,
    Rehearsed,
    Result,
    TruePose,
)
from chatrobot.dialogue.options import Options
from chatrobot.models.seam import CallLimits, Message, Usage
from chatrobot.programs.library import KeptProgram


@pytest.mark.parametrize("by_model", [True, False])
def test_on_a_real_robot_a_program_of_a_model_is_asked_about_and_one_of_ours_is_not(
    house: House, by_model: bool
) -> None:
    house.session.options = replace(Options(), approve_models=True)
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    if by_model:
        house.model(fenced(DANCE + "# asked about\n"))
    result = house.do(ASKED if by_model else "Generate a ROS 2 Python program to drive forward 25 cm")
    assert house.all(Rehearsed)[0].needs_approval is by_model
    assert result.outcome == "completed"


def test_a_program_is_asked_about_while_a_speed_limit_of_the_person_holds(house: House) -> None:
    house.on_event = lambda event: (
        house.session.approve(event.turn, False)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    house.do("never go faster than 0.1 m/s")
    assert house.do("Generate a ROS 2 Python program to drive forward 25 cm").outcome != "completed"
    assert house.all(Rehearsed)[0].needs_approval
    house.do("no speed limit")


def test_a_stop_ends_a_program_that_never_would(house: House) -> None:
    def stop_soon(event: Event) -> None:
        if isinstance(event, TruePose) and event.vx_mps > 0.15:
            house.session.stop("test")

    house.on_event = stop_soon
    result = house.run(program("while True:\n    self.drive(0.2, 0.0, 0.1)"))
    assert "program_endless" in house.findings
    assert result.outcome == "stopped"
    assert result.path_m < 1.0


@pytest.mark.parametrize("word", ["pause", "hold on", "暂停"])
def test_a_pause_stops_a_program_and_says_so(house: House, word: str) -> None:
    said: list[int] = []

    def pause_soon(event: Event) -> None:
        if isinstance(event, TruePose) and event.vx_mps > 0.15 and not said:
            said.append(house.session.say(word))

    house.on_event = pause_soon
    result = house.run(program("while True:\n    self.drive(0.2, 0.0, 0.1)"))
    assert result.outcome == "stopped"
    assert result.reason is not None
    assert result.reason.code == "program_not_paused"
    assert result.reply.startswith("Stopped (a program cannot be paused, so it was stopped).")
    assert result.path_m < 1.0
    assert not house.session.is_paused
    assert house.all(Paused) == []
    stood = house.do("continue")
    assert (stood.outcome, stood.proposal, stood.path_m) == ("answered", None, 0.0)


def test_a_program_that_raises_in_rehearsal_never_moves(house: House) -> None:
    result = house.run(program("self.drive(0.2, 0.0, 1.0)\nraise ValueError('on purpose')"))
    assert (result.outcome, result.path_m) == ("refused", 0.0)
    assert "ValueError: on purpose" in result.reply
    assert house.all(ProgramRehearsed)[0].line > 0


def test_what_a_program_logs_is_told_as_it_comes(house: House) -> None:
    house.run(program("self.get_logger().info('first')\nself.drive(0.1, 0.0, 0.5)\nprint('second')"))
    logs = house.all(ProgramLog)
    assert [log.text for log in logs] == ["[mover] first", "second"]
    assert logs[1].t_s - logs[0].t_s == pytest.approx(0.5, abs=0.05)


LISTENER = """\
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class Listener(Node):
    def __init__(self):
        super().__init__('listener')
        self.publisher_ = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.start = None
        self.done = False

    def on_odom(self, message):
        position = message.pose.pose.position
        self.start = self.start or position
        far = ((position.x - self.start.x) ** 2 + (position.y - self.start.y) ** 2) ** 0.5
        self.done = far > 0.3
        twist = Twist()
        twist.linear.x = 0.0 if self.done else 0.2
        self.publisher_.publish(twist)


rclpy.init()
node = Listener()
while rclpy.ok() and not node.done:
    rclpy.spin_once(node)
node.destroy_node()
rclpy.shutdown()
"""


def test_a_program_listens_to_odometry_and_ends_where_it_wants(house: House) -> None:
    result = house.run(LISTENER)
    assert result.outcome == "completed", result.reply
    assert result.path_m == pytest.approx(0.33, abs=0.03)


def test_a_wrong_topic_is_noticed_and_led_to_the_robot_with_a_yes(house: House) -> None:
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.run(DANCE.replace("'/cmd_vel'", "'/turtle1/cmd_vel'"))
    assert "other_topic" in house.marks
    assert house.all(Rehearsed)[0].needs_approval
    assert result.outcome == "completed"
    assert result.path_m > 0.1


def test_a_kept_program_is_rehearsed_in_todays_world(house: House, tmp_path: Path) -> None:
    far = program("self.drive(0.5, 0.0, 20.0)")
    assert house.run(far).outcome == "completed"
    home = House("home", tmp_path)
    result = home.run(far)
    home.connection.close()
    assert result.outcome == "refused"
    assert "would_collide" in home.findings


def test_a_kept_program_is_given_the_arguments_behind_two_dashes(house: House) -> None:
    house.authoring.library.keep(KeptProgram("slow dash", ARGUED))
    result = house.do("run the slow dash -- --ros-args -p speed:=0.3 -r velocity:=/cmd_vel")
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.3, abs=0.02)


@pytest.mark.parametrize("arguments", ["--ros-args -p speed", "--ros-args --params-file x.yaml", "'open"])
def test_arguments_that_cannot_be_given_refuse_it(house: House, arguments: str) -> None:
    house.authoring.library.keep(KeptProgram("slow dash", ARGUED))
    result = house.do(f"run the slow dash -- {arguments}")
    assert result.outcome == "refused"
    assert "arguments" in result.reply
    assert "参数" in house.do(f"运行 slow dash -- {arguments}").reply


SHUT_DOWN_TWICE = f"{ARGUED.replace('velocity', 'cmd_vel')}rclpy.shutdown()\nrclpy.shutdown()\n"


def test_a_program_that_shuts_down_twice_is_asked_about_and_drives_for_a_yes(house: House) -> None:
    def answer(event: Event) -> None:
        if isinstance(event, Rehearsed) and event.needs_approval:
            house.session.approve(event.turn, True)

    house.on_event = answer
    house.session.options = Options(ask_findings=True)
    result = house.run(SHUT_DOWN_TWICE)
    assert house.findings == ["program_raised_at_end"]
    assert house.all(Rehearsed)[0].needs_approval
    assert result.path_m == pytest.approx(0.1, abs=0.02)
    assert (result.outcome, result.reason and result.reason.code) == ("failed", "program_raised")
    assert house.all(TruePose)[-1].vx_mps == 0.0


def test_a_model_mends_its_program_that_fails_after_its_last_zero(house: House) -> None:
    house.model(fenced(SHUT_DOWN_TWICE), fenced(DANCE))
    assert house.do(ASKED).outcome == "completed"
    assert [written.version for written in house.all(ProgramWritten)] == [1, 2]


class WritesSlowly:
    """A model that writes once it is allowed to, and takes no notice of being cancelled."""

    name = "slow:test"

    def __init__(self, text: str = "") -> None:
        self.text = text
        self.may_write = threading.Event()
        self.usage: Usage | None = None

    def ask(self, messages: Sequence[Message], limits: CallLimits) -> WritesSlowly:
        del messages, limits
        return self

    def __iter__(self) -> Iterator[str]:
        self.may_write.wait(30.0)
        yield self.text

    def cancel(self) -> None:
        """It does not hear of it."""

    def forget(self) -> None:
        """It holds no conversation."""


def test_while_a_model_writes_the_session_goes_on_and_what_is_said_comes_after_it(house: House) -> None:
    model = house.authoring.model = WritesSlowly(fenced(DANCE + "# slowly\n"))
    house.events.clear()
    session = house.session
    turn = session.say(ASKED)
    session.pump(0.0)
    began_s, later = time.monotonic(), session.say("where are you?")
    for _ in range(3):
        session.pump(0.02)
    assert time.monotonic() - began_s < 5.0, "nothing waits for the model"
    assert session.model_wait_s is not None
    assert not session.is_idle
    assert not house.all(Result), "what was said after it keeps its place"
    model.may_write.set()
    while later not in session.results:
        session.pump(0.1)
    assert [result.turn for result in house.all(Result)] == [turn, later]
    assert session.results[turn].outcome == "completed"
    assert session.model_wait_s is None


@pytest.mark.parametrize("word", ["stop", "停", "pause"])
def test_a_stop_ends_the_writing_even_where_the_model_takes_no_notice(house: House, word: str) -> None:
    house.authoring.model = WritesSlowly()
    house.events.clear()
    session = house.session
    turn = session.say(ASKED)
    session.pump(0.0)
    stop = session.say(word)
    for _ in range(3):
        session.pump(0.02)
    assert [session.results[number].outcome for number in (turn, stop)] == ["stopped", "stopped"]
    (called,) = house.all(ModelCalled)
    assert (called.model, called.counted) == ("slow:test", False)
    assert house.do("where are you?").outcome == "answered"


def test_a_stop_ends_the_mending_and_what_was_wrong_is_said(house: House) -> None:
    house.model(fenced(BROKEN["an exception"][0]))
    house.on_event = lambda event: (
        setattr(house.authoring, "model", WritesSlowly()) if isinstance(event, ProgramWritten) else None
    )
    session = house.session
    turn = session.say(ASKED)
    while session.model_wait_s is None or isinstance(house.authoring.model, ScriptedModel):
        session.pump(0.02)
    stop = session.say("stop")
    while stop not in session.results:
        session.pump(0.02)
    assert session.results[turn].outcome == "refused"
    assert "AttributeError" in session.results[turn].reply
    assert session.is_idle
