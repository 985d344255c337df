"""One pupil's way through a lesson: which task it is, what the checks say after each turn, what is passed.

Nothing here moves the robot: where a task begins anew elsewhere, whoever shows the lesson is given the plan for the way
there, and drives it when the pupil asks for that.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from chatrobot.core.events import Event, Result, TruePose
from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.lessons.attempt import Attempt
from chatrobot.lessons.checks import Finding
from chatrobot.lessons.sheet import Sheet, Task
from chatrobot.plan.steps import Go, Plan
from chatrobot.plan.text import format_plan
from chatrobot.sim.near import Nearness
from chatrobot.sim.shapes import Point

BEGINS_M, BEGINS_RAD = 0.2, math.radians(20.0)
"""So near to where a task begins it begins."""
_SAME_M, _SAME_RAD = 0.03, math.radians(3.0)
"""So near to there the robot need not be driven back."""
TaskState = Literal["open", "passed", "skipped"]


@dataclass(frozen=True)
class Verdict:
    """What the checks of a task say after a turn; `number` counts the tasks from 1.

    Without findings the task had not begun: the robot does not stand where it begins (`returned`: it was driven there,
    and got there, so that it begins now).
    """

    number: int
    task: Task
    findings: Sequence[Finding] = ()
    returned: bool = False

    @property
    def is_passed(self) -> bool:
        """All that is asked for is done."""
        return bool(self.findings) and all(finding.state == "done" for finding in self.findings)

    @property
    def is_broken(self) -> bool:
        """It cannot be passed any more, unless it begins anew."""
        return any(finding.state == "broken" for finding in self.findings)


@dataclass
class TaskRecord:
    """What became of a task. `try_count` counts the turns that were judged, `hint_count` the hints."""

    state: TaskState = "open"
    try_count: int = 0
    hint_count: int = 0


class LessonRun:
    """See the module. `hear` gets every event of the session, the true poses too; anything may come from any thread.

    Args:
        footprint: the robot's.
        number: of the task to begin with.
    """

    def __init__(self, sheet: Sheet, footprint: Sequence[Point], number: int = 1) -> None:
        self.sheet = sheet
        self.records = [TaskRecord() for _ in sheet.tasks]
        self._footprint = footprint
        self._world = sheet.world
        self._near = Nearness(footprint, sheet.world.obstacles)
        self._index = number - 1
        self._pose: Pose | None = None
        self._returning = 0
        self._lock = threading.RLock()
        self._attempt: Attempt | None = None
        self._began_at: Pose | None = None
        self._enter()

    # --- where it is ---

    @property
    def number(self) -> int:
        """Of the task, from 1; one more than there are where the lesson is over."""
        return self._index + 1

    @property
    def task(self) -> Task | None:
        """The task that is to be done; None where the lesson is over."""
        return self.sheet.tasks[self._index] if self._index < len(self.sheet.tasks) else None

    @property
    def has_begun(self) -> bool:
        """What the robot does now counts; else it does not stand where the task begins."""
        return self._attempt is not None

    @property
    def is_passed(self) -> bool:
        """Every task is."""
        return all(record.state == "passed" for record in self.records)

    # --- what happens ---

    def note_said(self, turn: int, text: str) -> None:
        """Take note of what the pupil typed for that turn."""
        with self._lock:
            if self._attempt is not None and turn != self._returning:
                self._attempt.note_said(turn, text)

    def hear(self, event: Event, *, goes_on: bool = False) -> Verdict | None:
        """Take an event in; a verdict where a turn that moved the robot has ended.

        Args:
            goes_on: something else is to be done next; what was stopped for that is judged together with it.
        """
        with self._lock:
            if isinstance(event, TruePose):
                self._pose = Pose(event.x_m, event.y_m, event.yaw_rad)
            if isinstance(event, ObstacleChanged):
                self._change(event)
            if self.task is None:
                return None
            if self._attempt is not None:
                self._attempt.hear(event)
            if not isinstance(event, Result) or (goes_on and event.outcome == "stopped"):
                return None
            if self._attempt is None:
                return self._hear_before(event, self.task)
            return self._judge(self._attempt, self.task) if self._attempt.has_driven(event.turn) else None

    def _change(self, event: ObstacleChanged) -> None:
        self._world = self._world.changed(event.obstacle, event.outline_m)
        self._near = Nearness(self._footprint, self._world.obstacles)
        if self._attempt is not None:
            self._attempt.change(self._world, self._near)

    def _judge(self, attempt: Attempt, task: Task) -> Verdict:
        figures = attempt.figures()
        verdict = Verdict(self.number, task, [check.judge(figures) for check in task.checks])
        record = self.records[self._index]
        record.try_count += 1
        if verdict.is_passed:
            record.state = "passed"
            self._go_on()
        return verdict

    def _hear_before(self, result: Result, task: Task) -> Verdict | None:
        """Begin where the robot has come to where the task begins, by itself or driven by the pupil."""
        was_driven = result.turn == self._returning
        self._returning = 0 if was_driven else self._returning
        is_there = was_driven and result.outcome == "completed"
        if is_there or self._is_at(self._goal, BEGINS_M, BEGINS_RAD):
            self._begin_here()
            return Verdict(self.number, task, returned=True)
        return Verdict(self.number, task) if result.has_moved or was_driven else None

    # --- what the pupil asks for ---

    def hint(self) -> Task | None:
        """Count a hint, and return the task whose hint it is."""
        with self._lock:
            if self.task is not None:
                self.records[self._index].hint_count += 1
            return self.task

    def skip(self) -> None:
        """Leave the task out."""
        with self._lock:
            if self.task is not None:
                self._leave_out()
                self._go_on()

    def go_to(self, number: int) -> bool:
        """Go to that task, done or left out as it may be; False where there is none. What was passed stays passed."""
        with self._lock:
            if not 1 <= number <= len(self.records):
                return False
            self._leave_out()
            self._index = number - 1
            record = self.records[self._index]
            record.state = "open" if record.state == "skipped" else record.state
            self._enter()
            return True

    def again(self, drive: Callable[[str], int]) -> bool:
        """Begin the task anew. `drive` takes plan text, drives it and returns its turn; it is called only where the
        robot is elsewhere. True where the task has begun already."""
        with self._lock:
            goal = self._goal
            if goal is None or self._is_at(goal, _SAME_M, _SAME_RAD):
                self._begin_here()
                return True
            self._attempt = None
            step = Go(round(goal.x_m, 3), round(goal.y_m, 3), round(wrap_angle(goal.yaw_rad), 4))
            self._returning = drive(format_plan(Plan((step,))))
            return False

    def _leave_out(self) -> None:
        if self.task is not None and self.records[self._index].state == "open":
            self.records[self._index].state = "skipped"

    def _go_on(self) -> None:
        """Turn to the next task that is not passed yet: whoever went back to one has passed others behind it."""
        self._index += 1
        while self.task is not None and self.records[self._index].state == "passed":
            self._index += 1
        self._enter()

    def _enter(self) -> None:
        """Begin the task where the robot stands, if it may begin there."""
        self._attempt = self._began_at = None
        if self.task is not None and self._is_at(self.task.begins_at, BEGINS_M, BEGINS_RAD):
            self._begin_here()

    @property
    def _goal(self) -> Pose | None:
        """Where the task begins: where the sheet says, else where this pupil began it."""
        task = self.task
        return self._began_at if task is None or task.begins_at is None else task.begins_at

    def _begin_here(self) -> None:
        """Begin to measure."""
        self._began_at = self._began_at or self._here
        self._attempt = Attempt(self._world, self._near, self._here)

    @property
    def _here(self) -> Pose:
        """Where the robot really is; where it has not been heard yet, at the start of the world."""
        return self._pose or Pose()

    def _is_at(self, goal: Pose | None, within_m: float, within_rad: float) -> bool:
        if goal is None:
            return True
        off_rad = abs(wrap_angle(self._here.yaw_rad - goal.yaw_rad))
        return self._here.distance_to(goal) <= within_m and off_rad <= within_rad
