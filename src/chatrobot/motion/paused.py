"""A plan that was paused: what is left of it, and until when it may be gone on with.

It belongs to the control thread. Nothing of ours drives meanwhile, and nothing of it begins again by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Notice, Paused
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Priority
from chatrobot.link.approval import LAPSES_AFTER_M, LAPSES_AFTER_RAD
from chatrobot.link.envelope import Envelope
from chatrobot.motion.goal import Goal
from chatrobot.motion.goal_queue import GoalQueue
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.plan_executor import OutcomeQueue
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.safety.interlock import Interlock
from chatrobot.motion.safety.stop import Stops

KEPT_S = 600.0
SILENT_S = 2.0
"""A source may miss some beats while the robot stands; one that is silent for longer is gone."""


class PausedGoal:
    """Made with the pause; it waits to be gone on with once the robot has come to stand.

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
        """The robot has come to stand."""
        return self._so_far is not None

    def is_for(self, envelope: Envelope) -> bool:
        """Whether it may be gone on with at this word: it is of the same source and turn, and the robot stands."""
        return self.has_settled and (self.goal.turn, self.goal.lease) == (envelope.turn, envelope.lease)

    def settle(self) -> Paused:
        """The robot stands now: from here it would go on. What the faces show of it."""
        self._so_far = so_far = self._measure()
        return Paused(self.goal.turn, so_far.pose, so_far.remaining, so_far.reason)

    def lapsed(self, now_s: float, pose: Pose) -> Reason | None:
        """Why it may not be gone on with any more, the robot being at `pose`."""
        if now_s - self._since_s > KEPT_S:
            return Reason("pause_too_long", {"limit_s": KEPT_S})
        stood = self._so_far.pose if self._so_far is not None else pose
        if pose.distance_to(stood) > LAPSES_AFTER_M:
            return Reason("pause_robot_moved", {"limit_m": LAPSES_AFTER_M})
        if abs(pose.yaw_rad - stood.yaw_rad) > LAPSES_AFTER_RAD:
            return Reason("pause_robot_moved", {"limit_deg": round(math.degrees(LAPSES_AFTER_RAD))})
        return None

    def ended(self, reason: Reason, now_s: float) -> Finished:
        """Its end as a plan that was stopped."""
        return replace(self._waited(now_s), outcome="stopped", reason=reason)

    def rest(self, epoch: int, now_s: float) -> Goal:
        """What is left, as a goal of the same turn."""
        goal, so_far = self.goal, self._waited(now_s)
        if goal.stream is not None:
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
    """It came without a sender: nobody could go on with it."""
    return robot.governor.leases.priority_of(goal.lease) <= Priority.FOREIGN


def why_not_kept(goal: Goal | None, robot: GovernedRobot) -> Reason | None:
    """Why a pause ended that goal as a stop does; None where it was nothing to go on with."""
    if goal is None or goal.rehearse_only:
        return None
    if isinstance(goal, ProgramGoal):
        return Reason("program_not_paused")
    if is_foreign(goal, robot):
        return Reason("foreign_not_paused")
    return Reason("nothing_to_keep" if robot.sensors.has_odometry else "pause_unmeasured")


class Pausing:
    """Keeps the one plan that is paused, if any."""

    def __init__(
        self,
        robot: GovernedRobot,
        goal_queue: GoalQueue,
        interlock: Interlock,
        stops: Stops,
        clock: Clock,
        outcomes: OutcomeQueue,
        emit: Callable[[Event], None],
    ) -> None:
        self._robot = robot
        self._goal_queue = goal_queue
        self._interlock = interlock
        self._stops = stops
        self._clock = clock
        self._outcomes = outcomes
        self._emit = emit
        self._paused: PausedGoal | None = None
        self._heard_s = 0.0

    @property
    def goal(self) -> Goal | None:
        """What is paused."""
        return self._paused.goal if self._paused is not None else None

    def begin(self, paused: PausedGoal) -> None:
        """Keep it; what is queued waits behind it."""
        self._heard_s = self._clock.now_s()
        self._paused = paused

    def watch(self, now_s: float, *, is_standing: bool) -> None:
        """Tell of it once the robot stands; drop what may not be gone on with any more."""
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
            if event.plan_text:
                self._emit(event)
            else:
                self.drop(event.reason or Reason("cause_unknown"))

    def resume(self, envelope: Envelope) -> None:
        """Its own source wants to go on: the rest comes before all that waits, as a plan of the same turn."""
        paused = self._paused
        if paused is None or not paused.is_for(envelope):
            self._emit(Notice(envelope.turn, Reason("nothing_paused")))
            return
        self._paused = None
        self._goal_queue.resume(paused.rest(self._stops.count, self._clock.now_s()))

    def drop(self, why: Reason, lease: str | None = None) -> None:
        """It is not gone on with, and what waits behind it is not done. `lease`: only where it is that one's."""
        if self._paused is None or lease not in (None, self._paused.goal.lease):
            return
        self.end(why)
        for goal in self._goal_queue.take_all():
            self._tell_unmoved(goal, why)

    def _tell_unmoved(self, goal: Goal, why: Reason) -> None:
        self._outcomes.tell(lambda: goal.unmoved("stopped", why, self._robot.pose))

    def end(self, why: Reason) -> None:
        """It is not gone on with: tell its end."""
        paused, self._paused = self._paused, None
        if paused is None:
            return
        now_s = self._clock.now_s()
        tell = self._outcomes.tell if paused.has_settled else self._outcomes.tell_later
        tell(lambda: paused.ended(why, now_s))
