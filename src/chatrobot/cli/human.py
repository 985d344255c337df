"""What a command prints for people: its events as lines, and how far a turn is while it runs."""

from __future__ import annotations

import math

from chatrobot.cli.console.words import Words
from chatrobot.cli.json_lines import Output
from chatrobot.cli.narrator import Narrator
from chatrobot.cli.status_line import StatusLine
from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import fixed, one_line, printable
from chatrobot.language.interpretation import LanguageCode


class HumanPrinter:
    """A `Printer` for people. Sentences come in the language of the question; the rest is numbers with units.

    `shows_pose`: the status line says where the robot is, in place of how far it is.
    """

    def __init__(self, output: Output, *, shows_pose: bool = False) -> None:
        self._output = output
        self._shows_pose = shows_pose
        self._words = Words()
        self._narrator = Narrator(self._words, plain=True)
        self._way = _Way()
        self._status = StatusLine()
        self._streamed = 0
        self._said: dict[int, str] = {}
        self._turn = self._headed = 0

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        return self._output.is_broken

    def turn(self, text: str) -> None:
        """Show what begins a turn."""
        self._line(f"> {text}")

    def note_said(self, turn: int, text: str) -> None:
        """Head the lines about that turn with its text, wherever they begin among those of others. From any thread."""
        self._said[turn] = one_line(text)

    def show(self, event: Event, language: LanguageCode) -> None:
        """Show an event, in the language of the question."""
        self._words.language = language
        self._turn = event.turn
        match event:
            case events.Streamed() if self._streamed != event.turn:
                self._streamed, self._way = event.turn, _Way()
            case events.Rehearsed():
                if event.turn != self._streamed:
                    self._way = _Way()
                self._way.planned_m += event.length_m
            case events.Started():
                self._way.start(event.pose)
            case events.Telemetry() if self._shows_pose:
                self._status.show(f"  {self._words.pose(event.pose)}  {event.twist.speed_mps:.2f} m/s")
            case events.Progress() if not self._shows_pose:
                self._status.show(f"  {self._way.advance(event)}")
            case events.TruePose():
                x, y, yaw = fixed(event.x_m, 3), fixed(event.y_m, 3), fixed(math.degrees(event.yaw_rad), 1)
                self._line(f"  {event.t_s:8.2f} s  x {x} m  y {y} m  {yaw}°")
        for line in self._narrator.tell(event):
            self._line(f"{line.lead}{line.text}")

    def clear(self) -> None:
        """Clear the status line."""
        self._status.clear()

    def _line(self, text: str) -> None:
        self.clear()
        if self._turn != self._headed and self._turn in self._said:
            self._headed = self._turn
            self._output.write(f"> {self._said[self._turn]}\n")
        self._output.write(f"{printable(text)}\n")


class _Way:
    """How far a running turn has come, by the robot's own account."""

    def __init__(self) -> None:
        self._last: Pose | None = None
        self._start_yaw_rad = 0.0
        self.planned_m = 0.0
        self._driven_m = 0.0

    def start(self, pose: Pose) -> None:
        """Begin to measure there, where the robot begins to move."""
        self._last, self._start_yaw_rad, self._driven_m = pose, pose.yaw_rad, 0.0

    def advance(self, event: events.Progress) -> str:
        """Take in where the robot is; how far, and which turn; of how much, and the share, where the whole is known."""
        if self._last is not None:
            self._driven_m += self._last.distance_to(event.pose)
        self._last = event.pose
        rounded = fixed(math.degrees(event.pose.yaw_rad - self._start_yaw_rad), 0)
        turned = f"{'+' if float(rounded) > 0 else ''}{rounded}°"
        if event.fraction is None:
            return f"{self._driven_m:.2f} m  {turned}"
        return f"{self._driven_m:.2f} / {self.planned_m:.2f} m  {turned}  {event.fraction:4.0%}"
