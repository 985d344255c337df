"""One thread ticks many robots: each at its own time, and what befalls one of them is not the others' affair."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import pytest

from chatrobot.core.errors import WireError
from chatrobot.motion.control_loop import ControlLoop
from chatrobot.wire.runtime_dir import stop_socket_paths

PATIENCE_S = 5.0


class Robot:
    """A `Driven` that notes when it is ticked."""

    def __init__(self, found: str = "standing") -> None:
        self.ticks: list[float] = []
        self.has_left = False
        self.is_gone = False
        self.done: list[str] = []
        self._found = found

    def tick(self) -> None:
        self.ticks.append(time.monotonic())
        if self.is_gone:
            raise WireError("gone")

    def look_out(self) -> None: ...
    def thaw(self) -> None: ...

    def stop(self) -> str:
        self.done.append("stop")
        if self.is_gone:
            raise WireError("gone")
        return self._found

    def leave(self) -> None:
        self.done.append("leave")

    def give_up(self) -> None:
        self.done.append("give up")

    def close(self) -> None:
        self.done.append("close")


class Running:
    """A control loop in a thread, with these robots."""

    def __init__(self, *robots: Robot) -> None:
        self.robots, self.loop = robots, ControlLoop()
        self.lost: list[WireError] = []
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self) -> None:
        try:
            self.loop.run(self.robots)
        except WireError as error:
            self.lost.append(error)

    def end(self) -> None:
        for robot in self.robots:
            robot.has_left = True
        self.thread.join(PATIENCE_S)
        assert not self.thread.is_alive()


@pytest.fixture
def robots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Robot, ...]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tuple(Robot(found) for found in ("standing", "moving", "waiting"))


def wait_for_ticks(*robots: Robot) -> None:
    counts = [len(robot.ticks) for robot in robots]
    ends_s = time.monotonic() + PATIENCE_S
    while any(len(robot.ticks) < count + 3 for robot, count in zip(robots, counts)):
        assert time.monotonic() < ends_s, "not ticked"
        time.sleep(0.005)


def test_all_of_them_are_ticked_until_each_has_left(robots: tuple[Robot, ...]) -> None:
    running = Running(*robots)
    wait_for_ticks(*robots)
    robots[0].has_left = True
    wait_for_ticks(*robots[1:])
    running.end()
    assert not running.lost
    assert all(robot.done == ["leave", "close"] for robot in robots)
    assert not stop_socket_paths()


def test_who_is_woken_is_ticked_before_its_time_and_again_at_it(robots: tuple[Robot, ...]) -> None:
    running = Running(robots[0])
    wait_for_ticks(robots[0])
    ended = time.monotonic() + 0.2
    while time.monotonic() < ended:
        running.loop.wake(robots[0])
        time.sleep(0.002)
    running.end()
    assert len([tick for tick in robots[0].ticks if tick > ended - 0.2]) > 25, "10 were due"


def test_one_whose_wire_is_gone_leaves_the_others_driving_and_is_told_in_the_end(
    robots: tuple[Robot, ...],
) -> None:
    running = Running(*robots)
    robots[1].is_gone = True
    wait_for_ticks(robots[0], robots[2])
    assert robots[1].done == ["give up"]
    running.end()
    assert running.lost


def test_a_stop_from_outside_stops_them_all_and_tells_of_the_one_that_moved(
    robots: tuple[Robot, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    from chatrobot.cli import stop

    running = Running(*robots)
    wait_for_ticks(*robots)
    robots[0].is_gone = True
    assert stop.run() == 0
    assert "It was moving" in capsys.readouterr().out
    running.end()
    assert all("stop" in robot.done for robot in robots)
