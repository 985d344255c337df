"""One plan under way: the executor at 50 Hz, and the measured end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from chatrobot.core.events import Event, Finished, Outcome, Progress
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.governor.governor import Verdict
from chatrobot.motion.goal import Goal
from chatrobot.motion.governed_motion import GovernedMotion, is_worth_telling
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.plan.split import split
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan


class GoalExecution:
    """Drives the plan of `goal`, which has been rehearsed. `tick` until `is_done`, or until it is stopped."""

    def __init__(self, goal: Goal, robot: GovernedRobot, emit: Callable[[Event], None], now_s: float) -> None:
        assert goal.planned is not None
        self.goal = goal
        self._emit = emit
        self._robot = robot
        self._motion = GovernedMotion(goal, robot, now_s)
        self._told: set[tuple[int, str]] = set()
        self._executor = Executor(robot.profile, robot.sensors, emit)
        self._executor.start(goal.turn, goal.walk(), goal.planned.duration_s, now_s)

    def tick(self, now_s: float) -> None:
        """One period: what the executor asks, as far as the governor allows it."""
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
        return self._executor.is_done

    @property
    def outcome(self) -> Outcome:
        return self._executor.outcome

    @property
    def reason(self) -> Reason | None:
        return self._executor.reason

    def expect(self, duration_s: float) -> None:
        """The plan has become longer: so long in all."""
        self._executor.expect(duration_s)

    def ramp_down(self, why: Reason) -> None:
        """A controlled stop."""
        self._executor.ramp_down(why)

    def close(self) -> None:
        """Nothing is left behind."""
        self._motion.close()

    def progress(self, now_s: float) -> Progress:
        progress = self._executor.progress(self.goal.turn, now_s)
        return replace(progress, fraction=None) if self.goal.is_open_ended else progress

    def finished(self, outcome: Outcome, reason: Reason | None) -> Finished:
        """The end, as odometry measured it."""
        executed, remaining = self._parts()
        is_whole = outcome == "completed"  # conditions that came true may have made it shorter than rehearsed
        planned_m = self._executor.planned_m
        return self._motion.finished(
            outcome,
            reason,
            planned_m=planned_m if is_whole else max(planned_m, self.goal.length_m),
            planned_turn_rad=self._executor.planned_turn_rad,
            steps_done=self._executor.steps_done,
            steps=self._executor.steps,
            executed=executed,
            remaining=remaining if outcome != "completed" else "",
            open_ended=not is_whole and self.goal.is_open_ended,
        )

    def _parts(self) -> tuple[str, str]:
        """The text of the part that was driven, and of the rest; nothing where it was not measured."""
        reached, rehearsal = self._executor.reached, self.goal.rehearsal
        if reached is None or rehearsal is None:
            return "", ""
        context = replace(rehearsal.context, pose=self._robot.pose)
        parts = split(self.goal.steps, reached, context)
        return _text(parts.executed), _text(parts.remaining)

    def _tell(self, verdict: Verdict) -> None:
        """Say once a step and rule that something was limited."""
        key = (self._executor.step, verdict.rule)
        if is_worth_telling(verdict) and key not in self._told:
            self._told.add(key)
            self._emit(self._motion.limited(verdict))


def _text(plan: Plan | None) -> str:
    return format_plan(plan) if plan is not None else ""
