"""Events for people: what was understood, what will happen, how far it is, what was measured."""

from __future__ import annotations

import math

from chatrobot.cli.json_lines import Output
from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import fixed
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.phrases import render_reason, say
from chatrobot.plan.shown import folded_plan

_CLEAR_LINE = "\r\x1b[K"
_MARKS = {"refuse": "✗", "warn": "!", "note": "·"}


class HumanPrinter:
    """A `Printer` for people. Sentences come in the language of the question; the rest is numbers with units."""

    def __init__(self, output: Output) -> None:
        self._output = output
        self._way = _Way()
        self._has_status = False
        self._streamed = 0

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        return self._output.is_broken

    def turn(self, text: str) -> None:
        """Show what begins a turn."""
        self._line(f"> {text}")

    def show(self, event: Event, language: LanguageCode) -> None:
        """Show an event, in the language of the question."""
        match event:
            case events.Streamed():
                if self._streamed != event.turn:
                    self._streamed, self._way = event.turn, _Way()
                self._show_plan(event.plan_text)
            case events.Interpreted():
                self._show_interpreted(event)
            case events.Rehearsed():
                self._show_rehearsed(event, language)
            case events.Started():
                self._way.start(event.pose)
            case events.Progress():
                self._show_progress(event)
            case events.ProgramWritten() | events.ProgramRehearsed():
                self._show_program(event, language)
            case _:
                if line := _line_of(event, language):
                    self._line(line)

    def _show_interpreted(self, event: events.Interpreted) -> None:
        if not event.plan_text or event.turn == self._streamed:
            return  # the reply comes again with the result, and a plan that streamed in is there already
        if event.reply:
            self._line(event.reply)
        self._show_plan(event.plan_text)

    def _show_plan(self, plan_text: str) -> None:
        for line in folded_plan(plan_text):
            self._line(f"    {line.text}")

    def _show_rehearsed(self, event: events.Rehearsed, language: LanguageCode) -> None:
        if event.turn == self._streamed:
            self._way.planned_m += event.length_m
        else:
            self._way = _Way(planned_m=event.length_m)
        if event.ok:
            self._line(f"  ≈ {event.duration_s:.1f} s, {event.length_m:.2f} m")
        for finding in event.findings:
            if finding.severity != "refuse":  # that one is the reply
                self._line(f"  {_MARKS[finding.severity]} {render_reason(finding.reason, language)}")

    def _show_progress(self, event: events.Progress) -> None:
        metres = self._way.advance(event.pose)
        status = f"  {self._way.text(event.fraction)}"
        if self._output.is_terminal:
            self._output.write(f"{_CLEAR_LINE}{status}")
            self._has_status = True
        elif metres:
            self._line(status)

    def _show_program(
        self, event: events.ProgramWritten | events.ProgramRehearsed, language: LanguageCode
    ) -> None:
        from chatrobot.dialogue.programs.draft import body, headline

        if isinstance(event, events.ProgramWritten):
            lines = [headline(event, language), *body(event, language)]
        else:
            values = {"speed": f"{event.top_speed_mps:.2f}", "rate": f"{event.top_rate_radps:.2f}"}
            lines = [f"  ≈ {say(language, 'program_speeds', **values)}"]
            lines += [f"    {line}" for line in event.problem.splitlines()]
        for line in lines:
            self._line(line)

    def _line(self, text: str) -> None:
        clear = _CLEAR_LINE if self._has_status else ""
        self._has_status = False
        self._output.write(f"{clear}{text}\n")


def _line_of(event: Event, language: LanguageCode) -> str:
    """Put an event into one line; "" for one that people do without."""
    match event:
        case events.Result():
            return (
                f"{event.reply} {say(language, 'yes_or_no')}" if event.proposal is not None else event.reply
            )
        case events.Ordered():
            return f"  {event.source}: {event.program or event.plan_text}"
        case events.Said():
            return f"  “{event.text}”"
        case events.Remembered():
            return f"  {event.place}: x {fixed(event.pose.x_m, 2)} m, y {fixed(event.pose.y_m, 2)} m"
        case events.Limited():
            return f"  · {_twist(event.asked)} → {_twist(event.sent)}"
        case events.Notice():
            return f"  ! {event.text or render_reason(event.reason, language)}"
        case events.ProgramLog():
            return f"  | {event.text}"
        case events.TruePose():
            x, y, yaw = fixed(event.x_m, 3), fixed(event.y_m, 3), fixed(math.degrees(event.yaw_rad), 1)
            return f"  {event.t_s:8.2f} s  x {x} m  y {y} m  {yaw}°"
    return ""


class _Way:
    """How far a running turn has come, by the robot's own account."""

    def __init__(self, start: Pose | None = None, planned_m: float = 0.0) -> None:
        self._last = start
        self._start_yaw_rad = start.yaw_rad if start is not None else 0.0
        self.planned_m = planned_m
        self._driven_m = 0.0

    def start(self, pose: Pose) -> None:
        """Begin to measure there, where the robot begins to move."""
        self._last, self._start_yaw_rad, self._driven_m = pose, pose.yaw_rad, 0.0

    def advance(self, pose: Pose) -> bool:
        """Take in where the robot is now; True when another whole metre lies behind it."""
        before_m = self._driven_m
        if self._last is not None:
            self._driven_m += self._last.distance_to(pose)
        self._last = pose
        return math.floor(self._driven_m) > math.floor(before_m)

    def text(self, fraction: float | None) -> str:
        """Say how far, and which turn; of how much, and the share, where the whole is known."""
        turned_deg = math.degrees(self._last.yaw_rad - self._start_yaw_rad) if self._last is not None else 0.0
        rounded = fixed(turned_deg, 0)
        turned = f"{'+' if float(rounded) > 0 else ''}{rounded}°"
        if fraction is None:
            return f"{self._driven_m:.2f} m  {turned}"
        return f"{self._driven_m:.2f} / {self.planned_m:.2f} m  {turned}  {fraction:4.0%}"


def _twist(twist: Twist) -> str:
    speed, rate = f"{twist.speed_mps:.2f} m/s", fixed(twist.wz_radps, 2)
    return f"{speed}, {rate} rad/s" if float(rate) else speed
