"""A recording whose writer was killed opens again, and lacks at most the last second."""

from __future__ import annotations

import random
import subprocess
import sys
import time
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from chatrobot.cli.recorder import read_recording
from chatrobot.core.errors import InputError
from chatrobot.recording.reader import read
from chatrobot.recording.recorder import Recorder
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.repair import is_whole, repair
from chatrobot.recording.shelf import tidy
from chatrobot.recording.topics import ODOM
from chatrobot.wire.dds.definitions import RosDefinitions
from chatrobot.wire.messages import Odometry

WRITES = """
import sys, time
from pathlib import Path
from chatrobot.recording.recorder import Recorder
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.topics import CMD_VEL, ODOM
from chatrobot.wire.messages import Odometry, TwistMessage
recorder = Recorder(Path(sys.argv[1]), Redactor(tuple, {}))
recorder.start(lambda: {"robot": "x"})
while True:
    recorder.take(ODOM, Odometry(time.monotonic(), 1.0, 2.0, 0.5, 0.1, 0.0, 0.0))
    recorder.take(CMD_VEL, TwistMessage(0.1, 0.0, 0.0))
    time.sleep(0.01)
"""


@pytest.mark.realtime
def test_after_kill_9_it_opens_and_lacks_at_most_a_second(tmp_path: Path) -> None:
    paths = [tmp_path / f"{number}.mcap" for number in range(2)]
    running = [subprocess.Popen([sys.executable, "-c", WRITES, str(path)]) for path in paths]
    ends_s = time.monotonic() + 30.0
    while not all(path.exists() and path.stat().st_size > 20_000 for path in paths):
        assert time.monotonic() < ends_s
        time.sleep(0.02)
    killed_ns = []
    for process in running:
        time.sleep(random.uniform(0.1, 0.7))
        killed_ns.append(time.time_ns())
        process.kill()
        process.wait()
    assert not any(map(is_whole, paths))
    tidy(tmp_path)  # as the next start does
    for path, ended_ns in zip(paths, killed_ns):
        assert is_whole(path)
        with path.open("rb") as file:
            last_ns = make_reader(file).get_summary().statistics.message_end_time
        assert (ended_ns - last_ns) / 1e9 < 1.0
        with AnyReader([path]) as bag:
            for one, _, data in bag.messages():
                bag.deserialize(data, one.msgtype)
        assert read(path).meta["robot"] == "x"


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    recorder = Recorder(tmp_path / "whole.mcap", Redactor(tuple, {}))
    recorder.start(lambda: {"robot": "x"})
    for number in range(3000):
        recorder.take(ODOM, Odometry(0.0, random.random(), 0.1 * number, 0.0, 0.0, 0.0, 0.0))
    recorder.close()
    return recorder.path


def test_a_file_cut_anywhere_is_mended_or_refused(whole: Path) -> None:
    data = whole.read_bytes()
    before = len(read(whole).odometry)
    for share in (0.0, 0.0001, 0.01, 0.3, 0.7, 0.97, 0.999):
        path = whole.with_name("cut.mcap")
        path.write_bytes(data[: int(len(data) * share)])
        try:
            repair(path)
        except InputError:
            assert share < 0.01
            assert path.read_bytes() == data[: int(len(data) * share)]
            continue
        assert is_whole(path)
        if share < 0.01:
            with pytest.raises(InputError, match="no message"):
                read(path)
            continue
        assert len(read(path).odometry) <= before
    assert not list(whole.parent.glob(".*"))


def test_bytes_that_went_bad_end_what_can_be_read(whole: Path) -> None:
    data = bytearray(whole.read_bytes())
    data[-2000:] = bytes(2000)  # as after a power cut
    whole.write_bytes(data)
    assert repair(whole) is not None
    read(whole)
    assert repair(whole) is None


def test_what_another_program_may_still_write_is_not_touched(tmp_path: Path) -> None:
    path = tmp_path / "theirs.mcap"
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=1)
        writer.start("ros2", "libmcap 1.3.0")
        schema = writer.register_schema(ODOM.form.type_name, "ros2msg", b"")
        message = ODOM.form.to_ros(Odometry(0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0))
        data = RosDefinitions().cdr(ODOM.form.type_name, message)
        writer.add_message(writer.register_channel(ODOM.name, "cdr", schema), 10**9, data, 10**9)
    before = path.read_bytes()
    assert repair(path) is None
    tidy(tmp_path)
    recording, amiss = read_recording(str(path))
    assert ([sample.x_m for _, sample in recording.odometry], amiss) == ([0.5], "unfinished")
    assert recording.path == path
    assert path.read_bytes() == before


def test_what_is_being_written_is_left_alone(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "a.mcap", Redactor(tuple, {}))
    recorder.start(dict)
    assert repair(recorder.path) is None
    tidy(tmp_path)
    recorder.close()
    assert is_whole(recorder.path)
