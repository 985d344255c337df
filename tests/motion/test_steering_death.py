"""A person holds a stick, and the process that steers dies, freezes or falls silent: zeros within 250 ms, at a
subscriber in another process, against a robot that holds its last command for ever."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.processes import PATIENCE_S, Heard, TalkingProcess

from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import TwistMessage

pytestmark = [pytest.mark.realtime, pytest.mark.alone]

PROMISE_S = 0.25
HOLDS = """
import sys, threading, time
from chatrobot.compose import Setup, connect
from chatrobot.core.events import Telemetry
from chatrobot.core.geometry import Twist
from chatrobot.dialogue.pump import Pump

met = threading.Event()
session = connect(Setup(world="empty"), lambda event: met.set() if isinstance(event, Telemetry) else None).session
Pump(session, lambda error: None).start()
assert met.wait(10.0)  # a stick that is pressed while nothing may move yet has to be let go first
is_held = True

def hear():
    global is_held
    for line in sys.stdin:
        is_held = False
        if line.strip() != "silent":
            session.steer(Twist(0.0, 0.0, 0.0)) if line.strip() == "zero" else session.stop("test")

threading.Thread(target=hear, daemon=True).start()
print("ready", flush=True)
while True:
    if is_held:
        session.steer(Twist(0.3, 0.0, 0.0))
    time.sleep(0.05)
"""


class Steering(TalkingProcess):
    """A process that holds a stick on a robot in real time, and an ear on the robot's wire."""

    def __init__(self, folder: Path) -> None:
        environment = {**os.environ, "XDG_RUNTIME_DIR": str(folder)}
        super().__init__([sys.executable, "-c", HOLDS], environment)
        try:
            self._meet(folder / "chatrobot")
        except BaseException:
            self.process.kill()  # its robot, Motion and guard leave with it
            self.process.wait()
            raise

    def _meet(self, runtime: Path) -> None:
        self.wait_for_line("ready")
        self.wire = LocalWire(next(runtime.glob("sim-*.wire")))
        self.velocities = Heard()
        self.wire.subscribe("cmd_vel", TwistMessage, self.velocities)
        self.velocities.wait_for_motion()
        ends_s = time.monotonic() + PATIENCE_S
        while not (sockets := list(runtime.glob("motion-*.stop"))) and time.monotonic() < ends_s:
            time.sleep(0.01)  # it is made by a thread of its own
        self.motion_pid = int(sockets[0].stem.removeprefix("motion-"))

    def close(self) -> None:
        self.wire.close()
        for pid in (self.process.pid, self.motion_pid):
            for number in (signal.SIGCONT, signal.SIGKILL):
                try:
                    os.kill(pid, number)
                except ProcessLookupError:
                    break
        self.process.wait(PATIENCE_S)


@pytest.fixture
def steering(tmp_path: Path) -> Iterator[Steering]:
    running = Steering(tmp_path)
    yield running
    running.close()


def seconds_to_zero_after(steering: Steering, strike: Callable[[], object]) -> float:
    steering.velocities.wait_for_motion()
    time.sleep(0.5)
    began_s = time.monotonic()
    strike()
    return steering.velocities.seconds_to_zero(began_s)


@pytest.mark.parametrize("how", ["SIGKILL", "SIGSTOP"])
def test_zeros_come_within_250_ms_of_the_end_of_the_process_that_steers(steering: Steering, how: str) -> None:
    pid = steering.process.pid
    assert seconds_to_zero_after(steering, lambda: os.kill(pid, getattr(signal, how))) <= PROMISE_S


def test_the_beats_of_its_process_do_not_keep_a_stick_that_falls_silent(steering: Steering) -> None:
    assert seconds_to_zero_after(steering, lambda: steering.say("silent")) <= PROMISE_S


def test_a_frozen_motion_is_stopped_by_its_guard(steering: Steering) -> None:
    pid = steering.motion_pid
    assert seconds_to_zero_after(steering, lambda: os.kill(pid, signal.SIGSTOP)) <= PROMISE_S
    thawed_s = time.monotonic()
    os.kill(pid, signal.SIGCONT)
    assert steering.velocities.seconds_to_zero(thawed_s) <= PROMISE_S, (
        "the stick is still held: it counts no more"
    )
