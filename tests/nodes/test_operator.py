"""Whose words are being done has to be there: the robot stops when `input` falls silent, and not when it leaves."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core import process
from chatrobot.core.clock import LOCAL_TERM_S, TERM_S
from chatrobot.core.wiring import Wiring
from chatrobot.governor.lease import LONGEST_S
from chatrobot.link.topics import OPERATOR, USER_INPUT
from chatrobot.nodes.input import InputNode
from chatrobot.nodes.operator import CLAIMED_WITHIN_S, OperatorBeat, Operators
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Text


class Room:
    """A base that listens, on a clock of its own, and three people at `input`: Cat's process can be seen from here."""

    def __init__(self) -> None:
        hub = MemoryHub()
        self.now_s, self.is_idle, self.stops = 50.0, True, 0
        self.operators = Operators(lambda: self.is_idle, self._stop, lambda: self.now_s)
        hub.connect().subscribe(OPERATOR, Text, self.operators.hear_beat)
        self.ann, self.bob, self.cat = (
            OperatorBeat(hub.connect(), is_on_this_machine=here) for here in (True, False, True)
        )
        self.ann._process = self.bob._process = ""

    def _stop(self) -> None:
        self.stops += 1
        self.is_idle = True

    def says(self, who: OperatorBeat, text: str) -> None:
        who.claim(text)
        self.operators.hear_text(text)
        self.is_idle = False

    def wait(self, duration_s: float, *beating: OperatorBeat) -> None:
        for _ in range(round(duration_s / 0.02)):
            self.now_s += 0.02
            for who in beating:
                who._publish(leaves=False)
            self.operators.look()


@pytest.fixture
def room() -> Room:
    return Room()


def test_who_falls_silent_while_the_robot_does_as_they_said_stops_it(room: Room) -> None:
    room.says(room.ann, "forward 5 m")
    room.wait(1.0, room.ann)
    assert room.stops == 0
    room.wait(LOCAL_TERM_S + 0.04)
    assert room.stops == 1
    room.wait(1.0)
    assert room.stops == 1, "once"


def test_time_in_which_we_did_not_listen_is_nobodys_silence(room: Room) -> None:
    room.says(room.ann, "forward 5 m")
    room.now_s += 1.0
    room.operators.look()
    assert room.stops == 0
    room.wait(LOCAL_TERM_S + 0.1)
    assert room.stops == 1


def test_who_is_late_on_a_busy_machine_stops_nothing_and_our_own_beat_says_how_late(room: Room) -> None:
    room.says(room.cat, "forward 5 m")
    room.wait(1.0, room.cat)
    assert room.operators.age_s() == 0.0
    room.wait(0.06)
    assert room.operators.age_s() == 0.0, "that is no more than two beats"
    room.wait(0.34)
    assert room.operators.age_s() == pytest.approx(0.4)
    assert room.stops == 0
    room.wait(0.1, room.cat)
    assert room.operators.age_s() == 0.0
    room.wait(LONGEST_S + 0.04)
    assert room.stops == 1


@pytest.mark.parametrize("state", ["stopped", "gone"])
def test_whose_process_is_stopped_or_gone_stops_the_robot_as_soon_as_the_beat_is_late(
    room: Room, monkeypatch: pytest.MonkeyPatch, state: str
) -> None:
    with subprocess.Popen(["sleep", "60"]) as child:
        monkeypatch.setattr(os, "getpid", lambda: child.pid)
        room.cat._process = process.own_identity()
        monkeypatch.undo()
        room.says(room.cat, "forward 5 m")
        room.wait(1.0, room.cat)
        child.send_signal(signal.SIGSTOP if state == "stopped" else signal.SIGKILL)
        time.sleep(0.05)
        room.wait(0.12)
        assert room.stops == 0
        room.wait(0.04)
        assert room.stops == 1
        child.kill()


def test_over_a_slower_wire_they_have_a_little_longer(room: Room) -> None:
    room.says(room.bob, "forward 5 m")
    room.wait(TERM_S - 0.04)
    assert room.stops == 0
    room.wait(0.08)
    assert room.stops == 1


def test_who_leaves_in_order_wants_it_done(room: Room) -> None:
    room.says(room.ann, "forward 5 m")
    room.ann.close()
    room.wait(1.0)
    assert room.stops == 0


def test_who_said_nothing_that_is_being_done_may_go(room: Room) -> None:
    room.bob.claim("turn left")
    room.says(room.ann, "forward 5 m")
    room.wait(1.0, room.ann)
    assert room.stops == 0


def test_who_spoke_before_the_robot_stood_may_go(room: Room) -> None:
    room.says(room.bob, "forward 10 cm")
    room.wait(0.2, room.ann, room.bob)
    room.is_idle = True
    room.says(room.ann, "forward 5 m")
    room.wait(1.0, room.ann)
    assert room.stops == 0


def test_text_that_nobody_claims_binds_nobody(room: Room) -> None:
    room.wait(0.1, room.ann)
    room.operators.hear_text("forward 5 m")
    room.is_idle = False
    room.wait(1.0)
    assert room.stops == 0


def test_a_claim_may_come_after_its_text(room: Room) -> None:
    room.operators.hear_text("forward 5 m")
    room.is_idle = False
    room.wait(0.1)
    room.ann.claim("forward 5 m")
    room.wait(0.5)
    assert room.stops == 1


def test_an_old_claim_claims_nothing(room: Room) -> None:
    room.ann.claim("forward 5 m")
    room.wait(CLAIMED_WITHIN_S + 0.1, room.ann)
    room.operators.hear_text("forward 5 m")
    room.is_idle = False
    room.wait(1.0)
    assert room.stops == 0


def test_nothing_is_stopped_where_nothing_runs(room: Room) -> None:
    room.says(room.ann, "where are you?")
    room.is_idle = True
    room.wait(1.0)
    assert room.stops == 0


@given(st.text() | st.recursive(st.none() | st.floats() | st.text(), st.lists).map(json.dumps))
def test_whatever_else_is_on_that_topic_is_passed_over(text: str) -> None:
    room = Room()
    room.operators.hear_beat(Text(text))
    room.wait(0.1)
    assert room.stops == 0


@pytest.mark.parametrize(
    "odd", [{"count": "x"}, {"term_s": None}, {"term_s": 10**400}, {"count": 1e400}, {"said": None}]
)
def test_a_beat_with_odd_values_harms_nobody(room: Room, odd: dict[str, object]) -> None:
    good: dict[str, object] = {"id": "x", "said": "forward", "count": 1, "term_s": 0.2, "leaves": False}
    room.operators.hear_beat(Text(json.dumps({**good, **odd})))
    room.operators.hear_text("forward")
    room.wait(0.1)
    assert room.stops == 0


@pytest.mark.parametrize(
    ("typed", "heard"),
    [("/stop", "stop"), ("/estop", "emergency stop"), ("/Release ", "release the emergency stop"),
     ("/forward", "/forward")],
)  # fmt: skip
def test_the_consoles_commands_that_input_is_told_to_use_are_understood(typed: str, heard: str) -> None:
    hub = MemoryHub()
    texts: list[str] = []
    hub.connect().subscribe(USER_INPUT, Text, lambda message: texts.append(message.data))
    node = InputNode("local:unused", Wiring(), print, lambda *_: hub.connect())
    node.say(typed)
    node.close()
    assert texts == [heard]
