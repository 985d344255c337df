"""A recording holds what happened, opens with the libraries of others, and shows the same again."""

from __future__ import annotations

import json
import math
import os
import resource
import stat
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from chatrobot.cli.recorder import read_recording
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Scan, Telemetry
from chatrobot.core.wiring import Wiring
from chatrobot.recording.about import about_of, world_of
from chatrobot.recording.playback import shown
from chatrobot.recording.reader import Recording, read
from chatrobot.recording.recorder import MOST_WAITING, Recorder, Thinning
from chatrobot.recording.redactor import Redactor
from chatrobot.recording.shelf import make_folder, new_path, tidy
from chatrobot.recording.topics import CMD_VEL, ODOM
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world, world_names
from chatrobot.sim.world import World
from chatrobot.wire.dds.definitions import RosDefinitions
from chatrobot.wire.messages import Odometry, TwistMessage
from chatrobot.wire.ros_messages import ros_form
from tests.cli.running import Command

WORDS = "forward 1 m then turn left"
EVERY_TYPE = {
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/odom": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/ground_truth": "nav_msgs/msg/Odometry",
    "/user_input": "std_msgs/msg/String",
    "/chatgpt_node": "std_msgs/msg/String",
    "/chatrobot/events": "std_msgs/msg/String",
}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict]]:
    """A drive in simulated time, and the true poses that its trace told."""
    folder = tmp_path_factory.mktemp("recorded")
    path = folder / "drive.mcap"
    done = Command(folder)(
        "do", WORDS, "what time is it on mars", "--fast", "--json", "--trace", "--interpreter", "offline",
        "--record", str(path), "--config-dir", str(folder), "--keep-going",
    )  # fmt: skip
    assert done.code == 3
    return path, done.named("pose")


def test_the_official_reader_and_rosbags_open_it_with_every_type(recorded: tuple[Path, list[dict]]) -> None:
    path, _ = recorded
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    assert {channel.topic for channel in summary.channels.values()} == set(EVERY_TYPE)
    assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
    with AnyReader([path]) as bag:
        assert {one.topic: one.msgtype for one in bag.connections} == EVERY_TYPE
        messages = [
            (one.topic, bag.deserialize(data, one.msgtype), time_ns) for one, time_ns, data in bag.messages()
        ]
    assert len(messages) == summary.statistics.message_count > 500
    assert {topic for topic, _, _ in messages} == set(EVERY_TYPE)
    assert next(message.data for topic, message, _ in messages if topic == "/user_input") == WORDS
    scan = next(message for topic, message, _ in messages if topic == "/scan")
    assert len(scan.ranges) == load_profile("wheeltec_mini_mec").lidar.beams
    assert abs(messages[0][2] / 1e9 - time.time()) < 600.0


def test_the_true_way_is_in_it_to_the_centimetre(recorded: tuple[Path, list[dict]]) -> None:
    path, poses = recorded
    truth = read(path).truth
    told = [(pose["x_m"], pose["y_m"]) for pose in poses]
    written = [(sample.x_m, sample.y_m) for _, sample in truth]
    assert abs(len(told) - len(written)) <= 5
    assert max(min(math.dist(one, other) for other in written) for one in told[::7]) < 0.001
    assert math.dist(told[-1], written[-1]) < 0.001
    assert truth[-1][0] == pytest.approx(6.6, abs=1.5)  # in the robot's own time, however fast it went


def test_a_replay_tells_the_same_poses_and_words(recorded: tuple[Path, list[dict]], tmp_path: Path) -> None:
    chatrobot = Command(tmp_path)
    path, _ = recorded
    done = chatrobot("replay", str(path), "--speed", "1000", "--json")
    assert done.code == 0
    assert [event["text"] for event in done.named("heard")] == [WORDS, "what time is it on mars"]
    assert [event["outcome"] for event in done.named("result")] == ["completed", "unclear"]
    recording = read(path)
    for event in done.named("telemetry"):
        for way in (recording.odometry, recording.truth):
            at = min(way, key=lambda item: abs(item[0] - event["recorded_s"]))[1]
            assert math.dist((event["pose"]["x_m"], event["pose"]["y_m"]), (at.x_m, at.y_m)) < 0.01
            assert abs(math.remainder(event["pose"]["yaw_rad"] - at.yaw_rad, math.tau)) < 0.02
    text = chatrobot("replay", str(path), "--speed", "1000").out
    assert f"> {WORDS}" in text
    assert "Done: drove 1.00 m" in text
    assert "TV" in text  # the map


def test_a_recording_without_a_message_has_no_day_and_none_commands_the_terminal(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "bare.mcap", Redactor(tuple, {}))
    recorder.start(lambda: {"title": "red \x1b[31m robot"})
    recorder.close()
    assert (
        Command(tmp_path)("replay", str(recorder.path)).out
        == "red  [31m robot: Nothing is in this recording.\n"
    )


def test_a_recording_of_a_foreign_robot_is_shown_by_its_odometry(tmp_path: Path) -> None:
    odometry = [(i * 0.02, Odometry(i * 0.02, i * 0.006, 0.0, 0.0, 0.3, 0.0, 0.0)) for i in range(100)]
    items = shown(Recording(tmp_path, odometry=odometry, words=[(0.5, "go")]))
    poses = [(t_s, item.pose.x_m) for t_s, item in items if isinstance(item, Telemetry)]
    assert len(poses) == pytest.approx(20, abs=1)
    assert all(x_m == pytest.approx(0.3 * t_s) for t_s, x_m in poses)
    assert any(getattr(item, "text", "") == "go" for _, item in items)


def test_walls_are_shown_where_they_are_though_the_wheels_slip(tmp_path: Path) -> None:
    path = tmp_path / "slips.mcap"
    done = Command(tmp_path)(
        "do", "turn left", "--fast", "--sim", "slip=0.1", "--world", "home",
        "--record", str(path), "--config-dir", str(tmp_path),
    )  # fmt: skip
    assert done.code == 0
    recording, lidar = read(path), load_profile("wheeltec_mini_mec").lidar
    assert recording.odometry[-1][1].yaw_rad > recording.truth[-1][1].yaw_rad + 0.1
    *_, last = (item for _, item in shown(recording, lidar) if isinstance(item, Scan))
    assert len(last.points_m) > 100
    assert abs(world_of(recording.meta).clearance_m(np.array(last.points_m))).max() < 0.05


def test_a_bag_of_others_is_read_with_stamped_velocities_or_says_what_it_holds(tmp_path: Path) -> None:
    bag = tmp_path / "bag"  # a folder, as ros2 bag record leaves it
    bag.mkdir()
    definitions, twist = RosDefinitions(), "geometry_msgs/msg/TwistStamped"
    wiring = Wiring(cmd_vel_type="TwistStamped")
    data = definitions.cdr(
        twist, ros_form(wiring.cmd_vel_topic, TwistMessage, wiring).to_ros(TwistMessage(0.2, 0.0, 0.1))
    )
    for name, topic in (("bag/bag_0.mcap", "/cmd_vel"), ("else.mcap", "/other")):
        with (tmp_path / name).open("wb") as file:
            writer = Writer(file)
            writer.start("ros2", "libmcap 1.3.0")
            schema = writer.register_schema(twist, "ros2msg", definitions.text_of(twist).encode())
            writer.add_message(writer.register_channel(topic, "cdr", schema), 10**9, data, 10**9)
            writer.finish()
    recording, amiss = read_recording(str(bag))
    assert (recording.commands, amiss) == ([(0.0, TwistMessage(0.2, 0.0, 0.1))], "")
    with pytest.raises(UsageError, match=r"only /other \(geometry_msgs/msg/TwistStamped\)"):
        read_recording(str(tmp_path / "else.mcap"))


def test_what_a_bag_has_out_of_order_is_read_in_the_order_of_time(tmp_path: Path) -> None:
    path, type_name = tmp_path / "a.mcap", CMD_VEL.form.type_name
    definitions = RosDefinitions()
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=1)  # each message is a chunk of its own
        writer.start("ros2", "libmcap 1.3.0")
        schema = writer.register_schema(type_name, "ros2msg", definitions.text_of(type_name).encode())
        channel = writer.register_channel(CMD_VEL.name, "cdr", schema)
        for t_s in (3, 1, 2):
            data = definitions.cdr(type_name, CMD_VEL.form.to_ros(TwistMessage(t_s, 0.0, 0.0)))
            writer.add_message(channel, t_s * 10**9, data, t_s * 10**9)
        writer.finish()
    recording = read(path)
    assert [(t_s, twist.vx_mps) for t_s, twist in recording.commands] == [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]
    assert (recording.began_ns, recording.duration_s) == (10**9, 2.0)


def test_a_terminal_is_told_how_much_has_been_read_and_nobody_else(
    recorded: tuple[Path, list[dict]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("chatrobot.cli.recorder.SHOWN_EVERY_S", 0.0)
    read_recording(str(recorded[0]))
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    read_recording(str(recorded[0]))
    *told, last = capsys.readouterr().err.split("\r")[1:]
    shares = [int(line.removeprefix("\033[Kdrive.mcap: ").removesuffix("%")) for line in told]
    assert len(shares) > 1
    assert shares == sorted(shares)
    assert shares[-1] > 50
    assert last == "\033[K"


@pytest.mark.parametrize("name", world_names())
def test_the_world_can_be_read_again_without_its_file(name: str) -> None:
    world = load_world(name)
    about = about_of(load_profile("wheeltec_mini_mec"), world, on="sim")
    again = world_of(about)
    assert again.name == world.name
    assert again.start == pytest.approx(world.start, abs=1e-5)
    assert dict(again.aliases) == dict(world.aliases)
    for (label, outline), (label_before, before) in zip(again.outline(), world.outline(), strict=True):
        assert label == label_before
        assert all(min(math.dist(point, other) for other in before) < 1e-5 for point in outline)
    assert _places(again) == pytest.approx(_places(world), abs=1e-5)


def _places(world: World) -> list[float]:
    return [number for pose in world.places.values() for number in (pose.x_m, pose.y_m, pose.yaw_rad)]


def test_files_are_the_owners_alone_and_the_oldest_go_first(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "data")
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    recorder = Recorder(new_path(folder, "a robot"), Redactor(tuple, {}))
    recorder.start(dict)
    old = folder / "2020-01-01_00-00-00_x.mcap"
    old.write_bytes(b"x" * 100)
    os.utime(old, (0, 0))
    for number in range(4):
        (folder / f"{number}.mcap").write_bytes(b"x" * 100_000)
        os.utime(folder / f"{number}.mcap", (time.time() - 50 + number,) * 2)
    for name, age_s in (("begun", 1.0), ("abandoned", 100.0)):
        (folder / f"{name}.mcap").touch()
        os.utime(folder / f"{name}.mcap", (time.time() - age_s,) * 2)
    tidy(folder, most_bytes=250_000)
    recorder.close()
    assert stat.S_IMODE(recorder.path.stat().st_mode) == 0o600
    assert {path.name for path in folder.glob("*.mcap")} == {
        *("2.mcap", "3.mcap", "begun.mcap"),
        recorder.path.name,
    }, "an empty file may be one that another process has just begun"


def test_what_comes_too_fast_is_counted_and_told(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "a.mcap", Redactor(tuple, {}))
    for _ in range(MOST_WAITING + 7):
        recorder.take(CMD_VEL, TwistMessage(0.1, 0.0, 0.0))
    recorder.start(dict)
    recorder.close()
    assert [notice.reason.to_json() for notice in recorder.notices()][1:] == [
        {"code": "recording_dropped", "count": 7}
    ]
    recording = read(recorder.path)
    assert len(recording.commands) == MOST_WAITING
    assert recording.events[-1][1]["reason"] == {"code": "recording_dropped", "count": 7}


def test_a_full_disk_ends_the_recording_with_a_sentence_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    command = [
        sys.executable, "-m", "chatrobot", "do", WORDS, "turn right", "--fast", "--json",
        "--record", str(path), "--config-dir", str(tmp_path),
    ]  # fmt: skip
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        # Python would leave half a file of bytecode there, which nobody can import afterwards.
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, 30_000)),
    )
    events = [json.loads(line) for line in done.stdout.splitlines()]
    assert [event["outcome"] for event in events if event["event"] == "result"] == ["completed", "completed"]
    told = [event["reason"]["code"] for event in events if event["event"] == "notice"]
    assert (told == ["recording", "recording_failed"]) != ("The recording has ended: " in done.stderr)
    assert "Traceback" not in done.stderr
    assert done.returncode == 0


def test_a_text_behind_record_is_no_file(tmp_path: Path) -> None:
    chatrobot = Command(tmp_path)
    done = chatrobot("do", "--record", "turn left", "--fast", "--config-dir", str(tmp_path))
    assert done.code == 0
    (path,) = (tmp_path / "recordings").glob("*.mcap")
    assert read(path).words[0][1] == "turn left"
    again = chatrobot("do", "turn left", "--fast", f"--record={path}", "--config-dir", str(tmp_path))
    assert again.code == 2
    assert "is there already" in again.err


def test_nothing_is_recorded_where_nobody_asked(tmp_path: Path) -> None:
    assert Command(tmp_path)("do", "turn left", "--fast", "--config-dir", str(tmp_path)).code == 0
    assert not (tmp_path / "recordings").exists()


def test_odometry_keeps_its_order_on_simulated_time(recorded: tuple[Path, list[dict]]) -> None:
    with AnyReader([recorded[0]]) as bag:
        stamps = [
            message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
            for one, _, data in bag.messages()
            if one.topic == ODOM.name
            for message in [bag.deserialize(data, one.msgtype)]
        ]
    assert stamps == sorted(stamps)
    assert stamps[0] == pytest.approx(time.time(), abs=600.0)


def test_one_of_many_is_recorded_less_often_and_never_without_its_stop() -> None:
    thinning = Thinning()
    kept: list[tuple[float, Odometry | TwistMessage]] = []
    for tick in range(200):
        now_s, speed_mps = tick * 0.02, 0.3 if tick < 103 else 0.0
        odometry = Odometry(now_s, 0.006 * min(tick, 103), 0.0, 0.0, speed_mps, 0.0, 0.0)
        command = TwistMessage(speed_mps, 0.0, 0.0)
        kept += [(now_s, odometry)] if thinning.keeps(ODOM, odometry, now_s) else []
        kept += [(now_s, command)] if thinning.keeps(CMD_VEL, command, now_s) else []
    poses = [(now_s, said) for now_s, said in kept if isinstance(said, Odometry)]
    assert 20 <= len([now_s for now_s, _ in poses if now_s < 2.0]) <= 21
    assert 2 <= len([now_s for now_s, _ in poses if now_s >= 2.0]) <= 4
    assert max(said.x_m for _, said in poses) == pytest.approx(0.618)
    zeros = [now_s for now_s, said in kept if said == TwistMessage(0.0, 0.0, 0.0)]
    assert zeros[0] == pytest.approx(2.06), "at once"
