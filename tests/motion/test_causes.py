"""A turn that ends early is told why it did; no cause is guessed, and "you said" stands only before what was said."""

from __future__ import annotations

import ast
import re
import socket
import struct
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.dialogue.scripted_model import ModelTalk
from tests.link.link_rigs import SimulatedRig, finished
from tests.models.rig import WIRES, model_at, serving

import chatrobot
from chatrobot.cli.signals import _WATCHED
from chatrobot.compose import Setup, connect
from chatrobot.core.clock import VirtualClock
from chatrobot.core.events import Event, Finished, Result
from chatrobot.core.reason import Reason
from chatrobot.language.data_files import REPLY_LANGUAGES, load_table
from chatrobot.language.phrases import render_reason
from chatrobot.link.in_process import InProcessLink
from chatrobot.models.fake import openai
from chatrobot.models.fake.wires import Conversations
from chatrobot.motion.safety import watchdog
from chatrobot.motion.safety.watchdog import SimulatedGuard, StallDetector

ASKED = "please do the thing that the frobnicator did yesterday"
PLAN = "drive 0.5 m\nturn left 90\ndrive 0.5 m\nturn left 90\n"
PROGRAM = """\
```python
import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
node = rclpy.create_node("mover")
publisher = node.create_publisher(Twist, "cmd_vel", 10)
for speed in (0.2, 0.2, 0.2, 0.0):
    twist = Twist()
    twist.linear.x = speed
    publisher.publish(twist)
    time.sleep(0.2)
"""


def result_of(text: str, wire: str, url: str, *, fast: bool = True) -> tuple[Result, list[Event]]:
    events: list[Event] = []
    setup = Setup(world="empty", fast=fast, programs=True, model=model_at(wire, url))
    connection = connect(setup, events.append)
    try:
        return connection.session.do(text), events
    finally:
        connection.close()


def assert_told_as_cut_off(result: Result) -> None:
    assert result.outcome == "failed", result.reply
    assert "The model's reply broke off" in result.reply
    assert "stop" not in result.reply.casefold()


# --- a model's server cuts the connection ---


@pytest.mark.parametrize("wire", WIRES)
def test_a_connection_that_is_cut_in_mid_reply_is_told_as_that(wire: str) -> None:
    with serving([{"match": ".*", "text": PLAN, "cut_off_after": 8}]) as fake:
        result, _ = result_of(ASKED, wire, fake.url)
    assert_told_as_cut_off(result)
    assert result.reason is not None
    assert result.reason.code == "model_cut_off"
    assert result.path_m == pytest.approx(0.5, abs=0.02), "what came before it is done, and measured"


@contextmanager
def a_server_that_resets() -> Iterator[str]:
    """Answers one call with two lines of a plan, and resets the connection in the middle of the third."""
    listener = socket.create_server(("127.0.0.1", 0))
    chat = openai.WIRES["/chat/completions"]({"model": "fake"}, "", Conversations())

    def serve() -> None:
        line, _ = listener.accept()
        with line:
            line.recv(65_536)
            line.sendall(
                b"HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nTransfer-Encoding: chunked\r\n\r\n"
            )
            for piece in ("drive 0.5 m\n", "turn left 90\n", "drive 0."):
                data = chat.token(piece)
                line.sendall(f"{len(data):x}\r\n".encode() + data + b"\r\n")
            line.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))

    threading.Thread(target=serve, daemon=True).start()
    with listener:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"


def test_a_connection_that_is_reset_is_told_as_that() -> None:
    with a_server_that_resets() as url:
        result, _ = result_of(ASKED, "openai", url)
    assert_told_as_cut_off(result)


@pytest.mark.parametrize("cut_off_after", [30, 60, 110])
def test_half_a_program_is_neither_run_nor_blamed_on_who_wrote_it(cut_off_after: int) -> None:
    with serving([{"match": ".*", "text": PROGRAM, "cut_off_after": cut_off_after}]) as fake:
        result, events = result_of(
            "write a ROS 2 python program that frobnicates the gizmo", "openai", fake.url
        )
    assert_told_as_cut_off(result)
    assert not any(event.name in ("program_written", "started") for event in events)


def test_a_program_whose_fence_was_closed_before_the_cut_is_whole() -> None:
    with serving([{"match": ".*", "text": f"{PROGRAM}```\nEnjoy your rob", "cut_off_after": 1000}]) as fake:
        result, _ = result_of("write a ROS 2 python program that frobnicates the gizmo", "openai", fake.url)
    assert result.outcome == "completed", result.reply


# --- stops that nobody said ---


@pytest.mark.parametrize(
    ("why", "told"),
    [
        ("nobody reads", "nobody reads the output any more"),
        ("operator lost", "the input that gave the order is silent"),
        ("Ctrl-C", "Ctrl-C"),
        ("halt!", "you said “halt!”"),
        ("", "a stop was requested"),
    ],
)
def test_a_stop_while_a_model_thinks_is_told_with_its_cause(why: str, told: str) -> None:
    talk = ModelTalk(None)
    turn = talk.session.say(ASKED)
    talk.session.pump(0.02)
    talk.session.stop(why)
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].reply == f"Stopped ({told}). So far: nothing moved."


def test_a_motion_that_failed_before_the_stop_has_failed() -> None:
    talk = ModelTalk("drive 2 m")
    turn = talk.session.say(ASKED)
    talk.pump_until_moving()
    failed = Finished(
        turn, "failed", Reason("bumped"), *[talk.session.understanding.pose] * 2, 0.0, 0.1, 0.5, 0.0
    )
    talk.session.stop("stop")
    talk.session._hear(failed)  # it was on its way when the stop was said
    talk.pump_until(lambda: turn in talk.session.results)
    assert "bumper" in talk.session.results[turn].reply
    assert talk.session.results[turn].outcome == "failed"


def test_who_stopped_it_from_elsewhere_is_named() -> None:
    def told(source: str, why: str, language: str = "en") -> str:
        return render_reason(Reason("stopped_by", {"source": source, "why": why}), language)

    assert told("console", "stop") == told("user_input", "stop") == "you said “stop”"
    assert told("chatrobot stop", "") == "stop from chatrobot stop"
    assert told("control", "Ctrl-C") == "Ctrl-C, at control"
    assert told("agent", "enough") == "“enough” from agent"
    assert told("console", "停", "zh") == "您说了“停”"
    assert told("control", "asked to end", "zh") == "control：本程序被要求结束"


def _why_literals() -> Iterator[str]:
    """What stops are sent with in our own code, where it is no person's words."""
    for path in Path(chatrobot.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.args):
                continue
            last = node.args[-1]
            if (
                node.func.attr in ("stop", "halt")
                and isinstance(last, ast.Constant)
                and isinstance(last.value, str)
            ):
                yield last.value
    yield from _WATCHED.values()


def test_every_cause_of_our_own_has_words_in_every_language() -> None:
    causes = {why for why in _why_literals() if why and not why.startswith("/")}
    assert {"nobody reads", "chatrobot broke", "operator lost"} <= causes
    for language in REPLY_LANGUAGES:
        words = load_table(language, "causes")["stops"]
        assert causes <= set(words), f"{language} has no words for {sorted(causes - set(words))}"


def test_no_reason_in_our_code_is_a_bare_stop() -> None:
    """`Reason("stopped")` says that somebody stopped it, and not who: a guess where nobody did."""
    for path in Path(chatrobot.__file__).parent.rglob("*.py"):
        assert not re.search(r'Reason\("stopped"\)', path.read_text(encoding="utf-8")), path


# --- what Motion does not accept any more ---


def joint_of(tmp_path: Path) -> tuple[SimulatedRig, InProcessLink]:
    rig = SimulatedRig(tmp_path)
    assert isinstance(rig.link, InProcessLink)
    return rig, rig.link


def test_a_plan_that_a_stop_has_overtaken_hears_of_that_stop(tmp_path: Path) -> None:
    rig, link = joint_of(tmp_path)
    plan = link.sender.envelope("plan", 1, plan_text="drive 0.1 m")
    link.send("stop", 1, why="hold it")
    link._motion.receive(plan)
    assert finished(rig, 1).reason == Reason("stopped_by", {"source": "console", "why": "hold it"})


def test_a_plan_that_another_word_has_overtaken_is_not_told_of_a_stop(tmp_path: Path) -> None:
    rig, link = joint_of(tmp_path)
    plan = link.sender.envelope("plan", 1, plan_text="drive 0.1 m")
    link.send("look", 2)
    link._motion.receive(plan)
    assert finished(rig, 1).reason == Reason("overtaken")


def test_a_plan_said_while_a_motion_failed_is_told_of_that_failure(tmp_path: Path) -> None:
    rig, link = joint_of(tmp_path)
    link.send("plan", 1, plan_text="drive 0.1 m")
    said_before = link._motion.stops
    link._motion._stops.halt_and_book(Reason("does_not_move"))
    plan = link.sender.envelope("plan", 2, plan_text="drive 0.1 m")
    link._motion.receive(plan, said_before)
    assert finished(rig, 2).reason == Reason("does_not_move")


@pytest.mark.parametrize(("late_s", "code"), [(0.0, "beats_missed"), (0.5, "motion_froze")])
def test_a_guard_that_tripped_is_not_told_as_a_freeze_of_ours(
    monkeypatch: pytest.MonkeyPatch, late_s: float, code: str
) -> None:
    monkeypatch.setattr(watchdog, "is_machine_busy", lambda: False)

    class Tripped(SimulatedGuard):
        def was_tripped(self) -> bool:
            return True

    clock, halted = VirtualClock(), []
    watch = StallDetector(clock, Tripped(clock), halted.append)
    watch.tick(clock.now_s(), is_driven=False, is_engaged=False)
    clock.advance(0.02 + late_s)
    watch.tick(clock.now_s(), is_driven=True, is_engaged=True)
    assert [why.code for why in halted] == [code]
