"""What the console knows of the robot at this moment, gathered from the events. Written by the pumping thread, read by
the screen: every field is replaced whole, so that no lock is needed."""

from __future__ import annotations

import math
from dataclasses import dataclass

from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose, Twist
from chatrobot.robots.profile import OPEN_LOOP

XY = tuple[float, float]
TRAIL_SPACING_M = 0.03
TRAIL_LIMIT = 2000


@dataclass
class MotionView:
    """`path` is the predicted way of the last plan, `trail` what was driven of it, in `odom`; `program` the last
    one written, where no plan came after it. `is_measured`: not so, nobody knows pose and velocity."""

    pose: Pose = ORIGIN
    twist: Twist = ZERO_TWIST
    is_moving: bool = False
    is_paused: bool = False
    step_number: int = 0
    step_count: int = 0
    fraction: float | None = 0.0
    nearest_m: float | None = None
    battery_percent: float | None = None
    path: tuple[XY, ...] = ()
    trail: tuple[XY, ...] = ()
    plan_text: str = ""
    program: events.ProgramWritten | None = None
    rehearsed: events.Rehearsed | None = None
    turn: int = 0
    is_measured: bool = True
    _streamed_turn: int = 0

    def hear(self, event: Event) -> None:
        """Take one event in."""
        if isinstance(event, events.Telemetry):
            self.pose, self.twist = event.pose, event.twist
            self.nearest_m, self.battery_percent = event.nearest_obstacle_m, event.battery_percent
            self._follow(event.pose)
        elif isinstance(event, events.Progress):
            self.step_number, self.step_count, self.fraction = event.step, event.of, event.fraction
        elif isinstance(event, events.Streamed):
            self._grow(event)
        elif isinstance(event, events.Interpreted) and event.plan_text:
            self.plan_text, self.program = event.plan_text, None
        elif isinstance(event, events.ProgramWritten):
            self.program = event
        elif isinstance(event, events.Rehearsed):
            self.rehearsed = event
            path = tuple((x, y) for x, y, _ in event.path)
            goes_on = event.turn == self._streamed_turn and self.is_moving
            self.path = (*self.path, *path) if goes_on else path
        elif isinstance(event, events.Started):
            self.turn, self.is_moving, self.step_number, self.step_count = event.turn, True, 0, 0
            self.is_paused = False
            self.fraction = None if self.rehearsed is not None and self.rehearsed.open_ended else 0.0
            self.pose, self.trail = event.pose, ((event.pose.x_m, event.pose.y_m),)
        elif isinstance(event, events.Paused):
            self.pose = event.pose
            if event.turn == self.turn:
                self.is_moving, self.twist = False, ZERO_TWIST
            self.is_paused = True
        elif isinstance(event, events.Finished):
            self._finish(event)
        elif isinstance(event, events.Notice) and event.reason.code == OPEN_LOOP:
            self.is_measured = False

    def _grow(self, event: events.Streamed) -> None:
        """Take in a step of a plan that comes step by step."""
        goes_on = event.turn == self._streamed_turn
        self.plan_text = f"{self.plan_text}\n{event.plan_text}" if goes_on else event.plan_text
        self._streamed_turn, self.program = event.turn, None

    def _follow(self, pose: Pose) -> None:
        here = (pose.x_m, pose.y_m)
        if self.is_moving and self.trail and math.dist(here, self.trail[-1]) >= TRAIL_SPACING_M:
            self.trail = (*self.trail, here)[-TRAIL_LIMIT:]

    def _finish(self, event: events.Finished) -> None:
        self.pose = event.pose
        if event.turn == self.turn:
            self.is_paused = False
            self._follow(event.pose)
            self.is_moving, self.twist = False, ZERO_TWIST
