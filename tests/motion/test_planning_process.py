"""Rehearsals of a class in a process beside Motion: the same answers, and nobody waits for anybody else's."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from chatrobot.core.geometry import Pose
from chatrobot.link.envelope import Envelope
from chatrobot.motion.planner import Planner
from chatrobot.motion.planning_process import NICENESS, PlanningProcess, RemotePlanner, RemoteProgramHost
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.programs.sandboxed import warm_server
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

PROFILE, HOME = load_profile("wheeltec_mini_mec"), load_world("home")
SQUARE = "repeat 4\n  drive 0.3 m\n  turn left 90 deg\nend"
BUSY = "import time\nends = time.monotonic() + 1e9\nwhile True:\n    pass\n"
HONEST = """\
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node('forward')
publisher = node.create_publisher(Twist, 'cmd_vel', 10)
twist = Twist()
twist.linear.x = 0.1
publisher.publish(twist)
node.get_clock().sleep_for(rclpy.duration.Duration(seconds=1))
publisher.publish(Twist())
"""


@pytest.fixture(scope="module")
def process() -> Iterator[PlanningProcess]:
    made = PlanningProcess(PROFILE, HOME, 3)
    yield made
    made.close()


def program(code: str) -> ProgramGoal:
    return ProgramGoal.of(Envelope("program", "pupil", "lease", 1, 7, {"code": code}), 0, 0.0)


def host(planner: RemotePlanner) -> RemoteProgramHost:
    return RemoteProgramHost(PROFILE, planner, warm_server())


@pytest.mark.parametrize("text", [SQUARE, "go to kitchen", "drive 50 m", "no plan at all"])
def test_it_answers_as_a_planner_here_would(process: PlanningProcess, text: str) -> None:
    here = Planner(PROFILE, HOME).plan(3, text, Pose(0.1, 0.0, 0.2))
    there = process.planners[0].plan(3, text, Pose(0.1, 0.0, 0.2))
    assert there.events(False) == here.events(False)
    assert there.refusal == here.refusal
    assert there.possible == here.possible


def test_a_program_is_rehearsed_there(process: PlanningProcess) -> None:
    planned = host(process.planners[0]).rehearse(program(HONEST), process.planners[0], None)
    assert planned.ok
    assert planned.length_m == pytest.approx(0.1, abs=0.02)


def test_nobody_waits_for_the_rehearsal_of_another(process: PlanningProcess) -> None:
    ended: list[float] = []

    def rehearse() -> None:
        planned = host(process.planners[1]).rehearse(program(BUSY), process.planners[1], None)
        assert not planned.ok
        ended.append(time.monotonic())

    busy = threading.Thread(target=rehearse)
    busy.start()
    time.sleep(0.3)  # the program computes by now
    assert process.planners[2].plan(1, SQUARE, Pose()).ok
    assert not ended, "it waited for the other"
    process.kill()  # what never ends need not run until its time is over
    busy.join()


@pytest.mark.usefixtures("process")
def test_it_goes_after_all_that_drives() -> None:
    (found,) = [
        child.pid
        for child in psutil.Process().children()
        if "chatrobot.motion.planning_process" in child.cmdline()
    ]
    niceness = max(NICENESS, os.getpriority(os.PRIO_PROCESS, 0))
    ends_s = time.monotonic() + 10.0
    while os.getpriority(os.PRIO_PROCESS, found) != niceness:  # it ranks itself, as soon as it runs
        assert time.monotonic() < ends_s
        time.sleep(0.01)
    ranked = Path(f"/proc/{found}/autogroup")
    assert not ranked.exists() or ranked.read_text().endswith(f"nice {niceness}\n")


def test_where_it_was_killed_the_next_plan_is_rehearsed(process: PlanningProcess) -> None:
    process.kill()
    gone = process.planners[0].plan(1, SQUARE, Pose()).refusal
    assert gone is not None
    assert gone.code == "rehearsal_gone"
    assert all(planner.plan(1, SQUARE, Pose()).ok for planner in process.planners)
