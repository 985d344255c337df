"""A heartbeat that a busy machine keeps back slows the robot, to zero in time; only much later all is over."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from tests.link.link_rigs import SimulatedRig, events_until

from chatrobot.core import process
from chatrobot.core.clock import LOCAL_TERM_S, TERM_S
from chatrobot.core.events import Event, Finished, Limited
from chatrobot.core.process import own_identity, watch_process
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import describe_end
from chatrobot.governor.lease import LONGEST_S, OVER_S
from chatrobot.link.in_process import InProcessLink
from chatrobot.motion.safety import watchdog

TICK_S = 0.02
LATE_S, ZERO_S = 0.13, 0.18


class Robot:
    """A simulated robot that drives, and a source whose heartbeat the test holds back."""

    def __init__(self, folder: Path) -> None:
        self.rig = SimulatedRig(folder)
        link = self.rig.link
        assert isinstance(link, InProcessLink)
        self.link, self.motion, self.clock = link, link._motion, link._clock
        self.events: list[Event] = []

    def drive(
        self, text: str = "drive 2 m at 0.5 m/s", of: str | None = None, term_s: float = LOCAL_TERM_S
    ) -> None:
        """Begin, and come up to speed; `of`: the identity of the process that beats."""
        self.link.send("hello", term_s=term_s, process=own_identity() if of is None else of)
        self.link.send("plan", 1, plan_text=text, mode="queue")
        self.live(1.0)
        assert self.speed_mps > 0.45

    @property
    def speed_mps(self) -> float:
        return self.rig.velocities[-1].vx_mps

    def live(self, duration_s: float, tick_s: float = TICK_S) -> list[float]:
        """Let time pass in ticks that are `tick_s` apart; the speed after each."""
        speeds = []
        for _ in range(round(duration_s / tick_s)):
            for _ in range(round(tick_s / TICK_S) - 1):
                self.clock.advance(TICK_S)
                self.link._advance(TICK_S)
            self.link.step()
            speeds.append(self.speed_mps)
        while self.link.events:
            self.events.append(self.link.events.popleft())
        return speeds

    def silence(self, duration_s: float, tick_s: float = TICK_S) -> list[float]:
        """No beat comes for so long; the speed after each tick of it."""
        self.link.beats = False
        speeds = self.live(duration_s, tick_s)
        self.link.beats = True
        return speeds

    @property
    def end(self) -> Finished | None:
        return next((event for event in self.events if isinstance(event, Finished)), None)


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    return Robot(tmp_path)


@pytest.fixture(autouse=True)
def busy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watchdog, "is_machine_busy", lambda: True)


@pytest.fixture
def other() -> Iterator[psutil.Process]:
    """A process of somebody else's."""
    with subprocess.Popen(["sleep", "60"]) as child:
        yield psutil.Process(child.pid)
        child.kill()


def stop(other: psutil.Process) -> None:
    """Stop it, and see that it has stopped."""
    other.suspend()
    while other.status() != psutil.STATUS_STOPPED:
        os.sched_yield()


def identity_of(other: psutil.Process) -> str:
    return f"{process._machine()} {other.pid} {process._stat(other.pid)[1]}"


def test_it_goes_slower_from_130_ms_and_stands_from_180_ms_on(robot: Robot) -> None:
    robot.drive()
    speeds = robot.silence(0.4)
    ages = [TICK_S * (1 + tick) for tick in range(len(speeds))]  # the last beat came with the tick before
    by_age = dict(zip((round(age, 2) for age in ages), speeds))
    assert by_age[0.12] > 0.48
    assert by_age[0.12] > by_age[0.14] > by_age[0.16] > 0.0
    assert all(speed == 0.0 for age, speed in by_age.items() if age >= ZERO_S)
    assert robot.end is None


def test_a_beat_in_time_lets_the_same_motion_go_on_to_its_end(robot: Robot) -> None:
    robot.drive()
    robot.silence(0.36)
    assert robot.speed_mps == 0.0
    assert robot.live(1.0)[-1] > 0.45, "it ramps up again"
    robot.live(6.0)
    assert robot.end is not None
    assert (robot.end.outcome, robot.end.reason) == ("completed", None)
    assert robot.end.path_m == pytest.approx(2.0, abs=0.02)
    assert robot.end.late_s == pytest.approx(0.36, abs=0.021)
    assert "0.36 s" in describe_end(robot.end, "en")
    assert "太忙" in describe_end(robot.end, "zh")
    told = [
        event.reason for event in robot.events if isinstance(event, Limited) and event.rule == "late_beat"
    ]
    assert [why.code for why in told if why is not None] == ["beat_late"], "once"


def test_a_timed_line_that_was_held_up_lasts_longer_and_does_not_reverse(robot: Robot) -> None:
    robot.drive("twist 0.5 0 0 for 2 s")
    before = len(robot.rig.velocities)
    robot.silence(0.36)
    robot.live(5.0)
    assert robot.end is not None
    assert robot.end.outcome == "completed"
    assert robot.end.path_m == pytest.approx(1.0, abs=0.05)
    assert min(velocity.vx_mps for velocity in robot.rig.velocities[before:]) >= 0.0


def test_a_beat_that_is_in_time_changes_nothing(robot: Robot) -> None:
    robot.drive()
    for _ in range(5):
        assert min(robot.silence(0.12)) > 0.48
        robot.live(0.04)
    robot.live(6.0)
    assert robot.end is not None
    assert robot.end.late_s == 0.0
    assert not any(isinstance(event, Limited) for event in robot.events)


def test_after_450_ms_it_is_over_and_the_reply_says_how_late_the_beat_was(robot: Robot) -> None:
    robot.drive()
    robot.silence(OVER_S + 0.04)
    assert robot.end is None or robot.end.outcome == "failed"
    assert set(robot.live(3.0)) == {0.0}, "nothing resumes without a new order"
    assert robot.end is not None
    assert robot.end.outcome == "failed"
    assert robot.end.reason is not None
    assert robot.end.reason.code == "beat_late"
    assert robot.end.reason.values["late_s"] == pytest.approx(OVER_S, abs=0.03)
    assert "too busy" in describe_end(robot.end, "en")
    assert "太忙" in describe_end(robot.end, "zh")
    robot.link.send("plan", 2, plan_text="drive 0.1 m", mode="queue")
    assert max(robot.live(1.0)) > 0.1, "a new order is done"


def test_on_a_machine_that_is_not_busy_silence_is_called_silence(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watchdog, "is_machine_busy", lambda: False)
    robot.drive()
    robot.silence(0.6)
    robot.live(1.0)
    assert robot.end is not None
    assert robot.end.reason == Reason("lease_lapsed", {"source": "console"})


def test_where_motions_own_ticks_were_late_too_it_waits_up_to_a_second(robot: Robot) -> None:
    robot.drive("drive 5 m at 0.5 m/s")
    robot.silence(0.8, tick_s=0.1)
    assert robot.speed_mps == 0.0
    assert robot.live(1.0)[-1] > 0.45
    robot.silence(LONGEST_S + 0.2, tick_s=0.1)
    assert set(robot.live(2.0)) == {0.0}
    assert robot.end is not None
    assert robot.end.reason is not None
    assert robot.end.reason.code == "beat_late"
    assert robot.end.reason.values["late_s"] <= LONGEST_S + 0.1


def test_a_source_that_is_stopped_is_over_at_once_and_its_thaw_resumes_nothing(
    robot: Robot, other: psutil.Process
) -> None:
    robot.drive(of=identity_of(other))
    stop(other)
    robot.silence(0.16)
    other.resume()
    assert robot.speed_mps == 0.0
    assert set(robot.live(3.0)) == {0.0}
    assert robot.end is not None
    assert (robot.end.outcome, robot.end.reason) == ("stopped", Reason("lease_lapsed", {"source": "console"}))


def test_a_source_that_is_gone_is_over_at_once(robot: Robot, other: psutil.Process) -> None:
    robot.drive(of=identity_of(other))
    other.kill()
    other.wait(5.0)
    robot.silence(0.16)
    assert robot.end is not None or robot.speed_mps == 0.0
    assert set(robot.live(3.0)) == {0.0}
    assert robot.end is not None


@pytest.mark.parametrize("of", ["", "another-machine pid:[1] 1 1", "nonsense"])
def test_who_cannot_be_seen_from_here_has_no_such_time(robot: Robot, of: str) -> None:
    robot.drive(of=of, term_s=TERM_S)
    assert min(robot.silence(0.28)) > 0.45, "a network is late now and then"
    robot.live(0.2)
    robot.silence(TERM_S + 0.04)
    assert set(robot.live(2.0)) == {0.0}
    assert robot.end is not None
    assert robot.end.reason == Reason("lease_lapsed", {"source": "console"})


def test_a_beat_tells_how_long_ago_somebody_else_was_heard(robot: Robot) -> None:
    robot.drive()
    for count in range(14):
        robot.link.beats = False
        robot.link.send("beat", age_s=0.1 + count * TICK_S)
        robot.live(TICK_S)
    assert robot.speed_mps == 0.0
    assert robot.end is None
    robot.link.beats = True
    assert robot.live(1.0)[-1] > 0.45


def test_a_motion_that_was_stopped_by_a_signal_does_not_drive_on_however_short_it_was(robot: Robot) -> None:
    robot.drive()
    robot.clock.advance(0.06)
    robot.motion.thaw()
    assert set(robot.live(3.0)) == {0.0}
    assert robot.end is not None
    assert robot.end.outcome == "failed"
    assert robot.end.reason is not None
    assert robot.end.reason.code == "motion_froze"


def test_a_motion_that_was_stopped_while_nothing_moved_is_no_news(robot: Robot) -> None:
    robot.motion.thaw()
    robot.link.send("plan", 1, plan_text="drive 0.2 m", mode="queue")
    end = events_until(robot.rig, lambda event: isinstance(event, Finished))[-1]
    assert isinstance(end, Finished)
    assert end.outcome == "completed"


def test_a_motion_that_the_machine_kept_from_running_says_so(robot: Robot) -> None:
    robot.drive()
    robot.live(0.4, tick_s=0.2)
    robot.live(1.0)
    assert robot.end is not None
    assert robot.end.outcome == "failed"
    assert robot.end.reason == Reason("motion_late", {"late_s": 0.2})
    assert "too busy" in describe_end(robot.end, "en")
    assert "太忙" in describe_end(robot.end, "zh")


# --- who is stopped ---


def test_a_process_is_seen_running_stopped_and_gone(other: psutil.Process) -> None:
    is_stopped = watch_process(identity_of(other))
    assert is_stopped is not None
    assert not is_stopped()
    stop(other)
    assert is_stopped()
    other.resume()
    while other.status() == psutil.STATUS_STOPPED:
        os.sched_yield()
    assert not is_stopped()
    other.kill()
    other.wait(5.0)
    assert is_stopped()


def test_our_own_identity_is_known_and_what_is_none_is_not() -> None:
    is_stopped = watch_process(own_identity())
    assert is_stopped is not None
    assert not is_stopped()
    machine, pid, started = own_identity().rsplit(" ", 2)
    for wrong in (
        "",
        " ",
        "1 1",
        f"elsewhere {pid} {started}",
        f"{machine} {pid} 1",
        f"{machine} x {started}",
    ):
        assert watch_process(wrong) is None
