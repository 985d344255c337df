"""Clocks that step, a machine that sleeps: no robot drives on by what is no longer true."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from pathlib import Path

import pytest

import chatrobot
from chatrobot.core.clock import RealClock, VirtualClock, awake_or_not_s
from chatrobot.core.events import Finished
from chatrobot.execution.sensors import OLD_NEWS_S, Sensors
from chatrobot.link.in_process import InProcessLink
from chatrobot.plan.steps import Drive, Plan
from chatrobot.robots.load import load_profile
from chatrobot.sim.shapes import rectangle
from chatrobot.testing.rig import Rig
from chatrobot.wire.memory import MemoryHub
from chatrobot.wire.messages import Imu, LaserScan, Message, Odometry
from chatrobot.wire.stamps import StampTranslator
from chatrobot.wire.wire import M, Wire
from tests.link.link_rigs import SimulatedRig, finished, moving, send_plan

SOURCE = Path(chatrobot.__file__).parent
WALL_CLOCKS = {"time", "time_ns", "now", "today", "utcnow", "localtime", "ctime"}
MAY_READ_THE_WALL_CLOCK = {"wire/stamps.py"}
"""ROS headers carry wall time; what comes in is translated as an age, and nothing waits by it."""
HOLDS_OR_MOVES = (
    "core",
    "execution",
    "governor",
    "guard",
    "nodes",
    "plan",
    "dialogue",
    "link",
    "motion",
    "sim",
    "transports",
    "wire",
)


# --- the wall clock steps ---


def test_nothing_that_moves_or_stops_a_robot_reads_the_wall_clock() -> None:
    found = set()
    for package in HOLDS_OR_MOVES:
        for path in (SOURCE / package).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                    reads = node.value.id in ("time", "datetime", "date") and node.attr in WALL_CLOCKS
                    if reads:
                        found.add(path.relative_to(SOURCE).as_posix())
    assert found == MAY_READ_THE_WALL_CLOCK


class SteppingWire(Wire):
    """A wire to a robot whose stamps are of a wall clock that somebody sets: what Cyclone and rosbridge deliver."""

    def __init__(self, wire: Wire, now_s: Callable[[], float]) -> None:
        self._wire = wire
        self._now_s = now_s
        self.wall_ahead_s = 1_700_000_000.0
        self._translators: dict[str, StampTranslator] = {}

    def publish(self, topic: str, message: Message) -> None:
        self._wire.publish(topic, message)

    def subscribe(self, topic: str, kind: type[M], callback: Callable[[M], None]) -> None:
        def translated(message: M) -> None:
            if isinstance(message, (Odometry, Imu, LaserScan)):
                clock = self._translators.setdefault(topic, StampTranslator())
                local_s = clock.local_s(message.stamp_s + self.wall_ahead_s, self._now_s())
                message = message._replace(stamp_s=local_s)
            callback(message)

        self._wire.subscribe(topic, kind, translated)

    def close(self) -> None:
        self._wire.close()


class SteppingRig(Rig):
    """The rig on such a wire."""

    def wired(self, wire: Wire) -> Wire:
        self.stepping = SteppingWire(wire, self.clock.now_s)
        return self.stepping


STEPS_S = [0.3, 2.0, 3600.0, -0.2, -0.4, -2.0, -20.0, -3600.0]


@pytest.mark.parametrize("step_s", STEPS_S)
def test_a_robot_whose_clock_is_set_while_it_drives_arrives_or_stops(step_s: float) -> None:
    rig = SteppingRig()

    def step(t_s: float) -> None:
        if t_s == pytest.approx(1.0, abs=0.011):
            rig.stepping.wall_ahead_s += step_s

    executor = rig.run(Plan((Drive(distance_m=1.0, speed_mps=0.5),)), step)
    assert executor.outcome in ("completed", "failed")
    assert rig.robot.true_pose.x_m <= 1.02
    if executor.outcome == "completed":
        assert rig.robot.true_pose.x_m == pytest.approx(1.0, abs=0.02)
    else:
        assert executor.reason is not None
        assert executor.reason.code in (
            "odometry_silent",
            "does_not_follow",
            "does_not_move",
            "odometry_jumped",
        )


@pytest.mark.parametrize("step_s", STEPS_S)
def test_a_wall_is_not_touched_though_the_clock_is_set_just_before_it(step_s: float) -> None:
    rig = SteppingRig()
    rig.robot.add_obstacle("wall", rectangle(2.1, 0.0, 0.2, 4.0))
    rig.live(0.3)

    def step(t_s: float) -> None:
        if t_s == pytest.approx(1.3, abs=0.011):
            rig.stepping.wall_ahead_s += step_s

    rig.run(Plan((Drive(distance_m=5.0, speed_mps=1.0),)), step)
    assert not rig.robot.in_contact


def test_fresh_mail_with_old_news_is_no_news() -> None:
    clock, hub = VirtualClock(100.0), MemoryHub()
    sensors, wire = Sensors(load_profile("wheeltec_mini_mec"), clock), hub.connect()
    sensors.attach(hub.connect())
    assert sensors.pose_now() is None
    assert set(sensors.ages_s().values()) == {math.inf}
    for made_s, age_s in ((100.0, 0.0), (100.0 - OLD_NEWS_S, 0.0), (99.4, 0.6), (90.0, 10.0)):
        again = Sensors(load_profile("wheeltec_mini_mec"), clock)
        again.attach(hub.connect())
        wire.publish("odom", Odometry(made_s, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0))
        wire.publish("scan", LaserScan(made_s, 0.0, 0.1, 0.1, 8.0, [1.0]))
        assert again.ages_s()["odom"] == pytest.approx(age_s)
        assert again.ages_s()["scan"] == pytest.approx(age_s)
        pose = again.pose_now()
        assert pose is not None
        assert pose.x_m == pytest.approx(0.5 * min(100.0 - made_s, OLD_NEWS_S))


# --- the machine sleeps ---


def suspend(rig: SimulatedRig, duration_s: float) -> None:
    assert isinstance(rig.link, InProcessLink)
    rig.link._clock.suspend(duration_s)


def test_a_machine_that_slept_does_not_drive_on(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    send_plan(rig, 1, "drive 5 m")
    send_plan(rig, 2, "drive 1 m")
    moving(rig, 1)
    suspend(rig, 3600.0)
    ends: list[Finished] = [finished(rig, 1), finished(rig, 2)]
    assert [end.outcome for end in ends] == ["failed", "stopped"]
    assert ends[0].reason is not None
    assert (ends[0].reason.code, ends[0].reason.values) == ("motion_froze", {"gap_s": 3600.02})
    assert not any(rig.velocities[-1])
    rig.link.next_event(2.0)
    send_plan(rig, 3, "drive 0.1 m")
    assert finished(rig, 3).outcome == "completed"


def test_a_yes_that_slept_counts_no_more(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    send_plan(rig, 1, "drive 0.5 m", approve=True)
    rig.link.next_event(0.2)
    suspend(rig, 60.0)
    rig.link.next_event(0.04)
    rig.link.send("approve", 1, yes=True)
    rig.link.next_event(1.0)
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_nap_too_short_to_matter_ends_nothing(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    send_plan(rig, 1, "drive 0.3 m")
    moving(rig, 1)
    suspend(rig, 0.05)
    assert finished(rig, 1).outcome == "completed"


def test_time_asleep_is_what_the_boot_clock_has_beyond_the_monotonic(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = RealClock()
    slept_s = clock.suspended_s()
    assert slept_s >= -1e-3
    monkeypatch.setattr("chatrobot.core.clock.awake_or_not_s", lambda: awake_or_not_s() + 90.0)
    assert clock.suspended_s() - slept_s == pytest.approx(90.0, abs=0.1)
