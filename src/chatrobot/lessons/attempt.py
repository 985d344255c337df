"""One try at a task: what the simulator says the robot really did, and by which texts. Nothing here reads a reply."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

from chatrobot.core import events
from chatrobot.core.events import Event, TruePose
from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.reason import Value
from chatrobot.sim.near import Near, Nearness
from chatrobot.sim.shapes import Point
from chatrobot.sim.trace import Measured, Sample, measure
from chatrobot.sim.world import World

CLOSED_M = 0.15
"""A way that ends so near to where it began has a corner there, too."""
_CORNER_RAD = math.radians(30.0)
_SPACING_M = 0.025
"""Of the points of a way at which its direction is looked at: a circle of 0.1 m has no corners."""


@dataclass
class _Turn:
    """What is known of one text, and the poses while it was driven."""

    text: str = ""
    plan_text: str = ""
    is_program: bool = False
    has_started: bool = False
    is_done: bool = False
    trace: list[Sample] = field(default_factory=list)


class Attempt:
    """Hears the events of a session from where the task began; see the module."""

    def __init__(self, world: World, near: Nearness, begin: Pose | None) -> None:
        self.world = world
        self.near = near
        self._begin = begin
        self._trace: list[Sample] = []
        self._turns: dict[int, _Turn] = {}
        self._running = 0
        self._nearest = Near()
        self._measured_count = 0

    # --- what happens ---

    def change(self, world: World, near: Nearness) -> None:
        """Take note that something was put into the world, or taken away: what was near until now stays so."""
        self._nearest = self.figures().nearest
        self._measured_count = len(self._trace)
        self.world, self.near = world, near

    def note_said(self, turn: int, text: str) -> None:
        """Take note of what was typed for that turn."""
        self._turn(turn).text = text

    def hear(self, event: Event) -> None:
        """Take an event in."""
        match event:
            case TruePose():
                self._take(event)
            case events.Interpreted() | events.Streamed():
                turn = self._turn(event.turn)
                is_part = isinstance(event, events.Streamed)
                turn.plan_text = f"{turn.plan_text if is_part else ''}{event.plan_text}\n"
            case events.ProgramWritten():
                self._turn(event.turn).is_program = True
            case events.Started():
                self._turn(event.turn).has_started = True
                self._running = event.turn
                self._note(self._turn(event.turn).trace)
            case events.Result():
                self._turn(event.turn).is_done = event.outcome == "completed"
                self._running = 0 if self._running == event.turn else self._running

    def has_driven(self, turn: int) -> bool:
        """Return whether the robot began to act on that turn within this try."""
        return turn in self._turns and self._turns[turn].has_started

    def _turn(self, turn: int) -> _Turn:
        return self._turns.setdefault(turn, _Turn())

    def _take(self, true: TruePose) -> None:
        if self._begin is None:
            self._begin = Pose(true.x_m, true.y_m, true.yaw_rad)
        seen = Pose(true.x_m, true.y_m, true.yaw_rad).relative_to(self._begin)
        sample = Sample(true.t_s, *seen, true.vx_mps, true.vy_mps, true.wz_radps)
        stands_still = len(self._trace) > 1 and not (
            sample.is_moving or self._trace[-1].is_moving or self._trace[-2].is_moving
        )
        if stands_still:
            self._trace.pop()  # an hour at the prompt is two samples
        self._trace.append(sample)
        if self._running:
            self._turns[self._running].trace.append(sample)

    def _note(self, trace: list[Sample]) -> None:
        """Begin a turn's trace with where the robot stands."""
        if self._trace and not trace:
            trace.append(self._trace[-1])

    # --- what was measured ---

    def figures(self) -> Figures:
        """Return all of it, as of now."""
        driven = [turn for turn in self._turns.values() if turn.has_started]
        return Figures(
            self.world,
            self.near,
            self._begin or Pose(),
            tuple(self._trace),
            tuple(measure(turn.trace) for turn in driven),
            tuple(turn.text for turn in driven),
            tuple(turn.plan_text for turn in driven),
            sum(turn.is_program and turn.is_done for turn in driven),
            self._nearest,
            self._measured_count,
        )


@dataclass(frozen=True)
class Figures:
    """What a try was, in numbers: by the true poses in `trace`, in the frame of where it began.

    `turns`, `texts` and `plan_texts` are of the texts that the robot acted on. `nearest_before` is what was nearest in
    the first `measured_count` poses, among other obstacles.
    """

    world: World
    near: Nearness
    begin: Pose
    trace: Sequence[Sample]
    turns: Sequence[Measured]
    texts: Sequence[str]
    plan_texts: Sequence[str]
    program_count: int
    nearest_before: Near
    measured_count: int

    @cached_property
    def measured(self) -> Measured:
        """The whole way."""
        return measure(self.trace)

    @cached_property
    def seen_poses(self) -> list[Pose]:
        """Where the robot was, in the frame of the beginning."""
        return [Pose(sample.x_m, sample.y_m, sample.yaw_rad) for sample in self.trace] or [Pose()]

    @property
    def end(self) -> Pose:
        """Where the robot stands, in the frame of the world."""
        return self.begin.compose(self.seen_poses[-1])

    @property
    def time_s(self) -> float:
        """From the first to the last motion of each text, with the waits between: nobody is hurried in typing."""
        return sum(turn.duration_s + turn.pause_s for turn in self.turns)

    @property
    def stood_s(self) -> float:
        """Standing between two motions of a text."""
        return sum(turn.pause_s for turn in self.turns)

    def poses(self) -> list[Pose]:
        """Return where the robot was, in the frame of the world."""
        return [self.begin.compose(pose) for pose in self.seen_poses]

    @property
    def nearest(self) -> Near:
        """What came nearest to the edge of the robot."""
        now = self.near.on_the_way(self.poses()[self.measured_count :])
        return min(self.nearest_before, now, key=lambda near: near.distance_m)

    @cached_property
    def _points(self) -> list[Point]:
        """The way, a point every few centimetres."""
        points = [(self.seen_poses[0].x_m, self.seen_poses[0].y_m)]
        for pose in self.seen_poses:
            if math.dist(points[-1], (pose.x_m, pose.y_m)) >= _SPACING_M:
                points.append((pose.x_m, pose.y_m))
        return points

    @property
    def is_closed(self) -> bool:
        """The way ends where it began."""
        return math.dist(self._points[0], self._points[-1]) <= CLOSED_M

    def corner_count(self) -> int:
        """Count where the way changes its direction at once; where it ends as it began, that place, too."""
        points = self._points
        headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in itertools.pairwise(points)]
        count, place = 0, 0
        while place + 2 < len(headings):
            is_corner = abs(wrap_angle(headings[place + 2] - headings[place])) >= _CORNER_RAD
            count += is_corner
            place += 3 if is_corner else 1
        closes = len(headings) > 2 and self.is_closed
        return count + (closes and abs(wrap_angle(headings[0] - headings[-1])) >= _CORNER_RAD)

    def area_m2(self) -> float:
        """Return what the way encloses, if its end were joined to its beginning."""
        points = self._points
        return (
            abs(sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1]))) / 2.0
        )


Values = dict[str, Value | tuple[str, ...]]
"""What a finding tells in numbers and names; a tuple has the names of one thing in several languages."""
