"""`chatrobot doctor` tells what it has tried; `chatrobot sim` serves a robot."""

from __future__ import annotations

import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from chatrobot.wire.local import LocalWire
from tests.cli.running import PATIENCE_S, Command, environment

pytestmark = pytest.mark.realtime


def test_doctor_measures_what_works_and_says_what_does_not_yet(chatrobot: Command) -> None:
    done = chatrobot("doctor", "--json")
    states = {event["name"]: event["state"] for event in done.events}
    assert done.code == 0
    assert states["simulated robot"] == states["in real time"] == states["settings folder"] == "ok"
    assert states["language model"] == "later"
    assert states["ROS 2"] == ("ok" if find_spec("rclpy") else "later")


def test_doctor_fails_where_something_has_to_be_mended(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("", encoding="utf-8")
    done = chatrobot("doctor", "--config-dir", str(file))
    assert done.code == 1
    assert "✗ settings folder" in done.out


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
