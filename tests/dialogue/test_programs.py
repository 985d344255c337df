"""Programs in a session: asked for, written, rehearsed, mended, run, kept and asked for again."""

from __future__ import annotations

import itertools
import math
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.models.rig import model_at, serving
from tests.programs.requests import ROTATION, SQUARE
from tests.programs.scripted_model import ScriptedModel, fenced, program

from chatrobot.compose import Connection, Setup, connect
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
from chatrobot.models.usage import totals
from chatrobot.programs.library import KeptProgram

ASKED = "Write a ROS 2 Python program that makes the robot dance as you like"
ARGUED = """
import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
node = rclpy.create_node("driver")
publisher = node.create_publisher(Twist, "velocity", 10)
twist = Twist()
twist.linear.x = node.declare_parameter("speed", 0.1).value
publisher.publish(twist)
time.sleep(1.0)
publisher.publish(Twist())
"""
DANCE = program("self.drive(0.2, 0.0, 1.0)\nself.drive(0.0, 0.5, 2.0)")


class House:
    """A simulated robot on virtual time, with one warm box for many programs; each test tells it its own model."""

    def __init__(self, world: str, folder: Path) -> None:
        self.events: list[Event] = []
        self.on_event: Callable[[Event], None] = lambda _: None
        self.connection: Connection = connect(
            Setup(fast=True, trace=True, world=world, folder=folder, programs=True), self._hear
        )
        self.session = self.connection.session
        assert self.session.authoring is not None
        self.authoring = self.session.authoring

    def _hear(self, event: Event) -> None:
        self.events.append(event)
        self.on_event(event)

    def model(self, *replies: str) -> ScriptedModel:
        self.authoring.model = ScriptedModel(*replies)
        return self.authoring.model

    def do(self, text: str) -> Result:
        self.events.clear()
        return self.session.do(text)

    def run(self, code: str, name: str = "test") -> Result:
        self.events.clear()
        return self._end_of(self.session.say_draft(self.authoring.draft_of(KeptProgram(name, code))))

    def edit(self, name: str, code: str) -> Result:
        self.events.clear()
        return self._end_of(self.session.say_source(name, code))

    def _end_of(self, turn: int) -> Result:
        while turn not in self.session.results:
            self.session.pump(0.1)
        return self.session.results[turn]

    def all(self, kind: type[Any]) -> list[Any]:
        return [event for event in self.events if isinstance(event, kind)]

    @property
    def marks(self) -> list[str]:
        return [mark.reason.code for written in self.all(ProgramWritten) for mark in written.marks]

    @property
    def findings(self) -> list[str]:
        return [finding.reason.code for rehearsed in self.all(Rehearsed) for finding in rehearsed.findings]


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    house = House("empty", tmp_path_factory.mktemp("config"))
    yield house
    house.connection.close()


@pytest.fixture
def house(shared: House) -> Iterator[House]:
    yield shared
    shared.authoring.model, shared.authoring.prefers_model = None, False
    shared.on_event = lambda _: None
    shared.session.options = Options()


def turned_in(poses: list[TruePose]) -> tuple[float, float]:
    """Radians, and the seconds from the first motion to the last."""
    moving = [pose for pose in poses if abs(pose.wz_radps) > 1e-3 or abs(pose.vx_mps) > 1e-3]
    turned = sum((b.t_s - a.t_s) * 0.5 * (a.wz_radps + b.wz_radps) for a, b in itertools.pairwise(poses))
    return turned, moving[-1].t_s - moving[0].t_s


@pytest.mark.parametrize("writer", ["offline", "model"])
def test_the_tutorials_rotation_turns_three_radians_in_six_seconds(house: House, writer: str) -> None:
    if writer == "model":
        house.model(fenced(program("self.drive(0.0, 0.5, 6.0)")))
        house.authoring.prefers_model = True
    result = house.do(ROTATION)
    assert (result.outcome, house.all(ProgramWritten)[0].by) == ("completed", writer)
    turned_rad, took_s = turned_in(house.all(TruePose))
    assert turned_rad == pytest.approx(3.0, abs=0.02)
    assert took_s == pytest.approx(6.25, abs=0.1)  # the ramp down comes after the six seconds
    assert house.all(TruePose)[-1].wz_radps == 0.0
    assert house.all(ProgramRehearsed)[0].stands_at_end


@pytest.mark.parametrize("writer", ["offline", "model"])
def test_the_tutorials_square_drives_four_sides_and_four_turns_in_twenty_seconds(
    house: House, writer: str
) -> None:
    if writer == "model":
        house.model(
            fenced(
                program("for _ in range(4):\n    self.drive(0.2, 0.0, 3.0)\n    self.drive(0.0, 1.0, 2.0)")
            )
        )
        house.authoring.prefers_model = True
    result = house.do(SQUARE)
    assert result.outcome == "completed"
    assert result.turned_rad == pytest.approx(8.0, abs=0.03)
    assert result.path_m == pytest.approx(2.4, abs=0.05)
    _, took_s = turned_in(house.all(TruePose))
    assert took_s == pytest.approx(20.4, abs=0.2)
    rehearsed = house.all(Rehearsed)[0]
    assert rehearsed.duration_s == pytest.approx(21.0, abs=0.1)  # with the second of rest
    assert house.all(TruePose)[-1].vx_mps == 0.0


def test_what_the_square_promises_and_its_numbers_do_not_give_is_said(house: House) -> None:
    result = house.do(SQUARE)
    assert "promise_corner" in house.marks
    assert "115°" in result.reply


def test_a_sentence_becomes_a_program_that_does_what_the_plan_would(house: House) -> None:
    start = house.do("where are you?").pose
    result = house.do("Generate a ROS 2 Python program to drive forward 1 m and turn left 90 degrees.")
    assert result.outcome == "completed"
    assert result.pose.distance_to(start) == pytest.approx(1.0, abs=0.03)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.03)


def test_what_nobody_can_write_is_unclear_and_says_what_would_help(house: House) -> None:
    result = house.do("Write a ROS 2 Python program that makes the robot follow a ball")
    assert result.outcome == "unclear"
    assert "model" in result.reply


def test_with_a_model_what_the_offline_language_does_not_understand_is_written(house: House) -> None:
    model = house.model(fenced(DANCE))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    (written,) = house.all(ProgramWritten)
    assert (written.by, written.version, written.description) == ("model", 1, "Here you are.")
    assert [message.role for message in model.asked[0]] == ["system", "user"]
    assert "cmd_vel" in model.asked[0][0].text


BROKEN = {
    "a syntax error": (DANCE.replace("def run(self):", "def run(self)"), "is not valid Python"),
    "an exception": (
        DANCE.replace("self.drive(0.2, 0.0, 1.0)", "self.drvie(0.2, 0.0, 1.0)"),
        "AttributeError",
    ),
    "a forbidden import": (DANCE.replace("import time", "import time, socket"), "socket"),
    "an unknown import": (DANCE.replace("import time", "import time, cv2"), "cv2"),
    "a limit": (DANCE.replace("0.2, 0.0, 1.0", "5.0, 0.0, 0.2"), "5.00 m/s"),
    "no stop at its end": (DANCE.replace("self.drive(0.0, 0.0, 1.0)", "pass"), "without stopping"),
}


@pytest.mark.parametrize(("code", "told"), BROKEN.values(), ids=BROKEN.keys())
def test_what_is_wrong_goes_back_to_the_model_and_the_mended_program_runs(
    house: House, code: str, told: str
) -> None:
    model = house.model(fenced(code), fenced(DANCE))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    first, second = house.all(ProgramWritten)
    assert (first.version, second.version) == (1, 2)
    assert second.diff.startswith("--- before\n+++ after")
    assert told in model.asked[1][-1].text
    assert len([event for event in house.events if isinstance(event, Result)]) == 1


def test_the_model_gets_the_traceback_with_the_line(house: House) -> None:
    model = house.model(fenced(BROKEN["an exception"][0]), fenced(DANCE))
    house.do(ASKED)
    assert "drvie" in model.asked[1][-1].text
    assert "Traceback" in model.asked[1][-1].text


def test_it_is_mended_twice_at_most_and_then_refused(house: House) -> None:
    code = BROKEN["an exception"][0]
    model = house.model(fenced(code), fenced(code), fenced(code))
    result = house.do(ASKED)
    assert result.outcome == "refused"
    assert "AttributeError" in result.reply
    assert [written.version for written in house.all(ProgramWritten)] == [1, 2, 3]
    assert len(model.asked) == 3
    assert not any(pose.vx_mps for pose in house.all(TruePose))


def test_a_limit_that_stays_after_two_repairs_is_governed_and_said(house: House) -> None:
    code = BROKEN["a limit"][0]
    house.model(fenced(code), fenced(code), fenced(code))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    assert "limited" in house.findings
    assert max(abs(pose.vx_mps) for pose in house.all(TruePose)) <= 1.0 + 1e-6


def test_an_answer_without_a_program_is_told(house: House) -> None:
    house.model("I would rather write a poem.")
    result = house.do(ASKED)
    assert result.outcome == "unclear"
    assert "poem" in result.reply


@pytest.mark.parametrize(
    ("name", "said"),
    [("square dance", "do the square dance again"), ("square dance", "run the square dance"),
     ("方块舞", "再跳一次方块舞"), ("方块舞", "运行方块舞")],
)  # fmt: skip
def test_a_kept_program_runs_again_by_its_name(house: House, name: str, said: str) -> None:
    house.authoring.library.keep(KeptProgram(name, DANCE))
    result = house.do(said)
    assert result.outcome == "completed"
    assert house.all(ProgramWritten)[0].program == name
    assert house.all(Rehearsed)
    assert house.authoring.library.get(name).runs[-1].outcome == "completed"


def test_a_new_program_is_kept_with_where_it_comes_from_and_how_it_went(house: House) -> None:
    house.model(fenced(DANCE + "# kept\n"))
    house.do(ASKED)
    kept = house.authoring.library.get(house.all(ProgramWritten)[0].program)
    assert (kept.provenance.sentence, kept.provenance.by, kept.provenance.model) == (
        ASKED,
        "model",
        "scripted:test",
    )
    assert kept.rehearsal["ok"] is True
    assert kept.runs[-1].outcome == "completed"


def test_what_a_model_uses_to_write_and_to_mend_is_told_call_by_call(house: House) -> None:
    house.model("no program at all, sorry")
    house.do(ASKED)
    assert [(call.model, call.round) for call in house.all(ModelCalled)] == [("scripted:test", 1)]
    house.model(fenced("this is no Python ("), fenced(DANCE + "# mended\n"))
    assert house.do(ASKED).outcome == "completed"
    calls = house.all(ModelCalled)
    assert [call.round for call in calls] == [1, 2]
    assert calls[1].prompt_tokens > calls[0].prompt_tokens > 0
    assert calls[1].reply_tokens > 0
    assert not any(call.counted for call in calls)


def test_what_a_model_uses_to_write_programs_counts_in_usage(house: House, tmp_path: Path) -> None:
    pytest.importorskip("pydantic_ai")
    broken, whole = fenced("this is no Python ("), fenced(DANCE + "# counted\n")
    with serving([{"text": broken}, {"text": whole}]) as fake:
        house.authoring.model = model_at("openai", fake.url, folder=tmp_path)
        assert house.do(ASKED).outcome == "completed"
    total = totals(tmp_path, "model")["openai:fake"]
    told = house.all(ModelCalled)
    assert (total.calls, total.estimated) == (2, 0)
    assert total.prompt_tokens == sum(call.prompt_tokens for call in told) > 0
    assert total.reply_tokens == sum(call.reply_tokens for call in told) > 0


def test_a_program_that_needs_no_model_uses_none(house: House) -> None:
    house.do("Generate a ROS 2 Python program to drive forward 15 cm")
    assert not house.all(ModelCalled)


def test_the_same_program_is_kept_once(house: House) -> None:
    house.do("Generate a ROS 2 Python program called “there and back” to drive forward 10 cm then back 10 cm")
    house.do("Generate a ROS 2 Python program called “there and back” to drive forward 10 cm then back 10 cm")
    assert sum(name.startswith("there and back") for name in house.authoring.library.names()) == 1


def test_findings_ask_and_a_no_moves_nothing(house: House) -> None:
    house.on_event = lambda event: (
        house.session.approve(event.turn, False)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.run(program("self.drive(0.2, 0.0, 0.5)\nreturn"))
    assert house.all(Rehearsed)[0].needs_approval
    assert "program_never_stops" in house.findings
    assert (result.outcome, result.path_m) == ("refused", 0.0)


def test_an_edit_is_asked_about_though_this_session_has_not_shown_the_program(house: House) -> None:
    house.authoring.library.keep(KeptProgram("unseen", program("self.drive(0.1, 0.0, 1.0)")))
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.edit("unseen", program("self.drive(0.2, 0.0, 1.0)"))
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.2, abs=0.02)


def test_an_edit_of_a_program_that_is_not_kept_is_refused(house: House) -> None:
    result = house.edit("nobody's", program("self.drive(0.2, 0.0, 1.0)"))
    assert (result.outcome, result.path_m) == ("refused", 0.0)
    assert "there is no program" in result.reply


def test_who_said_yes_beforehand_is_not_asked(house: House) -> None:
    house.session.options = Options(ask_findings=False)
    result = house.run(program("self.drive(0.2, 0.0, 0.5)\nreturn"))
    assert result.outcome == "completed"
    assert house.all(TruePose)[-1].vx_mps == 0.0  # it did not stop the robot: I did


def test_what_was_written_just_now_can_be_asked_about(house: House) -> None:
    house.session.options = replace(Options(), ask_new=True)
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.do("Generate a ROS 2 Python program to drive forward 20 cm")
    assert house.all(Rehearsed)[0].needs_approval
    assert result.outcome == "completed"


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
