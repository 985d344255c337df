"""A program that runs for real, in real time: it speaks at once, beats, hears its robot, and can be ended."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from textwrap import dedent

import pytest

from chatrobot.programs.events import (
    Beat,
    Died,
    Ended,
    Listens,
    Log,
    Output,
    ProgramEvent,
    Raised,
    TwistAsked,
)
from chatrobot.programs.pipe import ProgramSettings, robot_topics
from chatrobot.programs.sandboxed import SandboxedProgram
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer

pytestmark = pytest.mark.realtime
TOPICS = robot_topics(load_profile("wheeltec_mini_mec").wiring)
PATIENCE_S = 10.0


def launch(server: WarmServer, source: str) -> SandboxedProgram:
    program = SandboxedProgram(server, ProgramSettings(dedent(source), mode="live", topics=TOPICS))
    program.start()
    return program


def until(program: SandboxedProgram, is_it: Callable[[ProgramEvent], bool]) -> list[ProgramEvent]:
    """All events up to the first that `is_it`."""
    events: list[ProgramEvent] = []
    ends_s = time.monotonic() + PATIENCE_S
    while time.monotonic() < ends_s:
        for event in program.poll(0.05):
            events.append(event)
            if is_it(event):
                return events
        assert program.end is None, program.end
    raise AssertionError(f"it never came: {events}")


DRIVER = """
    import rclpy, time
    from geometry_msgs.msg import Twist
    from nav_msgs.msg import Odometry
    rclpy.init()
    node = rclpy.create_node("live")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    def on_odom(message):
        twist = Twist()
        twist.linear.x = message.pose.pose.position.x
        pub.publish(twist)
        node.get_logger().info("heard")
    node.create_subscription(Odometry, "odom", on_odom, 10)
    rclpy.spin(node)
"""


@pytest.mark.alone
def test_it_answers_its_robot_and_beats(server: WarmServer) -> None:
    program = launch(server, DRIVER)
    try:
        until(program, lambda event: isinstance(event, Listens))
        program.tell("odom", [0.5, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0])
        events = until(program, lambda event: isinstance(event, Log))
        asked = [event.twist.vx_mps for event in events if isinstance(event, TwistAsked)]
        assert asked == [0.25]
        beats = [time.monotonic() for _ in range(6) if until(program, lambda event: isinstance(event, Beat))]
        assert 0.3 < beats[-1] - beats[0] < 1.0
    finally:
        program.close()


def test_what_it_prints_and_how_it_ends_is_told(server: WarmServer) -> None:
    program = launch(
        server, "import sys, threading\nprint('hello')\nthreading.Thread(target=lambda: sys.exit(1)).start()"
    )
    events = until(program, lambda event: isinstance(event, Ended))
    assert [event.text for event in events if isinstance(event, Output)] == ["hello"]
    assert events[-1][1:] == ("returned", 0)
    program.close()


def test_an_exception_of_a_thread_is_printed_with_the_programs_own_lines(server: WarmServer) -> None:
    program = launch(
        server,
        "import threading\ndef work():\n    raise ValueError('no')\nthreading.Thread(target=work).start()",
    )
    events = until(program, lambda event: isinstance(event, Ended))
    text = "\n".join(event.text for event in events if isinstance(event, Output))
    assert "ValueError: no" in text
    assert "raise ValueError" in text
    assert "chatrobot" not in text
    report = program.exit_report()
    assert report is not None
    assert not report.findings
    program.close()


@pytest.mark.alone
def test_a_frozen_program_beats_no_more(server: WarmServer) -> None:
    program = launch(server, "import time\ntime.sleep(60)")
    until(program, lambda event: isinstance(event, Beat))
    assert program._process is not None
    os.kill(program._process.pid, signal.SIGSTOP)
    time.sleep(0.1)
    program.poll()
    time.sleep(0.3)
    assert program.poll() == []
    program.close()


@pytest.mark.alone
def test_a_program_that_computes_without_end_still_beats(server: WarmServer) -> None:
    program = launch(server, "while True:\n    pass")
    for _ in range(4):
        until(program, lambda event: isinstance(event, Beat))
    program.kill()
    with pytest.raises(AssertionError):
        until(program, lambda event: isinstance(event, Ended))
    assert isinstance(program.end, Died)
    assert program.end.reason.code == "box_killed"
    program.close()


def test_asyncio_and_coroutines_work_in_real_time_too(server: WarmServer) -> None:
    source = """
        import asyncio, time
        async def main():
            began = time.monotonic()
            await asyncio.gather(asyncio.sleep(0.2), asyncio.to_thread(time.sleep, 0.1))
            print(0.2 <= time.monotonic() - began < 2.0)
        asyncio.run(main())
    """
    program = launch(server, source)
    events = until(program, lambda event: isinstance(event, (Ended, Raised)))
    assert [event.text for event in events if isinstance(event, Output)] == ["True"]
    program.close()
