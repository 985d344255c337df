"""One program under way in its sandbox: what it asks goes through the governor at 50 Hz, and the end is measured.

Its last velocity is held while it beats, for as long as the profile says that the base would hold it. Whatever ends
it (its own end, an exception, a kill, silence), the robot is brought to stand.
"""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import TERM_S, TICK_S
from chatrobot.core.events import Event, Finished, Outcome, ProgramLog, Progress
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import STANDS_LATE_S, is_seen_moving, is_seen_standing
from chatrobot.governor.governor import Verdict
from chatrobot.motion.governed_motion import GovernedMotion, decelerated, is_worth_telling
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.programs.clocks import HeldTwist, LiveProgram
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.programs.events import Died, Ended, Log, Output, ProgramEvent, Raised, TwistAsked

SETTLE_S = 1.0
"""A robot that is told to stand is waited for no longer than this, where it is not seen moving."""
STARTING_S = 3.0
"""A program that says nothing for so long after its launch is not coming."""
LATER_S = 1.0
FARTHER_SHARE, FARTHER_M = 0.1, 0.1
"""A program that lasts or drives so much more than its rehearsal does something else: its rehearsal is no measure."""
LOG_LINES = 500
"""More of what a program logs is not told; it may go on for an hour."""


class ProgramExecution:
    """Drives by the program of `goal`, which has been rehearsed and launched. `tick` until `is_done`, or a stop."""

    def __init__(
        self,
        goal: ProgramGoal,
        program: LiveProgram,
        robot: GovernedRobot,
        emit: Callable[[Event], None],
        now_s: float,
    ) -> None:
        self.goal = goal
        self.is_done = False
        self.outcome: Outcome = "completed"
        self.reason: Reason | None = None
        self._program = program
        self._robot = robot
        self._sensors = robot.sensors
        self._emit = emit
        self._motion = GovernedMotion(goal, robot, now_s)
        self._began_s = self._now_s = now_s
        self._heard_s = now_s + STARTING_S - TERM_S
        self._sent = ZERO_TWIST
        self._limits = robot.profile.limits
        self._held = HeldTwist(robot.profile.wiring.base_timeout_s)
        self._ended_s: float | None = None
        self._ramps_down = False
        self._logged = 0
        self._told: set[tuple[str, Twist]] = set()

    def tick(self, now_s: float) -> None:
        """Send what the program asks for, as far as the governor allows it: one period."""
        since_s, self._now_s = self._now_s, now_s
        if self._ended_s is None:
            for event in self._program.poll_until(now_s - self._began_s):
                self._hear(event, now_s)
            self._notice_silence(now_s)
            self._notice_fault()
        asked = self._held.at(now_s) if self._ended_s is None else ZERO_TWIST
        if self.outcome == "completed" or self._ramps_down:
            asked = decelerated(asked, self._sent, self._limits, now_s - since_s)
        verdict = self._motion.send(asked, now_s)
        self._sent = verdict.sent.twist
        over = self._motion.over_budget()
        if over is not None:
            self.ramp_down(over)
        self._tell(verdict)
        if self._ended_s is not None and verdict.sent.twist.is_zero:
            standing = self._sensors.estimate is None or is_seen_standing(self._sensors)
            patience_s = STANDS_LATE_S if is_seen_moving(self._sensors) else SETTLE_S
            self.is_done = standing or now_s - self._ended_s > patience_s

    def ramp_down(self, why: Reason) -> None:
        """End the program and bring the robot to stand, as its limits allow."""
        self._ramps_down = self._ended_s is None
        self._end("stopped", why)

    def close(self) -> None:
        """End the program, whatever ended this run."""
        self._program.close()
        self._motion.close()

    def progress(self, now_s: float) -> Progress:
        """Return how far it is of the rehearsed duration; a program that goes on for longer has no share of it."""
        estimate = self._sensors.estimate
        assert estimate is not None
        assert self.goal.planned is not None
        lasted_s, expected_s = now_s - self._began_s, self.goal.planned.duration_s
        is_known = not self.goal.is_open_ended and lasted_s <= expected_s + LATER_S
        fraction = min(1.0, lasted_s / max(expected_s, TICK_S)) if is_known else None
        return Progress(self.goal.turn, 1, 1, fraction, estimate.pose, estimate.twist)

    def finished(self, outcome: Outcome, reason: Reason | None) -> Finished:
        """Return the end, as odometry measured it."""
        planned_m = self.goal.length_m
        goes_on_m = planned_m * (1.0 + FARTHER_SHARE) + FARTHER_M
        return self._motion.finished(
            outcome,
            reason,
            planned_m=planned_m,
            planned_turn_rad=self._motion.turned_rad(),  # a program promises none
            steps_done=1 if outcome == "completed" else 0,
            steps=1,
            open_ended=self.goal.is_open_ended or self._motion.path_m > goes_on_m,
        )

    # --- what it says ---

    def _hear(self, event: ProgramEvent, now_s: float) -> None:
        self._heard_s = max(self._heard_s, now_s)
        if isinstance(event, TwistAsked):
            self._held.publish(event.twist, now_s)
        elif isinstance(event, Log):
            self._log(now_s, event.level, f"[{event.name}] {event.text}")
        elif isinstance(event, Output):
            for line in event.text.splitlines():
                self._log(now_s, event.stream, line)
        elif isinstance(event, Ended):
            code = event.exit_code
            reason = Reason("program_exit_code", {"exit_code": code}) if code else None
            self._end("failed" if code else "completed", reason)
        elif isinstance(event, Raised):
            self._log(now_s, "traceback", event.traceback)
            self._end("failed", event.as_reason)
        elif isinstance(event, Died):
            self._end("failed", event.reason)

    def _end(self, outcome: Outcome, reason: Reason | None) -> None:
        if self._ended_s is None:
            self.outcome, self.reason = outcome, reason
            self._ended_s = self._now_s
            self._program.close()

    def _notice_silence(self, now_s: float) -> None:
        if self._ended_s is None and now_s - self._heard_s > TERM_S:
            self._end("failed", Reason("program_silent"))

    def _notice_fault(self) -> None:
        """As for a plan: nobody sees any more where the robot goes, its fence included."""
        fault = self._robot.fault()
        if fault is not None:
            self._end("failed", fault)

    # --- telling ---

    def _log(self, now_s: float, level: str, text: str) -> None:
        self._logged += 1
        if self._logged <= LOG_LINES:
            self._emit(ProgramLog(self.goal.turn, round(now_s - self._began_s, 3), level, text))

    def _tell(self, verdict: Verdict) -> None:
        """Say once for each velocity and rule that something was limited."""
        key = (verdict.rule, verdict.asked)
        if is_worth_telling(verdict) and key not in self._told and len(self._told) < LOG_LINES:
            self._told.add(key)
            self._emit(self._motion.limited(verdict))
