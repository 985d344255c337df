"""`chatrobot calibrate` at a terminal, with a simulated robot that lies: the person measures what it really did."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pexpect
import pytest

from chatrobot.robots.load import load_profile
from chatrobot.wire.local import LocalHub
from tests.cli.running import Command, environment
from tests.cli.test_terminal import Terminal, code

SLIPS = ["--fast", "--sim", "slip=0.05,noise=on,seed=3"]
PROFILE = Path("config/chatrobot/robots/wheeltec_mini_mec.toml")


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    made = Terminal(tmp_path)
    yield made
    made.close()


def seen(child: pexpect.spawn[str], pattern: str) -> float:
    child.expect(pattern)
    match = child.match
    assert isinstance(match, re.Match)
    return float(match[1])


def test_a_simulated_robot_is_measured_by_the_simulation(terminal: Terminal, tmp_path: Path) -> None:
    child = terminal("calibrate", *SLIPS)
    child.expect("This is a simulated robot")
    child.expect("Drive one metre.*leave")
    child.sendline("y")
    assert seen(child, r"It really went ([\d.]+) m") == pytest.approx(0.95, abs=0.005)
    child.expect("Turn once.*leave")
    child.sendline("y")
    assert seen(child, r"It really turned ([\d.]+)°") == pytest.approx(360.0, abs=2.0)
    child.expect("Saved in")
    assert code(child) == 0
    calibration = load_profile(str(tmp_path / PROFILE)).calibration
    assert calibration.distance_scale == pytest.approx(0.95, abs=0.002)
    assert calibration.turn_scale == pytest.approx(1.0, abs=0.002)

    trace = Command(tmp_path)("do", "forward 1 m", *SLIPS, "--world", "empty", "--json", "--trace")
    assert trace.named("pose")[-1]["x_m"] == pytest.approx(1.0, abs=0.01)


def test_a_correction_is_taken_back_and_the_built_in_profile_counts_again(tmp_path: Path) -> None:
    chatrobot = Command(tmp_path)
    assert "Saved in" in chatrobot("calibrate", *SLIPS, stdin="y\nskip\n").out
    assert (tmp_path / PROFILE).exists()
    reset = chatrobot("calibrate", "--reset")
    assert (reset.code, "is removed (distances 0.9" in reset.out) == (0, True)
    assert not (tmp_path / PROFILE).exists()
    again = chatrobot("calibrate", "--reset")
    assert (again.code, "There is no correction of wheeltec_mini_mec to remove." in again.out) == (0, True)


@pytest.fixture
def wire(tmp_path: Path) -> Iterator[str]:
    """Of a robot that no simulation of this command's knows: somebody measures it."""
    robot = subprocess.Popen(
        [sys.executable, "-m", "chatrobot", "sim", "--socket", str(tmp_path / "wire"), "--world", "empty"],
        env=environment(tmp_path),
        stdout=subprocess.DEVNULL,
    )
    while not (tmp_path / "wire").exists():
        assert robot.poll() is None
        time.sleep(0.02)
    yield f"local:{tmp_path / 'wire'}"
    robot.terminate()
    robot.wait()


@pytest.mark.realtime
def test_of_any_other_robot_a_person_measures_what_it_did(
    terminal: Terminal, tmp_path: Path, wire: str
) -> None:
    child = terminal("calibrate", "--on", wire)
    child.expect("Mark where a wheel stands")
    child.sendline("y")
    metre = seen(child, r"Odometry says ([\d.]+) m")
    child.sendline("a lot")
    child.expect("a length or an angle above zero")
    child.sendline(f"{metre * 95:.2f} cm")
    child.expect("Turn once.*leave")
    child.sendline("skip")
    child.expect("Saved in")
    assert code(child) == 0
    assert "simulated robot" not in (child.before or "")
    calibration = load_profile(str(tmp_path / PROFILE)).calibration
    assert calibration.distance_scale == pytest.approx(0.95, abs=0.002)


@pytest.mark.realtime
def test_what_is_far_off_is_said_and_not_saved(terminal: Terminal, tmp_path: Path, wire: str) -> None:
    child = terminal("calibrate", "--on", wire)
    child.expect("Drive one metre.*leave")
    child.sendline("y")
    child.expect("How far")
    child.sendline("3")
    child.expect("Turn once.*leave")
    child.sendline("skip")
    child.expect("right profile")
    assert code(child) == 1
    assert not (tmp_path / PROFILE).exists()


def test_a_robot_that_does_not_fit_its_profile_is_noticed(terminal: Terminal, tmp_path: Path) -> None:
    child = terminal("calibrate", "--fast", "--sim", "odom_wrong=reversed")
    child.expect("Drive one metre.*leave")
    child.sendline("y")
    child.expect("other way")
    child.expect("does not do what its profile wheeltec_mini_mec says")
    assert code(child) == 1
    assert not (tmp_path / PROFILE).exists()


def test_whoever_says_no_moves_nothing(terminal: Terminal, tmp_path: Path) -> None:
    child = terminal("calibrate", "--fast")
    child.expect("Drive one metre.*leave")
    child.sendline("no")
    assert code(child) == 5
    assert not (tmp_path / PROFILE).exists()


@pytest.mark.realtime
def test_stop_stops_it_while_it_drives(terminal: Terminal, tmp_path: Path) -> None:
    child = terminal("calibrate")
    child.expect("Drive one metre.*leave")
    child.sendline("y")
    child.expect("0.[1-5]")
    child.sendline("stop")
    child.expect("Stopped")
    assert code(child) == 5
    assert not (tmp_path / PROFILE).exists()


def test_it_needs_a_person(tmp_path: Path) -> None:
    done = Command(tmp_path)("calibrate", "--json")
    assert (done.code, "measure" in done.err) == (2, True)


def test_its_help_says_what_happens_where_it_is_saved_and_how_to_take_it_back(tmp_path: Path) -> None:
    shown = " ".join(Command(tmp_path)("calibrate", "--help").out.split())
    for part in ("drives one metre, then turns once", '"robots" of the configuration folder', "--reset", "--fast",
                 "skip", "exit codes"):  # fmt: skip
        assert part in shown


def test_without_odometry_nobody_is_asked_to_measure(tmp_path: Path) -> None:
    chatrobot = Command(tmp_path)
    done = chatrobot("calibrate", "--robot", "no_odometry")
    assert (done.code, "has no odometry" in done.out) == (1, True)


@pytest.mark.realtime
def test_a_robot_that_says_nothing_is_told_of_before_anybody_measures(tmp_path: Path) -> None:
    hub = LocalHub(tmp_path / "silent.sock")
    done = Command(tmp_path).apart("calibrate", "--on", f"local:{hub.path}")
    hub.close()
    assert (done.code, "No odometry arrives" in done.out, "needs odometry" in done.out) == (1, True, True)
    assert "Mark where" not in done.out
