"""A full disk, memory that runs out, a reader that is gone: the robot stops or is not touched by it."""

from __future__ import annotations

import json
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from chatrobot.core.memory_pressure import GUARD, MOTION, prefer
from tests.cli.running import PATIENCE_S, environment
from tests.processes import RunningRobot

FULL = Path("/dev/full")
CHATROBOT = [sys.executable, "-m", "chatrobot"]


def no_more_bytes() -> None:
    """As on a full disk: every write to a file fails (in the child, before it begins)."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))


# --- a full disk ---


@pytest.mark.realtime
@pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")
def test_an_output_on_a_full_disk_stops_the_robot(tmp_path: Path) -> None:
    with FULL.open("wb") as full:
        done = subprocess.run(
            [*CHATROBOT, "do", "forward 100 m", "--json", "--world", "empty"],
            stdout=full,
            stderr=subprocess.PIPE,
            env=environment(tmp_path),
            timeout=PATIENCE_S,
            text=True,
        )
    assert done.returncode == 5
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("text", ["remember this place as base", "forward 20 cm"])
def test_a_full_disk_takes_nothing_from_what_the_robot_does(tmp_path: Path, text: str) -> None:
    """Places cannot be kept then; whoever is told so has driven all the same, and there is no traceback."""
    done = subprocess.run(
        [*CHATROBOT, "do", text, "forward 10 cm", "--fast", "--json", "--world", "empty"],
        capture_output=True,
        env=environment(tmp_path),
        timeout=PATIENCE_S,
        preexec_fn=no_more_bytes,
        text=True,
    )
    assert "Traceback" not in done.stderr, done.stderr
    results = [json.loads(line) for line in done.stdout.splitlines() if '"result"' in line]
    assert results[-1]["turn"] == 2, done.stdout + done.stderr
    assert results[-1]["outcome"] == "completed"


# --- memory ---


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[RunningRobot]:
    running = RunningRobot(tmp_path)
    yield running
    running.close()


def score(pid: int) -> int:
    return int(Path(f"/proc/{pid}/oom_score_adj").read_text(encoding="ascii"))


@pytest.mark.realtime
def test_when_memory_runs_out_the_guard_goes_last(robot: RunningRobot) -> None:
    (guard,) = robot.guard_pids()
    assert score(robot.motion_pid) == MOTION
    assert score(guard) in GUARD
    assert score(guard) < score(robot.motion_pid)


def in_a_child(code: str) -> str:
    """What it prints; a score is a process's own."""
    source = f"from chatrobot.core.memory_pressure import GUARD, MOTION, prefer\n{code}"
    return subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, check=True, timeout=PATIENCE_S
    ).stdout


def test_the_guard_of_a_motion_that_offered_itself_goes_after_it() -> None:
    """With root's right or without: back to where it began is always allowed."""
    first, then = in_a_child("print(prefer(MOTION), prefer(*GUARD))").split()
    assert int(first) == MOTION
    assert int(then) in GUARD


def test_a_system_without_scores_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("chatrobot.core.memory_pressure._FILE", "/nowhere/at/all")
    assert prefer(*GUARD) is None
