"""`chatrobot robots` and `chatrobot worlds`."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from chatrobot.cli.entry import main
from chatrobot.robots.load import list_profiles
from chatrobot.sim.load import load_world, world_names

Output = pytest.CaptureFixture[str]


def test_every_robot_has_a_line(capsys: Output, tmp_path: Path) -> None:
    assert main(["robots", "--config-dir", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [entry.name for entry in list_profiles()]
    assert "Wheeltec mini mecanum" in lines[-1]
    assert "1 m/s" in lines[-1]


def test_robots_in_json_carry_the_limits(capsys: Output, tmp_path: Path) -> None:
    assert main(["robots", "--json", "--config-dir", str(tmp_path)]) == 0
    for line in capsys.readouterr().out.splitlines():
        robot = json.loads(line)
        assert robot["event"] == "robot"
        assert robot["max_speed_mps"] > 0


def test_a_profile_of_ones_own_is_marked_and_a_broken_one_hides_no_other(
    capsys: Output, tmp_path: Path
) -> None:
    (tmp_path / "robots").mkdir()
    built_in = next(entry.file for entry in list_profiles() if entry.name == "turtlesim")
    from_windows = b"\xef\xbb\xbf" + built_in.read_bytes()
    (tmp_path / "robots" / "mine.toml").write_bytes(from_windows)
    (tmp_path / "robots" / "broken.toml").write_text("title = 3", encoding="utf-8")
    os.mkfifo(tmp_path / "robots" / "pipe.toml")  # nobody writes into it
    assert main(["robots", "--config-dir", str(tmp_path)]) == 1
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    assert f"yours: {tmp_path}" in lines["mine"]
    assert "cannot be used" in lines["broken"]
    assert "not a file" in lines["pipe"]
    assert "wheeltec_mini_mec" in lines


def test_no_text_of_a_profile_can_command_the_terminal(capsys: Output, tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    built_in = next(entry.file for entry in list_profiles() if entry.name == "turtlesim")
    lines = built_in.read_text("utf-8").splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("title"))
    for name, line in (("title", r'title = "red \u001b[31m"'), ("key", r'"\u001b[31m" = 3')):
        text = "\n".join((*lines[:at], line, *lines[at + 1 :]))
        (tmp_path / "robots" / f"{name}.toml").write_text(text, "utf-8")
    assert main(["robots", "--config-dir", str(tmp_path)]) == 1
    told = capsys.readouterr().out
    assert "has control characters" in told
    assert "\x1b" not in told


def test_every_world_has_a_line_and_can_be_used(capsys: Output) -> None:
    assert main(["worlds"]) == 0
    lines = capsys.readouterr().out.splitlines()
    names = [line.split()[0] for line in lines[:-1]]
    assert names == world_names()
    assert len(names) == 7
    assert "kitchen" in lines[names.index("home")]
    assert main(["worlds", "--json"]) == 0
    for line in capsys.readouterr().out.splitlines():
        world = json.loads(line)
        assert world["places"] == list(load_world(world["name"]).places)
