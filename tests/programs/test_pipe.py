"""Nothing that comes out of the sandbox can hurt its host: the pipe is read strictly, and its end ends the program."""

from __future__ import annotations

import json
import math
import socket
import struct
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.programs.events import ENDS, Beat, Died, Ended, Log, TwistAsked, read_event
from chatrobot.programs.pipe import LARGEST_FROM_PROGRAM, FrameReader, PipeError, ProgramSettings, encode
from chatrobot.programs.sandboxed import TEXT_BYTES, SandboxedProgram
from chatrobot.sandbox.limits import SandboxLimits
from chatrobot.sandbox.process import ExitReport

SECOND_NS = 1_000_000_000
GOOD = (
    ["twist", SECOND_NS, 0.1, -0.2, 1, True],
    ["topic", 0, "publishes", "/cmd_vel", "geometry_msgs/msg/Twist"],
    ["listens", 0, "scan", 10],
    ["log", 5, "INFO", "node", "text"],
    ["out", 5, "stderr", "text"],
    ["until", 5, SECOND_NS, True],
    ["beat", 7],
    ["ended", 7, "returned", 0],
    ["raised", 7, "ValueError", "text", "trace", 12],
)
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=30),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@dataclass
class FakeProcess:
    """A process whose channel the test speaks on."""

    channel: socket.socket
    killed: bool = False

    def kill(self) -> None:
        self.killed = True

    def wait(self, timeout_s: float | None = None) -> ExitReport | None:
        return None

    def read_logs(self) -> str:
        return "last words"

    def close(self) -> None:
        self.channel.close()


class FakeServer:
    def __init__(self) -> None:
        ours, self.theirs = socket.socketpair()
        self.process = FakeProcess(ours)

    def launch(self, entry: str, payload: bytes = b"", limits: SandboxLimits | None = None) -> Any:
        return self.process


@pytest.fixture
def fake() -> Iterator[tuple[FakeServer, SandboxedProgram]]:
    server = FakeServer()
    program = SandboxedProgram(server, ProgramSettings(""))
    program.start()
    yield server, program
    program.close()
    server.theirs.close()


def frame(body: bytes) -> bytes:
    return struct.pack("!I", len(body)) + body


@pytest.mark.parametrize("good", GOOD, ids=lambda good: str(good[0]))
def test_every_word_is_read(good: list[Any]) -> None:
    event = read_event(good)
    assert event[0] == good[1] * 1e-9
    assert len(event) >= len(good) - 3


@given(st.sampled_from(GOOD), st.data())
def test_a_word_with_anything_else_in_it_is_refused_or_read_as_its_kind(
    good: list[Any], data: st.DataObject
) -> None:
    frame_of = list(good)
    frame_of[data.draw(st.integers(1, len(good) - 1))] = data.draw(VALUES)
    try:
        event = read_event(frame_of)
    except PipeError:
        return
    assert type(event) is type(read_event(list(good)))
    assert math.isfinite(event[0]) or isinstance(event, Died)


@given(VALUES)
def test_no_json_at_all_breaks_the_reader(value: Any) -> None:
    body = json.dumps([value, value] if not isinstance(value, list) else value).encode()
    try:
        for found in FrameReader(LARGEST_FROM_PROGRAM).feed(frame(body)):
            read_event(found)
    except PipeError:
        pass


@given(st.binary(max_size=400), st.integers(1, 50))
def test_no_bytes_at_all_break_the_reader(data: bytes, piece: int) -> None:
    reader = FrameReader(LARGEST_FROM_PROGRAM)
    try:
        for at in range(0, len(data), piece):
            for found in reader.feed(data[at : at + piece]):
                read_event(found)
    except PipeError:
        pass


@given(st.lists(st.sampled_from(GOOD), max_size=8), st.integers(1, 40))
def test_frames_come_whole_however_the_pipe_cuts_them(words: list[list[Any]], piece: int) -> None:
    data = b"".join(encode(*word) for word in words)
    reader = FrameReader(LARGEST_FROM_PROGRAM)
    found = [each for at in range(0, len(data), piece) for each in reader.feed(data[at : at + piece])]
    assert found == [list(word) for word in words]


ATTACKS = {
    "a length beyond all bounds": struct.pack("!I", 2**32 - 1),
    "no JSON": frame(b"\xff\xfe\x00"),
    "a depth that overflows": frame(b"[" * 60_000),
    "a number with a million digits": frame(b'["beat", ' + b"9" * 60_000 + b"]"),
    "an unknown word": frame(b'["govern", 0, 1.0]'),
    "a word too few": frame(b'["twist", 0, 1.0]'),
    "a word too many": frame(b'["beat", 0, 0]'),
    "a time before the start": frame(b'["beat", -1]'),
    "a time after all times": frame(b'["beat", 99999999999999999999]'),
    "a flag for a number": frame(b'["twist", 0, true, 0, 0, true]'),
    "a list for a number": frame(b'["twist", 0, [1], 0, 0, true]'),
    "a sensor that is none": frame(b'["listens", 0, "/etc/passwd", 10]'),
    "a level that is none": frame(b'["log", 0, "EXEC", "n", "t"]'),
    "a name as long as a book": frame(json.dumps(["topic", 0, "publishes", "x" * 5000, "t"]).encode()),
    "an object": frame(b'{"word": "beat"}'),
    "a word of the host's": frame(b'["now", 0, 0, []]'),
}


@pytest.mark.parametrize("attack", ATTACKS)
def test_who_breaks_the_protocol_is_ended(fake: tuple[FakeServer, SandboxedProgram], attack: str) -> None:
    server, program = fake
    server.theirs.sendall(encode("beat", 1) + ATTACKS[attack])
    events = [event for _ in range(8) for event in program.poll()]
    assert events[0] == Beat(1e-9)
    assert isinstance(events[1], Died)
    assert events[1].reason.code == "program_broke_pipe"
    assert server.process.killed
    assert program.poll() == []


def test_what_is_said_after_the_end_does_not_count(fake: tuple[FakeServer, SandboxedProgram]) -> None:
    server, program = fake
    server.theirs.sendall(encode("ended", 5, "returned", 0) + encode("twist", 6, 1.0, 0.0, 0.0, True))
    assert [type(event) for event in program.poll()] == [Ended]
    server.theirs.sendall(encode("twist", 7, 1.0, 0.0, 0.0, True))
    assert program.poll() == []


def test_a_pipe_that_closes_is_a_death_with_last_words(fake: tuple[FakeServer, SandboxedProgram]) -> None:
    server, program = fake
    server.theirs.close()
    (died,) = program.poll()
    assert isinstance(died, Died)
    assert (died.reason.code, died.log) == ("program_vanished", "last words")


def test_a_flood_is_read_in_small_sips_and_its_text_is_cut(fake: tuple[FakeServer, SandboxedProgram]) -> None:
    server, program = fake
    line = encode("log", 0, "INFO", "n", "x" * 8000)
    enough = 2 * TEXT_BYTES // 8000
    writer = threading.Thread(
        target=lambda: server.theirs.sendall(line * enough + encode("ended", 1, "exit", 0))
    )
    writer.start()
    read, most = 0, 0
    while program.end is None:
        events = program.poll(0.5)
        told = sum(len(event.text) for event in events if isinstance(event, Log))
        read, most = read + told, max(most, len(events))
    writer.join()
    assert read <= TEXT_BYTES
    assert most < 10


def test_who_asks_and_never_listens_is_ended(fake: tuple[FakeServer, SandboxedProgram]) -> None:
    server, program = fake
    for _ in range(40):
        program.let_pass(1.0, 2.0, [["scan", 0.0, 0.0, 0.1, 0.1, 9.0, [1.0] * 10_000]])
    server.theirs.sendall(encode("until", 0, 5, True))
    (died,) = program.poll()
    assert isinstance(died, Died)
    assert isinstance(died, ENDS)


def test_telling_never_blocks(fake: tuple[FakeServer, SandboxedProgram]) -> None:
    _, program = fake
    for _ in range(2000):
        program.tell("scan", [0.0, 0.0, 0.1, 0.1, 9.0, [1.0] * 1000])


def test_velocities_that_are_no_numbers_are_left_to_the_governor() -> None:
    event = read_event(["twist", 0, math.nan, math.inf, 10**400, True])
    assert isinstance(event, TwistAsked)
    assert not event.twist.is_finite
