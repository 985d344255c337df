"""A plan and a program are governed alike: where the robot is by now, not where odometry saw it last."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.clock import VirtualClock
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.governed import StopEpoch
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor
from chatrobot.motion.goal import Goal
from chatrobot.motion.governed_robot import GovernedRobot, Stopwatch
from chatrobot.motion.plan_executor import GoalExecution
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.execution import ProgramExecution
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.programs.events import ProgramEvent, TwistAsked
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.sim.load import load_world
from chatrobot.transports.transport import WireTransport
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Odometry

PROFILE = load_profile(DEFAULT_PROFILE)
LATE_S, SPEED_MPS = 0.1, 0.5


class Watched(Governor):
    """Keeps where it was told that the robot is."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.poses: list[Pose | None] = []

    def govern(self, *arguments: Any, **named: Any) -> Any:
        self.poses.append(arguments[3])
        return super().govern(*arguments, **named)


class Drives:
    """A program that asks for the same velocity each time it is looked at."""

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        return [TwistAsked("cmd_vel", Twist(SPEED_MPS, 0.0, 0.0), now_s)]

    def close(self) -> None:
        pass


def goal(kind: type[Goal], lease: str) -> Goal:
    return kind(1, lease, "drive 5 m", False, False, 0, 0.0)


@pytest.mark.parametrize("kind", [Goal, ProgramGoal])
def test_the_governor_is_told_where_the_robot_is_by_now(kind: type[Goal]) -> None:
    clock, hub, epoch = VirtualClock(), MemoryHub(), StopEpoch()
    sensors, robot = Sensors(PROFILE, clock), hub.connect()
    sensors.attach(hub.connect())
    governor = Watched(PROFILE, epoch)
    transport = WireTransport(hub.connect(), PROFILE.wiring, epoch)
    for _ in range(20):
        clock.advance(0.02)
        at_s = clock.now_s()
        robot.publish(
            PROFILE.wiring.odom_topic, Odometry(at_s, SPEED_MPS * at_s, 0.0, 0.0, SPEED_MPS, 0.0, 0.0)
        )
    seen = sensors.estimate
    assert seen is not None
    clock.advance(LATE_S)
    now_s = clock.now_s()
    governor.leases.open("us", "console", 10.0, now_s)
    governed = GovernedRobot(PROFILE, sensors, governor, transport)
    assert governed.begin("us", now_s) is None
    asked = goal(kind, "us")
    asked.start = seen.pose
    run: GoalExecution | ProgramExecution
    if isinstance(asked, ProgramGoal):
        run = ProgramExecution(asked, Drives(), governed, lambda _: None, now_s)
    else:
        asked.take(Planner(PROFILE, load_world("empty")).plan(1, "drive 5 m", seen.pose))
        run = GoalExecution(asked, governed, lambda _: None, now_s)
    run.tick(now_s)
    assert governor.poses == [sensors.pose_now()]
    assert governor.poses[0] is not None
    assert governor.poses[0].x_m == pytest.approx(seen.pose.x_m + seen.twist.vx_mps * LATE_S, abs=0.005)


@given(st.lists(st.tuples(st.booleans(), st.floats(-0.1, 0.1)), max_size=30))
def test_no_time_in_motion_or_pause_is_negative_whatever_tick_counts_it(
    ticks: list[tuple[bool, float]],
) -> None:
    watch, now_s = Stopwatch(100.0), 100.0
    for is_standing, later_s in ticks:
        now_s += later_s
        watch.count(is_standing, now_s)
        assert (math.copysign(1.0, watch.paused_s), math.copysign(1.0, watch.moving_s)) == (1.0, 1.0)
    assert watch.paused_s + watch.moving_s <= max(watch.counted_to_s - 100.0, 0.0) + 1e-9


def test_what_is_counted_from_a_moment_after_the_tick_began_is_no_pause() -> None:
    watch = Stopwatch(10.000167)
    for is_standing, now_s in ((False, 10.0), (True, 10.0), (False, 10.02)):
        watch.count(is_standing, now_s)
    assert watch.paused_s == 0.0
