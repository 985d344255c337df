"""Whichever process of a class dies or freezes, every robot of it stands within 250 ms. In real time, against robots
that hold their last command for ever."""

from __future__ import annotations

import itertools
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.safety.class_rig import PATIENCE_S, RunningClass

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

PROMISE_S = 0.25


@pytest.fixture
def pupils(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RunningClass]:
    """A class that a test may strike."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    running = RunningClass(tmp_path / "config", 3)
    yield running
    running.close()


@pytest.fixture(scope="module")
def unharmed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """A class that outlives each test."""
    folder = tmp_path_factory.mktemp("class")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(folder))
        running = RunningClass(folder / "config", 3)
    yield running
    running.close()


@pytest.mark.parametrize("whom", ["motion", "guard"])
@pytest.mark.parametrize("how", ["SIGKILL", "SIGSTOP"])
def test_every_robot_of_a_class_stands_within_250_ms(pupils: RunningClass, whom: str, how: str) -> None:
    pupils.drive()
    assert pupils.seconds_to_zero(pupils.strike(whom, how)) <= PROMISE_S


def test_robots_whose_process_froze_do_not_drive_on_when_it_thaws(pupils: RunningClass) -> None:
    pupils.drive()
    pupils.strike("robots", "SIGSTOP")  # nothing moves while it is frozen: there is nothing left to move
    time.sleep(1.0)
    assert pupils.seconds_to_zero(pupils.strike("robots", "SIGCONT")) <= PROMISE_S


def test_a_class_whose_robots_are_gone_is_told_so_and_leaves_nobody_behind(pupils: RunningClass) -> None:
    pupils.drive()
    pupils.strike("robots", "SIGKILL")
    ends_s = time.monotonic() + PATIENCE_S
    links = [robot.connection.link for robot in pupils.robots]
    while not all(link.is_lost for link in links) and time.monotonic() < ends_s:
        time.sleep(0.01)
    assert all(link.is_lost for link in links)
    while _is_there(pupils.pids["guard"]) and time.monotonic() < ends_s:
        time.sleep(0.01)
    assert not _is_there(pupils.pids["guard"])


def test_a_frozen_talker_stops_them_all(pupils: RunningClass) -> None:
    pupils.drive()
    began_s = time.monotonic()
    for robot in pupils.robots:
        robot.connection.link.beats = False
    assert pupils.seconds_to_zero(began_s) <= 0.6, "a talker that runs and says nothing has 0.45 s"


def _is_there(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def test_one_pupils_stop_is_nobody_elses(unharmed: RunningClass) -> None:
    unharmed.drive()
    began_s = time.monotonic()
    unharmed.robots[0].connection.session.stop("enough")
    assert unharmed.heard[0].seconds_to_zero(began_s) <= PROMISE_S
    for ear in unharmed.heard[1:]:
        assert all(any(twist) for _, twist in ear.since(began_s))


def test_a_pupil_does_not_release_an_emergency_stop_and_the_teacher_does(unharmed: RunningClass) -> None:
    first = unharmed.robots[0]
    first.connection.session.emergency_stop("it burns")
    first.connection.session.release()
    assert unharmed.result(0, unharmed.say(0, "forward 10 cm")) == "refused"
    first.release()
    assert unharmed.result(0, unharmed.say(0, "forward 10 cm")) == "completed"


def test_who_leaves_in_order_leaves_the_others_driving(pupils: RunningClass) -> None:
    pupils.drive()
    pupils.robots[0].connection.session.stop("I go")
    pupils.robots[0].connection.close()
    left_s = time.monotonic()
    time.sleep(0.5)
    for ear in pupils.heard[1:]:
        heard = ear.since(left_s)
        assert len(heard) > 10
        assert all(any(twist) for _, twist in heard)
    os.kill(pupils.pids["motion"], signal.SIGSTOP)
    assert max(ear.seconds_to_zero(time.monotonic()) for ear in pupils.heard[1:]) <= PROMISE_S


def test_what_one_pupil_has_rehearsed_delays_nobody_else(unharmed: RunningClass) -> None:
    unharmed.drive()
    busy = unharmed.robots[0].connection.session
    busy.stop("another one")
    began_s = time.monotonic()
    busy.say_plan(
        "\n".join(f"drive 0.{place % 9 + 1} m\nturn left {place % 90 + 1} deg" for place in range(400))
    )
    for _ in range(20):
        busy.say("x" * 4000)
        busy.pump(0.02)
    time.sleep(1.0)
    for ear in unharmed.heard[1:]:
        heard = ear.since(began_s)
        assert all(any(twist) for _, twist in heard), "it was stopped"
        gaps_s = [later - at for (at, _), (later, _) in itertools.pairwise(heard)]
        assert max(gaps_s) < 0.15, "it would have been stopped a moment later"
