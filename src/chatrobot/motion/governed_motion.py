"""What every motion of ours has in common: it is asked for, governed, sent, and in the end measured; and a plan's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from chatrobot.core.events import Event, Finished, Limited, Outcome, Progress
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.governor.governor import LATE_BEAT, Verdict
from chatrobot.motion.budgets import Meter
from chatrobot.motion.goal import Goal
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.split import split
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan
from chatrobot.robots.profile import Limits

WORTH_TELLING_MPS = 0.02
WORTH_TELLING_RADPS = 0.05
"""What feedback asks a little too much is trimmed without a word."""


@dataclass
class Stopwatch:
    """Counts time in motion, and time standing between two motions: the last pause counts once motion follows."""

    counted_to_s: float
    moving_s: float = 0.0
    paused_s: float = 0.0
    _pending_s: float = 0.0
    _has_moved: bool = False

    def count(self, standing: bool, now_s: float) -> None:
        """Count the time up to now as standing or moving."""
        elapsed_s = max(0.0, now_s - self.counted_to_s)
        self.counted_to_s += elapsed_s  # a tick that began before what it counts counts nothing twice
        if not standing:
            self._has_moved = True
            self.moving_s += elapsed_s
            self.paused_s += self._pending_s
            self._pending_s = 0.0
        elif self._has_moved:
            self._pending_s += elapsed_s


def is_cut_short(verdict: Verdict) -> bool:
    """Return whether more than a trifle of what was asked is not allowed."""
    lost_mps = abs(verdict.asked.speed_mps - verdict.allowed.speed_mps)
    lost_radps = abs(verdict.asked.wz_radps - verdict.allowed.wz_radps)
    return lost_mps >= WORTH_TELLING_MPS or lost_radps >= WORTH_TELLING_RADPS


def is_worth_telling(verdict: Verdict) -> bool:
    """Return whether it was cut short by a limit: ramps are no news."""
    return verdict.action == "limited" and verdict.rule != "acceleration" and is_cut_short(verdict)


class GovernedMotion:
    """Sends what `goal` asks for through the governor, and keeps how far and how long it went."""

    def __init__(self, goal: Goal, robot: GovernedRobot, now_s: float) -> None:
        self._goal = goal
        self._robot = robot
        self._sensors = sensors = robot.sensors
        self._stopwatch = Stopwatch(now_s)
        self._late_s = 0.0
        self._start_path_m = sensors.estimate.path_m if sensors.estimate is not None else 0.0
        is_endless = goal.planned is not None and goal.planned.is_endless
        limits = robot.profile.limits
        self._meter = Meter(
            goal.account, lambda: goal.stream.certain, sensors, limits, now_s, is_endless=is_endless
        )

    def send(self, asked: Twist, now_s: float) -> Verdict:
        """Send what the governor allows of `asked`."""
        verdict = self._robot.govern(asked, self._goal.lease, now_s)
        self._robot.send(verdict)
        if verdict.rule == LATE_BEAT and verdict.reason is not None and is_cut_short(verdict):
            self._late_s = max(self._late_s, float(verdict.reason.values["late_s"]))
        self._stopwatch.count(verdict.sent.twist.is_zero, now_s)
        self._meter.note(verdict.sent.twist, now_s)
        return verdict

    def over_budget(self) -> Reason | None:
        """Return, once, why it has to brake now so that its text stays within the motion budget."""
        return self._meter.over()

    def close(self) -> None:
        """Book what it has driven: it is over."""
        self._meter.close()

    def limited(self, verdict: Verdict) -> Limited:
        """Return what a person is told of a limit."""
        return Limited(self._goal.turn, verdict.rule, verdict.asked, verdict.allowed, verdict.reason)

    @property
    def path_m(self) -> float:
        """Return how far it has driven, as measured."""
        estimate = self._sensors.estimate
        return (estimate.path_m - self._start_path_m) if estimate is not None else 0.0

    def turned_rad(self) -> float:
        """Return how far it has turned since its start, as measured; radians, counter-clockwise positive."""
        estimate = self._sensors.estimate
        return estimate.pose.yaw_rad - self._goal.start.yaw_rad if estimate is not None else 0.0

    def finished(
        self,
        outcome: Outcome,
        reason: Reason | None,
        *,
        planned_m: float,
        planned_turn_rad: float,
        **about: Any,
    ) -> Finished:
        """Return the end, as odometry measured it; where there is none, what was planned is what was sent.

        Args:
            about: further fields of the event.
        """
        measured = self._sensors.has_odometry
        start, estimate = self._goal.start, self._sensors.estimate
        return Finished(
            self._goal.turn,
            outcome,
            reason,
            start=start,
            pose=estimate.pose if estimate is not None else start,
            turned_rad=self.turned_rad(),
            path_m=self.path_m,
            duration_s=self._stopwatch.moving_s or (0.0 if measured else self._meter.least_s),
            paused_s=self._stopwatch.paused_s,
            planned_m=planned_m if measured else self._meter.sent_m,
            planned_turn_rad=planned_turn_rad if measured else self._meter.sent_rad,
            measured=measured,
            late_s=self._late_s,
            **about,
        )


# The governor ramps up what a program asks and lets every zero through at once. A program that holds 0.5 rad/s for
# six seconds would then turn less than three radians: what the ramp took at its start is not given back at its end.
# So the zero of a program that is well is ramped, too. Stops, and the end of a program that broke, are still zeros
# at once.


def decelerated(asked: Twist, sent: Twist, limits: Limits, dt_s: float) -> Twist:
    """Return what to ask for where the program asks `asked` and `sent` was sent `dt_s` before."""
    if not asked.is_zero or sent.is_zero:
        return asked
    share = 1.0
    if sent.speed_mps > 0.0:
        share = min(share, limits.acceleration_mps2 * dt_s / sent.speed_mps)
    if sent.wz_radps:
        share = min(share, limits.angular_acceleration_radps2 * dt_s / abs(sent.wz_radps))
    return sent.scaled(1.0 - share) if share < 1.0 else ZERO_TWIST


class GoalExecution:
    """Drives the plan of `goal`, which has been rehearsed. `tick` until `is_done`, or until it is stopped."""

    def __init__(self, goal: Goal, robot: GovernedRobot, emit: Callable[[Event], None], now_s: float) -> None:
        assert goal.stream.walk is not None
        self.goal = goal
        self._emit = emit
        self._robot = robot
        self._motion = GovernedMotion(goal, robot, now_s)
        self._told: set[tuple[int, str]] = set()
        self._scaling = SpeedScaling()
        self._executor = Executor(robot.profile, robot.sensors, emit)
        self._executor.start(goal.turn, goal.stream.walk, goal.stream.duration_s, now_s)

    def tick(self, now_s: float) -> None:
        """Send what the executor asks for this period, as far as the governor allows it."""
        asked = self._executor.tick(now_s)
        if self._executor.is_done:
            return
        verdict = self._motion.send(asked, now_s)
        over = self._motion.over_budget()
        if over is not None:
            self.ramp_down(over)
        self._executor.note(verdict.rule, verdict.reason, verdict.sent.twist, now_s)
        self._tell(verdict)

    @property
    def is_done(self) -> bool:
        """True once the plan has ended."""
        return self._executor.is_done

    @property
    def outcome(self) -> Outcome:
        """Return how it ended."""
        return self._executor.outcome

    @property
    def reason(self) -> Reason | None:
        """Return why it ended so."""
        return self._executor.reason

    def expect(self, duration_s: float) -> None:
        """Expect so long a duration in all: the plan has become longer."""
        self._executor.expect(duration_s)

    def rescale(self, scaling: SpeedScaling, now_s: float) -> None:
        """Go on at another speed; what is left at a stop says so."""
        self._executor.rescale(scaling, now_s)
        self._scaling = self._scaling.times(scaling)

    def ramp_down(self, why: Reason) -> None:
        """Stop at the deceleration of the profile."""
        self._executor.ramp_down(why)

    def close(self) -> None:
        """Book what it has driven."""
        self._motion.close()

    def progress(self, now_s: float) -> Progress:
        """Return how far it is."""
        progress = self._executor.progress(self.goal.turn, now_s)
        return replace(progress, fraction=None) if self.goal.is_open_ended else progress

    def finished(self, outcome: Outcome, reason: Reason | None) -> Finished:
        """Return its end, as odometry measured it."""
        executed, remaining = self._parts()
        is_whole = outcome == "completed"  # conditions that came true may have made it shorter than rehearsed
        planned_m, planned_rad = self._executor.planned
        return self._motion.finished(
            outcome,
            reason,
            planned_m=planned_m if is_whole else max(planned_m, self.goal.length_m),
            planned_turn_rad=planned_rad,
            steps_done=self._executor.steps_done,
            steps=self._executor.steps,
            executed=executed,
            remaining=remaining if outcome != "completed" else "",
            open_ended=not is_whole and self.goal.is_open_ended,
        )

    def _parts(self) -> tuple[str, str]:
        """The text of the part that was driven, and of the rest; nothing where it was not measured."""
        reached, planned = self._executor.reached, self.goal.planned
        if reached is None or planned is None or planned.rehearsal is None:
            return "", ""
        context = replace(planned.rehearsal.context, pose=self._robot.pose)
        parts = split(self.goal.stream.accepted, reached, context)
        left = parts.remaining
        return _text(parts.executed), _text(left and self._scaling.plan(left, self._robot.profile))

    def _tell(self, verdict: Verdict) -> None:
        """Say once a step and rule that something was limited."""
        key = (self._executor.step, verdict.rule)
        if is_worth_telling(verdict) and key not in self._told:
            self._told.add(key)
            self._emit(self._motion.limited(verdict))


def _text(plan: Plan | None) -> str:
    return format_plan(plan) if plan is not None else ""
