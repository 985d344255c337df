"""Keeps the one plan that is paused, until it is gone on with, another takes its place or it may not be resumed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Notice, Paused
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Priority
from chatrobot.link.envelope import Envelope
from chatrobot.link.motion_link import LAPSES_AFTER_M, LAPSES_AFTER_RAD
from chatrobot.motion.goal import Goal, handed_over
from chatrobot.motion.goal_queue import GoalQueue, OutcomeQueue
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.safety.stop import PAUSED, Stops
from chatrobot.motion.safety.watchdog import Interlock
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.robots.profile import RobotProfile

KEPT_S = 600.0
SILENT_S = 2.0
"""A source may miss some beats while the robot stands; one that is silent for longer is gone."""


class PausedGoal:
    """Waits to be resumed once the robot has come to stand. Made with the pause.

    Args:
        measure: what has been done of `goal` by now, with the text of the rest.
        since_s: when it was paused.
    """

    def __init__(self, goal: Goal, measure: Callable[[], Finished], since_s: float) -> None:
        self.goal = goal
        self._measure = measure
        self._since_s = since_s
        self._so_far: Finished | None = None

    @property
    def has_settled(self) -> bool:
        """True once the robot has come to stand."""
        return self._so_far is not None

    def is_for(self, envelope: Envelope) -> bool:
        """Return whether this word may resume it: of the same source and turn, and the robot stands."""
        return self.has_settled and (self.goal.turn, self.goal.lease) == (envelope.turn, envelope.lease)

    def settle(self) -> Paused:
        """Measure how far it came, now that the robot stands; return what is shown of it."""
        self._so_far = so_far = self._measure()
        return Paused(self.goal.turn, so_far.pose, so_far.remaining, so_far.reason)

    def rescale(self, scaling: SpeedScaling, profile: RobotProfile) -> None:
        """Go on at another speed once it is resumed."""
        so_far = self._so_far or self._measure()
        left = scaling.plan(parse_plan(so_far.remaining), profile)
        self._so_far = replace(so_far, remaining=format_plan(left))

    def lapsed(self, now_s: float, pose: Pose) -> Reason | None:
        """Return why it may not be resumed any more, the robot being at `pose`."""
        if now_s - self._since_s > KEPT_S:
            return Reason("pause_too_long", {"limit_s": KEPT_S})
        stood = self._so_far.pose if self._so_far is not None else pose
        if pose.distance_to(stood) > LAPSES_AFTER_M:
            return Reason("pause_robot_moved", {"limit_m": LAPSES_AFTER_M})
        if abs(pose.yaw_rad - stood.yaw_rad) > LAPSES_AFTER_RAD:
            return Reason("pause_robot_moved", {"limit_deg": round(math.degrees(LAPSES_AFTER_RAD))})
        return None

    def ended(self, reason: Reason, now_s: float) -> Finished:
        """Return its end as a plan that was stopped."""
        return replace(self._waited(now_s), outcome="stopped", reason=reason)

    def rest(self, epoch: int, now_s: float) -> Goal:
        """Return what is left, as a goal of the same turn."""
        goal, so_far = self.goal, self._waited(now_s)
        goal.stream.rewind()
        return replace(
            goal,
            plan_text=so_far.remaining,
            epoch=epoch,
            received_s=now_s,
            planned=None,
            approval=None,
            plan_start=goal.plan_start or goal.start,
            so_far=so_far,
        )

    def _waited(self, now_s: float) -> Finished:
        """The time since it was paused counts as paused."""
        so_far = self._so_far or self._measure()
        return replace(so_far, paused_s=so_far.paused_s + now_s - self._since_s)


def is_foreign(goal: Goal, robot: GovernedRobot) -> bool:
    """Return whether it came without a sender: nobody could resume it."""
    return robot.governor.leases.priority_of(goal.lease) <= Priority.FOREIGN


def why_not_kept(goal: Goal | None, robot: GovernedRobot, why: Reason) -> Reason:
    """Return why what `why` would have kept ends as with a stop."""
    if goal is None or goal.rehearse_only or why.code != PAUSED:
        return why
    if isinstance(goal, ProgramGoal):
        return Reason("program_not_paused")
    if is_foreign(goal, robot):
        return Reason("foreign_not_paused")
    return Reason("nothing_to_keep" if robot.sensors.has_odometry else "pause_unmeasured")


@dataclass(eq=False)
class Pausing:
    """Keeps the one plan that is paused, if any."""

    _robot: GovernedRobot
    _goal_queue: GoalQueue
    _interlock: Interlock
    _stops: Stops
    _clock: Clock
    _outcomes: OutcomeQueue
    _emit: Callable[[Event], None]
    _paused: PausedGoal | None = field(default=None, init=False)
    _heard_s: float = field(default=0.0, init=False)
    _waits_for_word: bool = field(default=True, init=False)

    @property
    def goal(self) -> Goal | None:
        """Return what is paused."""
        return self._paused.goal if self._paused is not None else None

    def hold(self, why: Reason) -> None:
        """Wait for a word to go on, where it is a pause that has come: the rest sets out by itself no more."""
        self._waits_for_word = self._waits_for_word or why.code == PAUSED

    def begin(self, paused: PausedGoal, why: Reason) -> None:
        """Keep it; what is queued waits behind it."""
        self._heard_s = self._clock.now_s()
        self._paused = paused
        self._waits_for_word = why.code == PAUSED

    def watch(self, now_s: float, *, is_standing: bool) -> None:
        """Tell of it once the robot stands; drop what may not be resumed any more."""
        paused = self._paused
        if paused is None:
            return
        if self._robot.governor.leases.is_valid(paused.goal.lease, now_s):
            self._heard_s = now_s
        is_gone = now_s - self._heard_s > SILENT_S
        lease_barrier = self._interlock.barrier_for(paused.goal.lease, now_s) if is_gone else None
        why = self._interlock.barrier() or lease_barrier or paused.lapsed(now_s, self._robot.pose)
        if why is not None:
            self.drop(why)
        elif is_standing and not paused.has_settled:
            event = paused.settle()
            if event.plan_text and not self._waits_for_word:
                self._go_on(paused)
            elif event.plan_text:
                self._emit(event)
            else:
                self.drop(event.reason or Reason("cause_unknown"))

    def resume(self, envelope: Envelope) -> None:
        """Put the rest before all that waits, as a plan of the same turn: its own source wants to go on."""
        paused = self._paused
        if paused is None or not paused.is_for(envelope):
            self._emit(Notice(envelope.turn, Reason("nothing_paused")))
            return
        self._go_on(paused)

    def rescale(self, envelope: Envelope, scaling: SpeedScaling) -> None:
        """Go on at another speed once it is resumed, where it is of that source and turn."""
        if self._paused is not None and self._paused.is_for(envelope):
            self._paused.rescale(scaling, self._robot.profile)

    def _go_on(self, paused: PausedGoal) -> None:
        self._paused = None
        self._goal_queue.resume(paused.rest(self._stops.count, self._clock.now_s()))

    def drop_for(self, goal: Goal, mode: object, source_of: Callable[[Goal], str]) -> None:
        """Let another instruction take its place, but for one of the same source that is to come after it."""
        paused = self.goal
        if paused is None or goal.rehearse_only:
            return
        if goal.lease != paused.lease:
            self.drop(handed_over(source_of(paused), source_of(goal)))
        elif mode == "replace":
            self.drop(Reason("replaced"))

    def drop(self, why: Reason, lease: str | None = None) -> None:
        """End it and what waits behind it. `lease`: only where it is that one's."""
        if self._paused is None or lease not in (None, self._paused.goal.lease):
            return
        self.end(why)
        for goal in self._goal_queue.take_all():
            self._outcomes.tell_unmoved(goal, "stopped", why)

    def end(self, why: Reason) -> None:
        """End it, and tell so."""
        paused, self._paused = self._paused, None
        if paused is None:
            return
        now_s = self._clock.now_s()
        tell = self._outcomes.tell if paused.has_settled else self._outcomes.tell_later
        tell(lambda: paused.ended(why, now_s))
