"""Has plans rehearsed off the control thread: whole, part by part while they are driven, or only to try them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from chatrobot.core.events import Event
from chatrobot.core.geometry import Pose
from chatrobot.motion.goal import Goal
from chatrobot.motion.goal_queue import GoalQueue, Inbox
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.plan_executor import PlanExecutor
from chatrobot.motion.planner import Planned, Planner, refused
from chatrobot.motion.programs.goal import ProgramGoal

LONGEST_TRIAL_S = 0.5
"""So long what is driven goes on until an order that has not been tried by then takes its place."""


@dataclass(eq=False)
class PlanRehearsal:
    """Belongs to the control thread."""

    _robot: GovernedRobot
    _executor: PlanExecutor
    _planner: Planner
    _inbox: Inbox
    _emit: Callable[[Event], None]

    def planning(
        self, goal: Goal, plan_text: str, start: Pose, plan_start: Pose | None
    ) -> Callable[[], Planned]:
        """Return what rehearses that text of the goal among what is seen now, for the background."""
        seen, left = self._robot.seen(), goal.left
        return lambda: self._planner.plan(goal.turn, plan_text, start, plan_start, seen, left)

    def next_part(self, goal: Goal) -> None:
        """Rehearse the next part of what is driven, if the one before it has been."""
        walk = goal.stream.walk
        if not self._executor.drives(goal) or walk is None:
            return
        plan_text = goal.stream.take()
        if plan_text is not None:
            self._fetch_part(goal, self.planning(goal, plan_text, walk.end, goal.plan_start or goal.start))

    def _fetch_part(self, goal: Goal, rehearse: Callable[[], Planned]) -> None:
        world = self._planner.world

        def take(planned: Planned) -> None:
            if self._planner.world is world:
                self._take_part(goal, planned)
            elif self._executor.drives(goal):  # it was rehearsed in another world
                self._fetch_part(goal, rehearse)

        self._inbox.fetch(rehearse, take)

    def _take_part(self, goal: Goal, planned: Planned) -> None:
        if not self._executor.drives(goal):
            return
        part = planned.part_event(len(goal.stream.accepted))
        refusal = goal.take(planned)
        self._emit(refused(part, refusal))
        if refusal is None:
            self._executor.expect(goal.stream.duration_s)
        self.next_part(goal)


@dataclass(eq=False)
class Trial:
    """Tries one order before it takes the place of what is driven. Belongs to the control thread.

    It is rehearsed from where the robot would come to stand. A trial refuses at most: what passes is rehearsed again
    once the robot stands, as every plan is.
    """

    _robot: GovernedRobot
    _goal_queue: GoalQueue
    _executor: PlanExecutor
    _rehearsal: PlanRehearsal
    _inbox: Inbox
    goal: Goal | None = field(default=None, init=False)
    """What is being tried."""
    _began_s: float = field(default=math.inf, init=False)

    def begin(self, goal: Goal, now_s: float, take: Callable[[Planned], None]) -> bool:
        """Try it; return whether there is anything that would go on without it. `take` hears what came of it."""
        driven = self._executor.goal
        is_plan = not isinstance(goal, ProgramGoal) and self._robot.sensors.has_odometry
        if driven is None or not self._executor.goes_on or driven.lease != goal.lease or not is_plan:
            return False
        self.goal, self._began_s = goal, now_s
        rehearse = self._rehearsal.planning(goal, goal.plan_text, self._braked(), None)

        def heard(planned: Planned) -> None:
            if self.goal is goal:
                take(planned)

        self._inbox.fetch(rehearse, heard)
        return True

    def take(self) -> Goal | None:
        """End the trial; return what was tried."""
        goal, self.goal = self.goal, None
        return goal

    def give_up(self, about: tuple[str, int] | None = None) -> None:
        """Let what is tried wait like all others, where it is of that lease and turn, or none is told."""
        goal = self.goal
        if goal is not None and about in (None, (goal.lease, goal.turn)):
            self.goal = None
            self._goal_queue.goals.append(goal)

    def is_too_long(self, now_s: float) -> bool:
        """Return whether it has taken so long that the order goes before its trial."""
        return self.goal is not None and now_s - self._began_s > LONGEST_TRIAL_S

    def _braked(self) -> Pose:
        """Where the robot would come to stand if it were told to now."""
        estimate, limits = self._robot.sensors.estimate, self._robot.profile.limits
        if estimate is None:
            return self._robot.pose
        twist = estimate.twist
        braking_s = max(
            twist.speed_mps / limits.deceleration_mps2,
            abs(twist.wz_radps) / limits.angular_acceleration_radps2,
        )
        return self._robot.pose.moved(twist, limits.latency_s + braking_s / 2.0)
