"""What a busy machine does to a motion: stalls that add up, an end that cannot be made good, a guard that is late."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from tests.motion import far_robot
from tests.motion.test_late_beats import Robot

from chatrobot.core.clock import VirtualClock
from chatrobot.guard.watch import ECHO_LATE_S, ECHO_LOST_S
from chatrobot.link.in_process import InProcessLink
from chatrobot.motion.safety import watchdog
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.wire.messages import Message, TwistMessage

AT_MOST_M = 0.01
"""Beyond its end; it brakes within this from a crawl."""


def farthest_m(robot: Robot, stalls: int) -> float:
    """How far it is driven by a plan of 1 m while its source is heard late so many times."""
    robot.drive("drive 1 m at 0.5 m/s")
    reached_m = []
    for _ in range(stalls):
        for act in (lambda: robot.silence(0.24), lambda: robot.live(0.3)):
            act()
            reached_m.append(robot.rig.robot.true_pose.x_m)
    for _ in range(400):
        robot.live(0.02)
        reached_m.append(robot.rig.robot.true_pose.x_m)
    return max(reached_m)


def test_late_beats_do_not_add_up_to_an_overrun(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watchdog, "is_machine_busy", lambda: True)
    robot = Robot(tmp_path)
    assert farthest_m(robot, 5) < 1.0 + AT_MOST_M
    assert robot.end is not None
    assert robot.end.outcome == "completed"
    assert robot.rig.robot.true_pose.x_m == pytest.approx(1.0, abs=AT_MOST_M)


def test_odometry_in_bursts_does_not_add_up_to_an_overrun() -> None:
    rig = far_robot.Rig()
    reached_m: list[float] = []
    rig.each_step = lambda: reached_m.append(rig.robot.true_pose.x_m)
    rig.begin("drive 1 m at 0.5 m/s")
    rig.pass_time(0.8)
    for _ in range(5):
        rig.network.holds_back = True
        rig.pass_time(0.3)
        rig.network.let_go()
        rig.pass_time(0.3)
    rig.pass_time(6.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.reason) == ("completed", None)
    assert max(reached_m) < 1.0 + AT_MOST_M


def test_a_plan_that_ends_too_far_off_is_not_completed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The base does not heed slow velocities: what is left at the end cannot be driven."""

    class Sluggish(far_robot.FarWire):
        def publish(self, topic: str, message: Message) -> None:
            if isinstance(message, TwistMessage) and abs(message.vx_mps) < 0.2:
                message = TwistMessage(0.0, 0.0, 0.0)
            super().publish(topic, message)

    monkeypatch.setattr(far_robot, "FarWire", Sluggish)
    rig = far_robot.Rig()
    end = rig.do("drive 0.3 m")
    assert 0.02 < abs(rig.robot.true_pose.x_m - 0.3) < 0.1
    assert (end.outcome, end.reason and end.reason.code) == ("failed", "not_arrived")
    assert rig.do("drive 1 m at 0.02 m/s", patience_s=60.0).outcome == "failed"


class LateGuard(SimulatedGuard):
    """Is silent from when the test says so."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__(clock)
        self._now_s: Callable[[], float] = clock.now_s
        self.heard_s: float | None = None

    def silent_s(self) -> float:
        return 0.0 if self.heard_s is None else self._now_s() - self.heard_s


@pytest.fixture
def guarded(monkeypatch: pytest.MonkeyPatch) -> tuple[far_robot.Rig, LateGuard]:
    made: list[LateGuard] = []

    def make(clock: VirtualClock) -> LateGuard:
        made.append(LateGuard(clock))
        return made[-1]

    monkeypatch.setattr(far_robot, "SimulatedGuard", make)
    return far_robot.Rig(), made[0]


def test_a_plan_waits_for_a_guard_that_is_late_and_nothing_moves_meanwhile(
    guarded: tuple[far_robot.Rig, LateGuard],
) -> None:
    rig, guard = guarded
    guard.heard_s = rig.clock.now_s() - 2.0 * ECHO_LOST_S
    rig.begin("drive 0.3 m")
    rig.pass_time(ECHO_LATE_S - 2.0 * ECHO_LOST_S - 0.1)
    assert rig.end_of(1) is None
    assert not any(any(velocity) for velocity in rig.velocities)
    guard.heard_s = None
    rig.pass_time(3.0)
    end = rig.end_of(1)
    assert end is not None
    assert (end.outcome, end.path_m) == ("completed", pytest.approx(0.3, abs=AT_MOST_M))


@pytest.mark.parametrize("is_stopped", [False, True])
def test_a_plan_is_over_where_the_guard_stays_silent_or_somebody_says_stop(
    guarded: tuple[far_robot.Rig, LateGuard], is_stopped: bool
) -> None:
    rig, guard = guarded
    assert isinstance(rig.link, InProcessLink)
    guard.heard_s = rig.clock.now_s() - 2.0 * ECHO_LOST_S
    rig.begin("drive 0.3 m")
    rig.pass_time(0.5)
    if is_stopped:
        rig.link.send("stop")
    rig.pass_time(ECHO_LATE_S)
    guard.heard_s = None
    rig.pass_time(1.0)
    end = rig.end_of(1)
    assert end is not None
    assert end.reason is not None
    told = ("stopped", "stopped_by") if is_stopped else ("refused", "guard_lost")
    assert (end.outcome, end.reason.code) == told
    assert not any(any(velocity) for velocity in rig.velocities)
