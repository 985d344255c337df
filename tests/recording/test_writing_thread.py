"""Whatever the disk does, recordings keep nobody from the interpreter: neither beats nor a stop wait for them."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from chatrobot.link.envelope import Envelope, ready
from chatrobot.link.processes import MotionProcess
from chatrobot.link.socket_link import SocketLink
from chatrobot.recording import recorder as recorder_module
from chatrobot.recording.reader import read
from chatrobot.recording.recorder import AT_ONCE, PAUSE_S, Recorder, WritingThread
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.topics import CMD_VEL, ODOM
from chatrobot.recording.writer import RecordingWriter
from chatrobot.wire.messages import Odometry, TwistMessage
from tests.link.leaving import abandon

PUPILS, PATIENCE_S = 20, 10.0


class HungDisk:
    """Whatever is to be flushed waits until `goes_on` is set; `is_met` once somebody waits."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.is_met, self.goes_on = threading.Event(), threading.Event()
        flush = RecordingWriter.flush

        def hang(writer: RecordingWriter) -> None:
            self.is_met.set()
            assert self.goes_on.wait(PATIENCE_S)
            flush(writer)

        monkeypatch.setattr(RecordingWriter, "flush", hang)


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[HungDisk]:
    hung = HungDisk(monkeypatch)
    yield hung
    hung.goes_on.set()


def begin(folder: Path, count: int = PUPILS) -> list[Recorder]:
    thread = WritingThread(look_s=0.02)
    recorders = [
        Recorder(folder / f"{place}.mcap", Redactor(tuple, {}), among=thread) for place in range(count)
    ]
    for recorder in recorders:
        recorder.start(dict)
        recorder.take(CMD_VEL, TwistMessage(0.1, 0.0, 0.0))
    return recorders


def test_a_class_is_written_by_one_thread_which_ends_with_the_last_of_it(tmp_path: Path) -> None:
    recorders = begin(tmp_path)
    assert [thread.name for thread in threading.enumerate()].count("recorder") == 1
    first, *others = recorders
    first.close()
    assert read(first.path).commands
    assert not any(recorder.is_over for recorder in others)
    for recorder in others:
        recorder.take(CMD_VEL, TwistMessage(0.0, 0.0, 0.0))
    for recorder in others:
        recorder.close()
        assert [twist.vx_mps for _, twist in read(recorder.path).commands] == [0.1, 0.0]
    first_again = Recorder(tmp_path / "again.mcap", Redactor(tuple, {}), among=first._thread)
    first_again.start(dict)
    first_again.take(CMD_VEL, TwistMessage(0.2, 0.0, 0.0))
    first_again.close()
    assert read(first_again.path).commands


def test_while_the_disk_hangs_beats_go_out_and_a_stop_at_once(tmp_path: Path, disk: HungDisk) -> None:
    ours, motion = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    motion.settimeout(PATIENCE_S)
    motion.send(ready())
    link = SocketLink(MotionProcess(subprocess.Popen([sys.executable, "-c", ""]), ours))
    link.wait_until_ready()
    recorders = begin(tmp_path)
    assert disk.is_met.wait(PATIENCE_S)
    for place in range(1000):
        recorders[place % PUPILS].take(ODOM, Odometry(0.02 * place, place, 0.0, 0.0, 0.0, 0.0, 0.0))
        recorders[place % PUPILS].said(place, "stop")
        recorders[place % PUPILS].notices()
    heard = [word(motion) for _ in range(6)]
    link.send("stop", why="said")
    while heard[-1] != "stop":
        heard.append(word(motion))
    assert heard.count("beat") >= 5
    assert not disk.goes_on.is_set()
    disk.goes_on.set()
    for recorder in recorders:
        recorder.close()
    assert len(read(recorders[0].path).words) == 1000 / PUPILS
    motion.close()
    abandon(link)


def word(motion: socket.socket) -> str:
    envelope = Envelope.from_bytes(motion.recv(65_536))
    assert envelope is not None
    return envelope.word


def test_after_a_hang_the_backlog_is_written_a_little_at_a_time(
    tmp_path: Path, disk: HungDisk, monkeypatch: pytest.MonkeyPatch
) -> None:
    (recorder,) = begin(tmp_path, 1)
    assert disk.is_met.wait(PATIENCE_S)
    for turn in range(10 * AT_ONCE):
        recorder.said(turn, "go")
    at_once = [0]
    written, write, sleep = threading.Event(), RecordingWriter.write, time.sleep

    def count(writer: RecordingWriter, *message: Any) -> None:
        at_once[-1] += 1
        write(writer, *message)
        if sum(at_once) == 20 * AT_ONCE:
            written.set()

    def pause(seconds: float) -> None:
        if seconds == PAUSE_S:  # threads that tests before this one left sleep, too
            at_once.append(0)
        else:
            sleep(seconds)

    monkeypatch.setattr(RecordingWriter, "write", count)
    monkeypatch.setattr(recorder_module.time, "sleep", pause)
    disk.goes_on.set()
    assert written.wait(PATIENCE_S)
    recorder.close()
    assert max(at_once) == AT_ONCE
