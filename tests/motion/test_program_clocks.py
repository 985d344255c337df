"""A program hears its robot once a tick, whatever clock it is on, and can hold nobody up."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise
from textwrap import dedent

import pytest

from chatrobot.core.clock import VirtualClock
from chatrobot.core.geometry import ZERO_TWIST
from chatrobot.motion.programs.clocks import MOST_KEPT, SensorMailbox, SteppedProgram
from chatrobot.programs.events import Beat, Died, Ended, Output
from chatrobot.programs.pipe import ProgramSettings, robot_topics
from chatrobot.programs.sandboxed import SandboxedProgram, warm_server
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.fault_injection import NO_FAULTS
from chatrobot.sim.robot import SimRobot
from chatrobot.sim.world import EMPTY_WORLD
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Flag, Odometry

PROFILE = load_profile("wheeltec_mini_mec")
LISTENER = """
    import rclpy
    from nav_msgs.msg import Odometry
    rclpy.init()
    node = rclpy.create_node("listener")
    node.create_subscription(Odometry, "odom", lambda message: print(message.header.stamp.nanosec), 10)
    while rclpy.ok():
        rclpy.spin_once(node)
"""
FLOOD = """
    import json, os, struct
    body = json.dumps(["beat", 0]).encode()
    while True:
        os.write(3, struct.pack("!I", len(body)) + body)
"""


@pytest.fixture(scope="module")
def server() -> Iterator[WarmServer]:
    with warm_server() as warm:
        warm.start()
        yield warm


def program(server: WarmServer, source: str, horizon_s: float = 100.0) -> SandboxedProgram:
    settings = ProgramSettings(dedent(source), topics=robot_topics(PROFILE.wiring), horizon_s=horizon_s)
    started = SandboxedProgram(server, settings)
    started.start()
    return started


def test_of_a_tick_the_newest_measurement_and_every_press_of_the_bumper_is_kept() -> None:
    hub = MemoryHub()
    mailbox, robot = SensorMailbox(), hub.connect()
    mailbox.attach(hub.connect(), PROFILE.wiring)
    mailbox.listen("odom", 10)
    mailbox.listen("bumper", 10)
    odom, bumper = PROFILE.wiring.odom_topic, PROFILE.wiring.bumper_topic
    assert odom is not None
    assert bumper is not None
    for x_m in (0.1, 0.2):
        robot.publish(odom, Odometry(77.0, x_m, 0.0, 0.0, *ZERO_TWIST))
    for is_pressed in (True, False):
        robot.publish(bumper, Flag(is_pressed))
    mailbox.collect(0.02)
    assert mailbox.take() == [
        ["odom", 0.02, 0.2, 0.0, 0.0, *ZERO_TWIST],
        ["bumper", 0.02, True],
        ["bumper", 0.02, False],
    ]
    assert not mailbox.take()


def test_a_mailbox_that_nobody_empties_does_not_grow() -> None:
    hub = MemoryHub()
    mailbox, robot = SensorMailbox(), hub.connect()
    mailbox.attach(hub.connect(), PROFILE.wiring)
    mailbox.listen("bumper", 10**6)
    assert PROFILE.wiring.bumper_topic is not None
    for tick in range(1, 5):
        for _ in range(2 * MOST_KEPT):
            robot.publish(PROFILE.wiring.bumper_topic, Flag(True))
        mailbox.collect(0.02 * tick)
    assert len(mailbox.take()) == MOST_KEPT


def test_another_program_hears_nothing_of_what_the_one_before_listened_to() -> None:
    hub = MemoryHub()
    mailbox, robot = SensorMailbox(), hub.connect()
    mailbox.attach(hub.connect(), PROFILE.wiring)
    mailbox.listen("odom", 10)
    mailbox.forget()
    assert PROFILE.wiring.odom_topic is not None
    robot.publish(PROFILE.wiring.odom_topic, Odometry(0.0, 1.0, 0.0, 0.0, *ZERO_TWIST))
    mailbox.collect(0.02)
    assert not mailbox.take()


def test_in_step_with_a_simulation_odometry_comes_at_50_hz_with_the_programs_own_time(
    server: WarmServer,
) -> None:
    hub, clock = MemoryHub(), VirtualClock()
    robot = SimRobot(PROFILE, EMPTY_WORLD, NO_FAULTS, wire=hub.connect(), clock=clock)
    mailbox = SensorMailbox()
    mailbox.attach(hub.connect(), PROFILE.wiring)
    stepped = SteppedProgram(program(server, LISTENER), mailbox)
    stamps = []
    for tick in range(51):
        events = stepped.poll_until(0.02 * tick)
        stamps += [int(event.text) for event in events if isinstance(event, Output)]
        robot.step(0.02)
    stepped.close()
    assert len(stamps) == pytest.approx(50, abs=1)
    assert {(after - before) % 10**9 for before, after in pairwise(stamps)} == {20_000_000}


def test_who_floods_the_pipe_while_its_time_stands_is_ended(server: WarmServer) -> None:
    stepped = SteppedProgram(program(server, FLOOD), SensorMailbox(), limit_s=0.5)
    began_s = time.monotonic()
    died = stepped.poll_until(0.0)[-1]
    assert time.monotonic() - began_s < 3.0
    assert isinstance(died, Died)
    assert died.reason.code == "program_too_busy"


def test_who_sleeps_beats_in_every_step_and_ends_in_its_own_time(server: WarmServer) -> None:
    stepped = SteppedProgram(program(server, "import time\ntime.sleep(0.5)"), SensorMailbox())
    assert [type(event) for event in stepped.poll_until(0.0)][-1] is Beat
    assert stepped.next_s == pytest.approx(0.5, abs=0.001)
    assert isinstance(stepped.poll_until(0.48)[-1], Beat)
    assert isinstance(stepped.poll_until(0.52)[-1], Ended)
