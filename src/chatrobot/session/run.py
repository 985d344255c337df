"""One plan under way: executor, governor and transport at 50 Hz, and the measured end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from chatrobot.core.events import Event, Finished, Limited, Outcome, Progress
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor, Verdict
from chatrobot.governor.rule import Sensed
from chatrobot.robots.profile import RobotProfile
from chatrobot.session.job import Job
from chatrobot.transports.transport import Transport

WORTH_TELLING_MPS = 0.02
WORTH_TELLING_RADPS = 0.05
"""What feedback asks a little too much is trimmed without a word."""


@dataclass
class Stopwatch:
    """Time in motion, and time standing between two motions: the last pause counts once motion follows."""

    counted_to_s: float
    moving_s: float = 0.0
    paused_s: float = 0.0
    _pending_s: float = 0.0
    _has_moved: bool = False

    def count(self, standing: bool, now_s: float) -> None:
        elapsed_s, self.counted_to_s = now_s - self.counted_to_s, now_s
        if not standing:
            self._has_moved = True
            self.moving_s += elapsed_s
            self.paused_s += self._pending_s
            self._pending_s = 0.0
        elif self._has_moved:
            self._pending_s += elapsed_s


def sensed_by(sensors: Sensors) -> Sensed:
    """What the governor's rules want to know of the sensors."""
    return Sensed(sensors.ages_s(), sensors.battery_percent)


def is_worth_telling(verdict: Verdict) -> bool:
    """More than a trifle of what was asked is not allowed."""
    lost = abs(verdict.asked.speed_mps - verdict.allowed.speed_mps)
    lost_turn = abs(verdict.asked.wz_radps - verdict.allowed.wz_radps)
    return lost >= WORTH_TELLING_MPS or lost_turn >= WORTH_TELLING_RADPS


class Run:
    """Drives the plan of `job`, which has been rehearsed. `tick` until `executor.is_done`, or until it is stopped."""

    def __init__(
        self,
        job: Job,
        profile: RobotProfile,
        sensors: Sensors,
        governor: Governor,
        transport: Transport,
        emit: Callable[[Event], None],
        now_s: float,
    ) -> None:
        assert job.planned is not None
        self.job = job
        self._sensors = sensors
        self._governor = governor
        self._transport = transport
        self._emit = emit
        self._stopwatch = Stopwatch(now_s)
        self._start_path_m = sensors.estimate.path_m if sensors.estimate is not None else 0.0
        self._told: set[tuple[int, str]] = set()
        self.executor = Executor(profile, sensors, emit)
        self.executor.start(job.turn, job.walk(), job.planned.duration_s, now_s)

    def tick(self, now_s: float) -> None:
        """One period: what the executor asks, as far as the governor allows it."""
        asked = self.executor.tick(now_s)
        if self.executor.is_done:
            return
        pose, sensed = self._sensors.pose_now(), sensed_by(self._sensors)
        verdict = self._governor.govern(asked, self.job.lease, now_s, pose, sensed)
        self._transport.send(verdict.sent)
        self.executor.note(verdict.rule, verdict.reason, verdict.sent.twist, now_s)
        self._stopwatch.count(verdict.sent.twist.is_zero, now_s)
        self._tell(verdict)

    @property
    def is_done(self) -> bool:
        return self.executor.is_done

    @property
    def outcome(self) -> Outcome:
        return self.executor.outcome

    @property
    def reason(self) -> Reason | None:
        return self.executor.reason

    def ramp_down(self, why: Reason) -> None:
        """A controlled stop."""
        self.executor.ramp_down(why)

    def close(self) -> None:
        """Nothing is left behind."""

    def progress(self, now_s: float) -> Progress:
        return self.executor.progress(self.job.turn, now_s)

    def finished(self, outcome: Outcome, reason: Reason | None) -> Finished:
        """The end, as odometry measured it."""
        start, estimate = self.job.start, self._sensors.estimate
        pose = estimate.pose if estimate is not None else start
        return Finished(
            self.job.turn,
            outcome,
            reason,
            start=start,
            pose=pose,
            turned_rad=pose.yaw_rad - start.yaw_rad,
            path_m=(estimate.path_m - self._start_path_m) if estimate is not None else 0.0,
            duration_s=self._stopwatch.moving_s,
            paused_s=self._stopwatch.paused_s,
            planned_m=self.executor.planned_m,
            planned_turn_rad=self.executor.planned_turn_rad,
            steps_done=self.executor.steps_done,
            steps=self.executor.steps,
            measured=self._sensors.has_odometry,
        )

    def _tell(self, verdict: Verdict) -> None:
        """Say once a step and rule that something was limited; ramps are no news."""
        if not is_worth_telling(verdict):
            return
        key = (self.executor.step, verdict.rule)
        if verdict.action == "limited" and verdict.rule != "acceleration" and key not in self._told:
            self._told.add(key)
            self._emit(Limited(self.job.turn, verdict.rule, verdict.asked, verdict.allowed, verdict.reason))
