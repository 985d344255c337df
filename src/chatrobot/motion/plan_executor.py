"""Drives one goal at a time: launched once it has been rehearsed and approved, ticked at 50 Hz, ended as measured.

A motion ends at once, and its end is told once the robot stands: a robot that was stopped rolls on until it has braked,
and only then do pose, turn and path say what became of the motion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Outcome, Progress, Started
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.execution.sensors import is_seen_moving
from chatrobot.governor.governor import Verdict
from chatrobot.motion.budgets import REACHED
from chatrobot.motion.goal import Goal
from chatrobot.motion.goal_queue import Inbox, OutcomeQueue
from chatrobot.motion.governed_robot import GovernedMotion, GovernedRobot, is_worth_telling
from chatrobot.motion.programs.clocks import LiveProgram
from chatrobot.motion.programs.execution import ProgramExecution, ProgramSandbox
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.safety.stop import Stops
from chatrobot.motion.safety.watchdog import Interlock
from chatrobot.plan.split import split
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan


class GoalExecution:
    """Drives the plan of `goal`, which has been rehearsed. `tick` until `is_done`, or until it is stopped."""

    def __init__(self, goal: Goal, robot: GovernedRobot, emit: Callable[[Event], None], now_s: float) -> None:
        assert goal.stream.walk is not None
        self.goal = goal
        self._emit = emit
        self._robot = robot
        self._motion = GovernedMotion(goal, robot, now_s)
        self._told: set[tuple[int, str]] = set()
        self._executor = Executor(robot.profile, robot.sensors, emit)
        self._executor.start(goal.turn, goal.stream.walk, goal.stream.duration_s, now_s)

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
        reached, planned = self._executor.reached, self.goal.planned
        if reached is None or planned is None or planned.rehearsal is None:
            return "", ""
        context = replace(planned.rehearsal.context, pose=self._robot.pose)
        parts = split(self.goal.stream.accepted, reached, context)
        return _text(parts.executed), _text(parts.remaining)

    def _tell(self, verdict: Verdict) -> None:
        """Say once a step and rule that something was limited."""
        key = (self._executor.step, verdict.rule)
        if is_worth_telling(verdict) and key not in self._told:
            self._told.add(key)
            self._emit(self._motion.limited(verdict))


def _text(plan: Plan | None) -> str:
    return format_plan(plan) if plan is not None else ""


FAILURES = frozenset(
    {"guard_lost", "bumped", "motion_froze", "motion_late", "beats_missed", "beat_late", "wire_gone"}
)
"""A stop for one of these is no wish of anybody's: what ran has failed."""


class PlanExecutor:
    """Has the `goal` it was given from `launch` until its end is told. Belongs to the control thread."""

    def __init__(
        self,
        robot: GovernedRobot,
        interlock: Interlock,
        stops: Stops,
        programs: ProgramSandbox,
        inbox: Inbox,
        clock: Clock,
        outcomes: OutcomeQueue,
        emit: Callable[[Event], None],
    ) -> None:
        self._robot = robot
        self._outcomes = outcomes
        self._interlock = interlock
        self._stops = stops
        self._programs = programs
        self._inbox = inbox
        self._clock = clock
        self._emit = emit
        self._run: GoalExecution | ProgramExecution | None = None
        self.goal: Goal | None = None
        """What is being launched or driven."""

    @property
    def is_driving(self) -> bool:
        return self._run is not None

    def drives(self, goal: Goal) -> bool:
        """Whether that goal is under way."""
        return self._run is not None and self._run.goal is goal

    # --- begin ---

    def launch(self, goal: Goal) -> None:
        """Begin to drive what has been rehearsed, or refuse it. Nothing else may be under way."""
        now_s = self._clock.now_s()
        self.goal = goal
        barrier = self._interlock.barrier_for(goal.lease, now_s) or self._robot.begin(goal.lease, now_s)
        if barrier is not None:
            self._give_up("refused", barrier)
        elif self._stops.is_unbooked:
            return  # stopped a moment ago, from another thread: command was taken after it; it ends as stopped
        elif isinstance(goal, ProgramGoal):
            self._launch_program(goal)
        else:
            self._set_out(GoalExecution(goal, self._robot, self._emit, now_s), now_s)

    def _launch_program(self, goal: ProgramGoal) -> None:
        """Start it in its sandbox, off this thread; it runs from the moment it is there."""

        def take(program: LiveProgram | Reason) -> None:
            if isinstance(program, Reason):
                if self.goal is goal:
                    self._give_up("refused", program)
            elif self.goal is not goal:
                program.close()  # stopped meanwhile
            else:
                now_s = self._clock.now_s()
                self._set_out(ProgramExecution(goal, program, self._robot, self._emit, now_s), now_s)

        self._inbox.fetch(lambda: self._programs.launch(goal), take)

    def _set_out(self, run: GoalExecution | ProgramExecution, now_s: float) -> None:
        self._run = run
        self._emit(Started(run.goal.turn, run.goal.start, self._robot.sensors.has_odometry))
        self.tick(now_s)

    # --- under way ---

    def tick(self, now_s: float) -> None:
        """One period of what is under way. Where it may not go on the robot is halted; that stop is to be booked."""
        run = self._run
        if run is None:
            return
        barrier = self._interlock.barrier_for(run.goal.lease, now_s)
        if barrier is None and self._robot.sensors.bumped:
            barrier = Reason("bumped")
        if barrier is not None:
            self._stops.halt(barrier)
            return
        run.tick(now_s)
        if run.is_done:
            outcome, reason = run.outcome, run.reason
            is_waited_for = outcome == "completed"  # it has been told to stand
            if is_waited_for and is_seen_moving(self._robot.sensors):
                outcome, reason = "failed", Reason("moves_on")
            if outcome != "completed":
                self._stops.halt_and_book(reason or Reason("cause_unknown"))
            self._end(run, outcome, reason)
            if is_waited_for:
                self._outcomes.tell_all()

    def expect(self, duration_s: float) -> None:
        """The plan under way has become longer: so long in all."""
        if isinstance(self._run, GoalExecution):
            self._run.expect(duration_s)

    def progress(self, now_s: float) -> Progress | None:
        """How far it is; None where nothing is under way."""
        return self._run.progress(now_s) if self._run is not None else None

    # --- end ---

    def ramp_down(self, why: Reason) -> None:
        """A controlled stop; what is only being launched ends at once."""
        if self._run is not None:
            self._run.ramp_down(why)
        elif self.goal is not None:
            self._give_up("stopped", why)

    def end_stopped(self, why: Reason) -> None:
        """The robot has been stopped: end what was under way."""
        if self._run is not None:
            self._end(self._run, "failed" if why.code in FAILURES else "stopped", why)
        elif self.goal is not None:
            self._give_up("stopped", why)

    def break_off(self, why: Reason) -> Callable[[], Finished] | None:
        """The robot has been paused: what tells how much was done of the plan under way, and is left of it.

        None, and nothing is done, where it cannot be gone on with.
        """
        run = self._run
        if not isinstance(run, GoalExecution) or not run.finished("stopped", why).remaining:
            return None
        self._let_go(run)
        return lambda: run.goal.whole(run.finished("stopped", why))

    def fail(self, why: Reason) -> None:
        """The way to the robot is gone for good: what was under way has failed."""
        if self._run is not None:
            self._end(self._run, "failed", why)
        elif self.goal is not None:
            self._give_up("failed", why)
        self._outcomes.tell_all()

    def _end(self, run: GoalExecution | ProgramExecution, outcome: Outcome, reason: Reason | None) -> None:
        self._let_go(run)
        stream, possible = run.goal.stream, ""
        if outcome == "completed" and stream.refusal is not None:
            reason = stream.refusal  # what came before it has been done
            outcome = "stopped" if reason.code in REACHED else "refused"
            possible = stream.possible
        self._outcomes.tell_later(
            lambda: replace(run.goal.whole(run.finished(outcome, reason)), possible=possible)
        )

    def _let_go(self, run: GoalExecution | ProgramExecution) -> None:
        self.goal = self._run = None
        run.close()
        self._robot.governor.end(run.goal.lease)

    def _give_up(self, outcome: Outcome, reason: Reason) -> None:
        """End what has not begun to move. It may be in command already: a program that is being launched."""
        goal, self.goal = self.goal, None
        assert goal is not None
        self._robot.governor.end(goal.lease)
        self._outcomes.tell(lambda: goal.unmoved(outcome, reason, self._robot.pose))
