"""Drives one goal at a time: launched once it has been rehearsed and approved, ticked at 50 Hz, ended as measured.

A motion ends at once, and its end is told once the robot stands: a robot that was stopped rolls on until it has braked,
and only then do pose, turn and path say what became of the motion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Outcome, Progress, Started
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import is_seen_moving
from chatrobot.execution.tracking import NOT_ARRIVED
from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import REACHED
from chatrobot.motion.goal import Goal
from chatrobot.motion.goal_queue import Inbox, OutcomeQueue
from chatrobot.motion.governed_motion import GoalExecution
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.programs.clocks import LiveProgram
from chatrobot.motion.programs.execution import ProgramExecution
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.stop import Stops
from chatrobot.motion.safety.watchdog import Interlock
from chatrobot.plan.speed_scaling import SpeedScaling

FAILURES = frozenset(
    {"guard_lost", "bumped", "motion_froze", "motion_late", "beats_missed", "beat_late", "wire_gone"}
)
"""A stop for one of these is no wish of anybody's: what ran has failed."""


@dataclass(eq=False)
class PlanExecutor:
    """Drives the `goal` it was given, from `launch` until its end is told. Belongs to the control thread."""

    _robot: GovernedRobot
    _interlock: Interlock
    _stops: Stops
    _programs: ProgramHost
    _inbox: Inbox
    _clock: Clock
    _outcomes: OutcomeQueue
    _emit: Callable[[Event], None]
    _run: GoalExecution | ProgramExecution | None = field(default=None, init=False)
    _begun: Callable[[], None] = field(default=lambda: None, init=False)
    _awaits_guard: bool = field(default=False, init=False)
    _is_braking: bool = field(default=False, init=False)
    goal: Goal | None = field(default=None, init=False)
    """What is being launched or driven."""

    @property
    def is_driving(self) -> bool:
        """True while a goal is under way."""
        return self._run is not None

    @property
    def goes_on(self) -> bool:
        """True while a goal is under way that nothing has put an end to."""
        return self._run is not None and not self._is_braking

    def drives(self, goal: Goal) -> bool:
        """Return whether that goal is under way."""
        return self._run is not None and self._run.goal is goal

    # --- begin ---

    def launch(self, goal: Goal, begun: Callable[[], None]) -> None:
        """Begin to drive what has been rehearsed, or refuse it; `begun` once it drives. Nothing else may be under way.

        Where the guard has been silent for a moment, as on a busy machine, it waits for it, and nothing moves.
        """
        self.goal, self._begun = goal, begun
        now_s = self._clock.now_s()
        barrier = self._interlock.barrier_for(goal.lease, now_s) or self._robot.begin(goal.lease, now_s)
        self._awaits_guard = barrier is not None and self._interlock.awaits_guard(barrier)
        if self._awaits_guard:
            return
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
        self._run, self._is_braking = run, False
        self._emit(Started(run.goal.turn, run.goal.start, self._robot.sensors.has_odometry))
        self.tick(now_s)
        self._begun()

    # --- under way ---

    def tick(self, now_s: float) -> None:
        """Do one period of what is under way. Where it may not go on, halt the robot; that stop is to be booked."""
        run = self._run
        if run is None:
            if self._awaits_guard and self.goal is not None:
                self.launch(self.goal, self._begun)
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
            # It has been told to stand, and time enough to.
            is_waited_for = outcome == "completed" or (reason is not None and reason.code == NOT_ARRIVED)
            if is_waited_for and is_seen_moving(self._robot.sensors):
                outcome, reason = "failed", Reason("moves_on")
            if outcome != "completed":
                self._stops.halt_and_book(reason or Reason("cause_unknown"))
            self._end(run, outcome, reason)
            if is_waited_for:
                self._outcomes.tell_all()

    def expect(self, duration_s: float) -> None:
        """Expect so long a duration in all: the plan under way has become longer."""
        if isinstance(self._run, GoalExecution):
            self._run.expect(duration_s)

    def rescale(self, envelope: Envelope, scaling: SpeedScaling) -> None:
        """Go on at another speed with the plan of that source and turn, where it is under way."""
        run = self._run
        about = (envelope.turn, envelope.lease)
        if isinstance(run, GoalExecution) and (run.goal.turn, run.goal.lease) == about:
            run.rescale(scaling, self._clock.now_s())

    def progress(self, now_s: float) -> Progress | None:
        """Return how far it is; None where nothing is under way."""
        return self._run.progress(now_s) if self._run is not None else None

    # --- end ---

    def ramp_down(self, why: Reason) -> None:
        """Stop at the deceleration of the profile; end at once what is only being launched."""
        if self._run is not None:
            self._is_braking = True
            self._run.ramp_down(why)
        elif self.goal is not None:
            self._give_up("stopped", why)

    def end_stopped(self, why: Reason) -> None:
        """End what was under way: the robot has been stopped."""
        if self._run is not None:
            self._end(self._run, "failed" if why.code in FAILURES else "stopped", why)
        elif self.goal is not None:
            self._give_up("stopped", why)

    def break_off(self, why: Reason) -> Callable[[], Finished] | None:
        """Let go of the plan under way for a pause; return what tells how much of it was done, and is left.

        None, and nothing is done, where it cannot be gone on with.
        """
        run = self._run
        if not isinstance(run, GoalExecution) or not run.finished("stopped", why).remaining:
            return None
        self._let_go(run)
        return lambda: run.goal.whole(run.finished("stopped", why))

    def fail(self, why: Reason) -> None:
        """End what was under way as failed: the way to the robot is gone for good."""
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
        self._outcomes.tell_unmoved(goal, outcome, reason)
