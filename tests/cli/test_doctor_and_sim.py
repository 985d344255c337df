"""`chatrobot doctor` tells what it has tried; `chatrobot sim` serves a robot."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from chatrobot.cli.doctor import Check, _told_once
from chatrobot.robots.load import list_profiles
from chatrobot.wire.local import LocalWire
from tests.cli.running import PATIENCE_S, Command, environment

pytestmark = pytest.mark.realtime


def test_doctor_measures_what_works_and_says_what_does_not_yet(chatrobot: Command) -> None:
    done = chatrobot.apart("doctor", "--json")
    states = {event["name"]: event["state"] for event in done.events}
    assert done.code == 0
    assert states["simulated robot"] == states["in real time"] == states["settings folder"] == "ok"
    assert states["language model"] == "later"
    assert states["ROS 2"] == ("ok" if find_spec("rclpy") else "later")


def test_doctor_fails_where_something_has_to_be_mended(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("", encoding="utf-8")
    done = chatrobot.apart("doctor", "--config-dir", str(file))
    assert done.code == 1
    assert "✗ settings folder" in done.out


def test_doctor_tells_an_error_once_and_looks_at_the_rest(chatrobot: Command, tmp_path: Path) -> None:
    (tmp_path / "places.json").write_text("{broken", encoding="utf-8")
    done = chatrobot.apart("doctor", "--robot", "r2d2", "--model", "clippy:95", "--config-dir", str(tmp_path))
    assert "✗ remembered places, words" in done.out
    assert done.code == 1
    assert (done.out + done.err).count("no robot profile is called 'r2d2'") == 1
    assert "✓ simulated robot" in done.out
    assert done.out.count("clippy:95") == 1


def test_doctor_knows_a_profile_of_ones_own(chatrobot: Command, tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    built_in = next(entry.file for entry in list_profiles() if entry.name == "turtlebot4")
    shutil.copy(built_in, tmp_path / "robots" / "mine.toml")
    done = chatrobot.apart("doctor", "--robot", "mine", "--config-dir", str(tmp_path))
    assert "✓ robot profile     mine: TurtleBot 4" in done.out
    assert "✓ in real time" in done.out


def test_what_two_checks_find_is_told_by_the_first() -> None:
    first = Check("simulated robot", "missing", "it is broken")
    second = Check("in real time", "missing", "it is broken")
    assert _told_once(second, [first]) == "as above: simulated robot"
    assert _told_once(first, []) == "it is broken"


def test_a_socket_where_none_can_be_is_named_with_the_way_out(tmp_path: Path) -> None:
    path = str(tmp_path / "none" / "robot.wire")
    command = [sys.executable, "-m", "chatrobot", "sim", "--socket", path]
    done = subprocess.run(
        command, capture_output=True, env=environment(tmp_path), text=True, timeout=PATIENCE_S
    )
    said = f"{path}: no wire can be served there (No such file or directory) (--socket PATH: "
    assert (done.returncode, said in done.stderr) == (2, True)


def test_sim_serves_a_robot_until_ctrl_c(tmp_path: Path) -> None:
    path = tmp_path / "robot.wire"
    with subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "sim", "--socket", str(path), "--world", "empty"],
        stdout=subprocess.PIPE,
        env=environment(tmp_path),
        text=True,
    ) as process:
        assert process.stdout is not None
        assert str(path) in process.stdout.readline()
        wire = LocalWire(path)
        wire.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE_S) == 0
        assert not path.exists()
