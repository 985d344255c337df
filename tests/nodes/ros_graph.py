"""Nodes of ours on a graph of ROS whose rclpy is a fake: each runs in a thread of the test's own process."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "wire"))
import fake_rclpy

from chatrobot.cli import node as command
from chatrobot.cli.arguments import parse
from chatrobot.core.clock import VirtualClock
from chatrobot.core.wiring import Wiring
from chatrobot.motion import runner
from chatrobot.motion.safety import connection_monitor, stop
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.wire.connect import connect_wire

PATIENCE_S = 10.0


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> fake_rclpy.Ros:
    return fake_rclpy.install(monkeypatch)


class Guard(SimulatedGuard):
    """In place of the guard's process, which has no fake of ROS."""

    def __init__(self, address: str, wiring: Any, clock: Any, *, is_near: bool) -> None:
        super().__init__(VirtualClock())
        self.given_clock = clock
        self.halts = address, wiring.cmd_vel_topic, wiring.odom_topic
        self.namespace = wiring.namespace
        self.is_near = is_near

    def wait_until_alive(self, _timeout_s: float) -> bool:
        return True


@pytest.fixture
def guards(monkeypatch: pytest.MonkeyPatch) -> list[Guard]:
    """Of each control, as it starts. No robot is there: it is not looked for long, nor waited for until it stands."""
    monkeypatch.setattr(connection_monitor, "SURVEY_S", 0.05)
    monkeypatch.setattr(stop, "PATIENCE_S", 0.2)
    made: list[Guard] = []

    def make(addresses: Sequence[str], wiring: Any, clock: Any, *, is_near: bool) -> Guard:
        made.append(Guard(addresses[0], wiring, clock, is_near=is_near))
        return made[-1]

    monkeypatch.setattr(runner, "start_guard", make)
    return made


class Watch:
    """In place of the signals': this is not the main thread."""

    leaving = threading.Event()

    def __init__(self, stop: Callable[[str], None], *, repeats_s: float) -> None:
        self._stop = stop
        assert repeats_s > 0.0, "ros2 launch sends a second Ctrl-C"

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, *_: object) -> None: ...

    @property
    def is_leaving(self) -> bool:
        return self.leaving.is_set()


class Silent:
    """In place of a keyboard."""

    has_ended = False

    def __init__(self, on_line: object) -> None: ...
    def start(self) -> None: ...

    def wait(self, timeout_s: float) -> None:
        threading.Event().wait(timeout_s)


def until(condition: Callable[[], bool]) -> None:
    for _ in range(round(PATIENCE_S / 0.01)):
        if condition():
            return
        threading.Event().wait(0.01)
    raise AssertionError("it did not become so")


@contextmanager
def running(monkeypatch: pytest.MonkeyPatch, ros: fake_rclpy.Ros, *arguments: str) -> Iterator[list[int]]:
    """`chatrobot node …` in a thread, once its services are there; its exit code once it has ended."""
    monkeypatch.setattr(command, "SignalWatch", Watch)
    monkeypatch.setattr(Watch, "leaving", threading.Event())
    known = len(ros.nodes)
    codes: list[int] = []
    args = parse(["node", "--on", "ros", *arguments])
    thread = threading.Thread(target=lambda: codes.append(command.run(args)))
    thread.start()

    def is_there() -> bool:
        assert thread.is_alive()
        return len(ros.nodes) > known and bool(ros.nodes[-1].timers or arguments[0] == "input")

    try:
        until(is_there)
        yield codes
    finally:
        Watch.leaving.set()
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
    assert len(ros.nodes) == known, "the node is still there"


@pytest.fixture
def ear(ros: fake_rclpy.Ros) -> Iterator[Any]:  # noqa: ARG001
    wire = connect_wire("ros:", Wiring(), "ear")
    yield wire
    wire.close()
