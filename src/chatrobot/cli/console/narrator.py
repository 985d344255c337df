"""Events in words and colours: what the console prints about a turn."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.console.lines import indented, marked
from chatrobot.cli.console.words import Words
from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.core.geometry import Twist
from chatrobot.core.reason import fixed
from chatrobot.dialogue.programs.draft import body, headline
from chatrobot.dialogue.replies import describe_left
from chatrobot.language.phrases import render_reason, say
from chatrobot.plan.shown import folded_plan, shown_plan

PLAN_LINES = 16
"""A longer plan is shown in part; `/plan` shows it whole."""

_MARKS: dict[events.Outcome, tuple[str, str]] = {
    "completed": ("✓", "green"),
    "answered": ("•", "cyan"),
    "unclear": ("?", "yellow"),
    "refused": ("✗", "red"),
    "stopped": ("■", "yellow"),
    "failed": ("✗", "bold red"),
}
_FINDINGS = {"refuse": ("✗", "red"), "warn": ("!", "yellow"), "note": ("·", "dim")}
_LEAST_MPS = 0.005


class Narrator:
    """Turns events into lines of `Text`. Keeps only the plan text between understanding and rehearsal."""

    def __init__(self, words: Words) -> None:
        self._words = words
        self._plans: dict[int, str] = {}
        self._streamed: dict[int, int] = {}
        self._programs: set[int] = set()
        self._handlers: dict[type[Event], Callable[[Any], Iterator[RenderableType]]] = {
            events.Streamed: self._streamed_step,
            events.Interpreted: self._interpreted,
            events.Ordered: self._ordered,
            events.Rehearsed: self._rehearsed,
            events.ProgramWritten: self._program_written,
            events.ProgramRehearsed: self._program_rehearsed,
            events.ProgramLog: lambda event: iter((indented(Text(f"| {event.text}", "dim")),)),
            events.Limited: self._limited,
            events.Said: lambda event: iter((marked("»", "magenta", Text(event.text, "bold")),)),
            events.Remembered: self._remembered,
            events.Paused: self._paused,
            events.Notice: self._notice,
            events.Result: self._result,
        }

    def tell(self, event: Event) -> Iterator[RenderableType]:
        """Give the lines to print for `event`; none for most."""
        handle = self._handlers.get(type(event))
        return handle(event) if handle is not None else iter(())

    def plan(
        self, plan_text: str, rehearsed: events.Rehearsed | None, line_count: int | None = None
    ) -> Iterator[RenderableType]:
        """Give a plan's numbered lines under its predicted length and duration, and what rehearsal found."""
        head = Text("  ").append(self._words.say("plan"), "bold")
        if rehearsed is not None and rehearsed.ok:
            head.append(f"  {self._facts(rehearsed)}", "dim")
        yield head
        lines = folded_plan(plan_text)
        shown = lines if line_count is None or len(lines) <= line_count else lines[: line_count - 1]
        for number, line in shown:
            yield Text("  ").append(f"{number:>3}  ", "dim").append_text(_plan_line(line))
        if len(shown) < len(lines):
            yield Text("       ").append(self._words.say("plan_more", count=len(lines) - len(shown)), "dim")
        yield from self._findings(rehearsed)

    def _facts(self, rehearsed: events.Rehearsed) -> str:
        length, duration = f"{rehearsed.length_m:.2f}", f"{rehearsed.duration_s:.1f}"
        return self._words.say("plan_facts", length=length, duration=duration)

    def _findings(self, rehearsed: events.Rehearsed | None) -> Iterator[RenderableType]:
        """All but the first refusal: that one is the turn's result."""
        refusals = 0
        for finding in rehearsed.findings if rehearsed is not None else ():
            refusals += finding.severity == "refuse"
            if finding.severity != "refuse" or refusals > 1:
                yield self.finding(finding)

    def finding(self, finding: events.FindingSeen) -> RenderableType:
        """Put one thing that rehearsal found into words."""
        mark, style = _FINDINGS[finding.severity]
        return marked(mark, style, render_reason(finding.reason, self._words.language))

    # --- one method an event ---

    def _interpreted(self, event: events.Interpreted) -> Iterator[RenderableType]:
        if event.plan_text and event.turn not in self._streamed:
            self._plans[event.turn] = event.plan_text
            if event.reply and (
                event.by == "model" or self._words.language != "en"
            ):  # a plan is English already
                yield indented(Text(event.reply, "cyan"))

    def _ordered(self, event: events.Ordered) -> Iterator[RenderableType]:
        if event.plan_text:
            self._plans[event.turn] = event.plan_text
        values = {"source": event.source, "program": event.program}
        yield marked(
            "!", "cyan", self._words.say("asked_by" if event.plan_text else "program_asked_by", **values)
        )

    def _rehearsed(self, event: events.Rehearsed) -> Iterator[RenderableType]:
        plan_text = self._plans.pop(event.turn, None)
        if plan_text is not None:
            yield from self.plan(plan_text, event, PLAN_LINES)
        elif event.turn in self._streamed:
            yield from self._findings(event)
        elif event.turn in self._programs:
            self._programs.discard(event.turn)
            yield indented(Text(self._facts(event), "dim"))
            yield from self._findings(event)

    def _streamed_step(self, event: events.Streamed) -> Iterator[RenderableType]:
        """Give a step of a plan that is still coming in."""
        if event.turn not in self._streamed:
            yield Text("  ").append(self._words.say("plan"), "bold")
        for line in shown_plan(event.plan_text).splitlines():
            number = self._streamed[event.turn] = self._streamed.get(event.turn, 0) + 1
            yield Text("  ").append(f"{number:>3}  ", "dim").append_text(_plan_line(line))

    def _program_written(self, event: events.ProgramWritten) -> Iterator[RenderableType]:
        self._programs.add(event.turn)
        language = self._words.language
        yield indented(Text(headline(event, language), "bold"))
        yield from (Text(line) for line in body(event, language))

    def _program_rehearsed(self, event: events.ProgramRehearsed) -> Iterator[RenderableType]:
        values = {"speed": f"{event.top_speed_mps:.2f}", "rate": f"{event.top_rate_radps:.2f}"}
        yield indented(Text(say(self._words.language, "program_speeds", **values), "dim"))
        yield from (indented(Text(line, "red")) for line in event.problem.splitlines())

    def _limited(self, event: events.Limited) -> Iterator[RenderableType]:
        asked, sent = self._twist(event.asked), self._twist(event.sent)
        yield marked("!", "yellow", self._words.say("limited_to", asked=asked, sent=sent))

    def _remembered(self, event: events.Remembered) -> Iterator[RenderableType]:
        words = self._words.say("remembered", place=event.place, pose=self._words.pose(event.pose))
        yield marked("·", "cyan", words)

    def _paused(self, event: events.Paused) -> Iterator[RenderableType]:
        language = self._words.language
        yield marked("‖", "yellow", say(language, "paused_now", plan=describe_left(event, language)))

    def _notice(self, event: events.Notice) -> Iterator[RenderableType]:
        yield marked("!", "yellow", event.text or render_reason(event.reason, self._words.language))

    def _result(self, event: events.Result) -> Iterator[RenderableType]:
        self._plans.pop(event.turn, None)
        self._streamed.pop(event.turn, None)
        mark, style = _MARKS[event.outcome]
        asks = f" {say(self._words.language, 'yes_or_no')}" if event.proposal is not None else ""
        yield marked(mark, style, f"{event.reply}{asks}")
        if event.has_moved:
            pose, duration = self._words.pose(event.pose), f"{event.duration_s:.1f}"
            yield marked("", "", Text(self._words.say("measured", pose=pose, duration=duration), "dim"))

    def _twist(self, twist: Twist) -> str:
        parts = []
        if twist.speed_mps >= _LEAST_MPS:
            parts.append(self._words.say("speed", speed=f"{twist.speed_mps:.2f}"))
        rate = fixed(math.degrees(twist.wz_radps), 0)
        if float(rate):
            parts.append(self._words.say("rate", rate=rate))
        return " · ".join(parts) or self._words.say("speed", speed="0")


_VERB = re.compile(r"^ *(?:\d+ × \(?)*([a-z_]+)")


def _plan_line(line: str) -> Text:
    """Put the first verb in bold, so that a plan reads at a glance."""
    text = Text(line)
    if verb := _VERB.match(line):
        text.stylize("bold cyan", *verb.span(1))
    return text
