"""The simulated robot in a process of its own: ready, real time, deaf to a terminal's signals, gone when all
have left."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from sim_rig import PROFILE

from chatrobot.core.clock import RealClock, VirtualClock
from chatrobot.sim.__main__ import _server
from chatrobot.sim.fault_injection import NO_FAULTS
from chatrobot.sim.obstacle_control import CONTROL_TOPIC, REPLY_TOPIC
from chatrobot.sim.robot import TRUTH_TOPIC, SimRobot
from chatrobot.sim.server import GAP_S, LAST_CLIENT_GONE_S, SimServer, Simulation
from chatrobot.sim.world import EMPTY_WORLD
from chatrobot.wire.local import LocalHub, LocalWire
from chatrobot.wire.messages import LaserScan, Odometry, Text, TwistMessage

PATIENCE_S = 20.0


@dataclass
class Running:
    process: subprocess.Popen[bytes]
    path: Path
    ready: bytes


@contextlib.contextmanager
def simulation(path: Path, *options: str) -> Iterator[Running]:
    reader, writer = os.pipe()
    command = [sys.executable, "-m", "chatrobot.sim", "--profile", "wheeltec_mini_mec", "--socket", str(path)]
    process = subprocess.Popen(
        [*command, "--ready-fd", str(writer), *options],
        pass_fds=[writer],
        start_new_session=True,
        stderr=subprocess.PIPE,
    )
    os.close(writer)
    try:
        readable, _, _ = select.select([reader], [], [], PATIENCE_S)
        yield Running(process, path, os.read(reader, 100) if readable else b"too late")
    finally:
        os.close(reader)
        process.kill()
        process.communicate()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "sim"


def test_it_drives_while_somebody_is_there_and_ends_when_they_leave(path: Path) -> None:
    with simulation(path, "--world", "empty", "--sim", "slip=0.1") as running:
        assert running.ready == b"ready\n"
        wire = LocalWire(path)
        reported, truth = threading.Event(), threading.Event()
        wire.subscribe("odom", Odometry, lambda sample: reported.set() if sample.x_m > 0.05 else None)
        wire.subscribe(TRUTH_TOPIC, Odometry, lambda sample: truth.set() if sample.x_m > 0.05 else None)
        wire.publish("cmd_vel", TwistMessage(0.5, 0.0, 0.0))
        assert reported.wait(PATIENCE_S)
        assert truth.wait(PATIENCE_S)
        wire.close()
        assert running.process.wait(PATIENCE_S) == 0
        assert not path.exists()


@pytest.mark.parametrize("ignored", [signal.SIGINT, signal.SIGHUP, signal.SIGTSTP])
def test_signals_of_a_terminal_do_not_reach_it(path: Path, ignored: signal.Signals) -> None:
    with simulation(path, "--world", "empty") as running:
        wire = LocalWire(path)
        arrived = threading.Semaphore(0)
        wire.subscribe("odom", Odometry, lambda _: arrived.release())
        assert arrived.acquire(timeout=PATIENCE_S)  # its signal handlers are set by now
        running.process.send_signal(ignored)
        for _ in range(50):
            assert arrived.acquire(timeout=PATIENCE_S)
        wire.close()


def test_a_request_to_terminate_ends_it_in_good_order(path: Path) -> None:
    with simulation(path, "--world", "empty") as running:
        wire = LocalWire(path)
        arrived = threading.Event()
        wire.subscribe("odom", Odometry, lambda _: arrived.set())
        assert arrived.wait(PATIENCE_S)
        running.process.terminate()
        assert running.process.wait(PATIENCE_S) == 0
        assert not path.exists()
        wire.close()


def test_a_wall_can_be_put_in_its_way(path: Path) -> None:
    with simulation(path, "--world", "empty"):
        wire = LocalWire(path)
        replies: list[dict[str, str]] = []
        replied, seen = threading.Semaphore(0), threading.Event()

        def on_reply(message: Text) -> None:
            replies.append(json.loads(message.data))
            replied.release()

        wire.subscribe(REPLY_TOPIC, Text, on_reply)
        wire.subscribe("scan", LaserScan, lambda scan: seen.set() if min(scan.ranges_m) < 1.0 else None)
        requests = (
            {"add": "person", "circle": [1.0, 0.0, 0.3]},
            {"add": "wall", "polygon": [[2, -1], [2.1, -1], [2.1, 1], [2, 1]]},
            {"remove": "wall"},
            {"remove": "wall"},
            {"add": "line", "polygon": [[0, 0], [1, 1]]},
            {"add": "nothing"},
            {"add": "far", "circle": [1e999, 0, 1]},
            [1, 2],
        )
        for request in requests:
            wire.publish(CONTROL_TOPIC, Text(json.dumps(request)))
            assert replied.acquire(timeout=PATIENCE_S)
        assert replies[:3] == [{"done": "person"}, {"done": "wall"}, {"done": "wall"}]
        assert all("error" in reply for reply in replies[3:])
        assert len(replies) == len(requests)
        assert seen.wait(PATIENCE_S)
        wire.close()


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--sim", "slop=1"), b"slip"),
        (("--world", "moon"), b"home"),
        (("--profile", "no_such_robot"), b"no_such_robot"),
    ],
)
def test_wrong_options_end_it_at_once_and_say_what_is_allowed(
    path: Path, options: tuple[str, ...], named: bytes
) -> None:
    with simulation(path, *options) as running:
        assert running.ready == b""
        _, errors = running.process.communicate(timeout=PATIENCE_S)
        assert running.process.returncode == 2
        assert named in errors
        assert b"Traceback" not in errors


@pytest.fixture
def parts(path: Path) -> Iterator[tuple[VirtualClock, SimRobot, SimServer, LocalHub]]:
    clock, hub = VirtualClock(100.0), LocalHub(path)
    robot = SimRobot(PROFILE, wire=hub, clock=clock)
    yield clock, robot, SimServer(robot, hub, clock), hub
    hub.close()


Parts = tuple[VirtualClock, SimRobot, SimServer, LocalHub]


def test_a_late_step_catches_up(parts: Parts) -> None:
    clock, robot, server, hub = parts
    samples: list[Odometry] = []
    hub.subscribe("odom", Odometry, samples.append)
    clock.advance(0.9 * GAP_S)
    server.catch_up()
    assert robot.now_s == clock.now_s()
    assert len(samples) == 45


def test_after_a_freeze_it_goes_on_where_it_was(parts: Parts) -> None:
    clock, robot, server, hub = parts
    samples: list[Odometry] = []
    hub.subscribe("odom", Odometry, samples.append)
    hub.publish("cmd_vel", TwistMessage(0.5, 0.0, 0.0))
    clock.advance(0.4)
    server.catch_up()
    before = robot.true_pose
    clock.advance(30.0)
    server.catch_up()
    assert robot.true_pose == before
    assert robot.now_s == clock.now_s()
    clock.advance(0.1)
    server.catch_up()
    assert robot.true_pose.x_m == pytest.approx(before.x_m + 0.05)
    assert len(samples) == 50
    assert samples[-1].stamp_s == pytest.approx(clock.now_s())


def test_a_command_acts_from_when_it_came_however_late_it_is_read(path: Path) -> None:
    hub = LocalHub(path)
    server = _server(PROFILE, EMPTY_WORLD, NO_FAULTS, hub, 0.0)
    robot, simulation, wire = server._robot, Simulation([server], RealClock()), LocalWire(path)
    while not hub.client_count:
        simulation._live()

    def live(duration_s: float) -> None:
        ends_s = time.monotonic() + duration_s
        while time.monotonic() < ends_s:
            simulation._live()

    wire.publish("cmd_vel", TwistMessage(0.2, 0.0, 0.0))
    live(0.3)
    before_m = robot.true_pose.x_m
    assert before_m > 0.0
    wire.publish("cmd_vel", TwistMessage(0.0, 0.0, 0.0))
    time.sleep(0.8 * GAP_S)  # this process does not run
    live(0.05)
    assert robot.true_pose.x_m - before_m < 0.04, "it began to brake when it was told to"
    assert robot.true_twist.is_zero
    wire.close()
    hub.close()


def test_many_robots_in_one_process_meet_nobody_and_each_leaves_with_its_last_client(tmp_path: Path) -> None:
    paths = [tmp_path / f"{place}.wire" for place in range(3)]
    more = [word for path in paths[1:] for word in ("--socket", str(path))]
    with simulation(paths[0], "--world", "empty", *more) as running:
        wires = [LocalWire(path) for path in paths]
        heard: list[list[Odometry]] = [[] for _ in wires]
        for wire, odometry in zip(wires, heard):
            wire.subscribe("odom", Odometry, odometry.append)
        wires[1].publish("cmd_vel", TwistMessage(0.3, 0.0, 0.0))
        ends_s = time.monotonic() + PATIENCE_S
        while not (heard[1] and heard[1][-1].x_m > 0.1) and time.monotonic() < ends_s:
            time.sleep(0.01)
        assert heard[1][-1].x_m > 0.1
        assert heard[0][-1].x_m == heard[2][-1].x_m == 0.0
        for wire in wires[:2]:
            wire.close()
        ends_s = time.monotonic() + LAST_CLIENT_GONE_S + PATIENCE_S
        while (paths[0].exists() or paths[1].exists()) and time.monotonic() < ends_s:
            time.sleep(0.02)
        assert [path.exists() for path in paths] == [False, False, True]
        before = len(heard[2])
        time.sleep(0.2)
        assert len(heard[2]) > before, "it goes on"
        wires[2].close()
        assert running.process.wait(PATIENCE_S) == 0
