"""Events in words: what people read of a turn, in the console and as lines of a command."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from chatrobot.cli.console.words import Words
from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.dialogue.programs.draft import body, headline
from chatrobot.dialogue.replies import describe_left, describe_twist
from chatrobot.language.data_files import written
from chatrobot.language.phrases import describe_text, render_reason, say
from chatrobot.plan.shown import folded_plan

PLAN_LINES = 16
"""The console shows a longer plan in part; `/plan` shows it whole."""
PLAN_STYLE = "plan"
"""The style of a plan's line, whose first verb stands out."""

_MARKS: dict[events.Outcome, tuple[str, str]] = {
    "completed": ("✓", "green"),
    "answered": ("•", "cyan"),
    "unclear": ("?", "yellow"),
    "refused": ("✗", "red"),
    "stopped": ("■", "yellow"),
    "failed": ("✗", "bold red"),
}
_FINDINGS = {"refuse": ("✗", "red"), "warn": ("!", "yellow"), "note": ("·", "dim")}


class Line(NamedTuple):
    """`text` behind `lead`, under which its further lines hang. Styles are those of rich, or `PLAN_STYLE`."""

    text: str
    style: str = ""
    lead: str = "  "
    lead_style: str = ""


def _marked(mark: str, style: str, text: str, text_style: str = "") -> Line:
    """Put `text` behind a mark of one character."""
    return Line(text, text_style, f"  {mark:<2}", style)


class Narrator:
    """Turns events into lines. Keeps only what is told together: a plan until it is rehearsed.

    `plain` is the form of commands: the plan as it can be typed, replies without marks.
    """

    def __init__(self, words: Words, *, plain: bool = False) -> None:
        self._words = words
        self._plain = plain
        self._plans: dict[int, str] = {}
        self._streamed: dict[int, int] = {}
        self._programs: set[int] = set()

    def tell(self, event: Event) -> Iterator[Line]:
        """Give the lines to print for `event`; none for most."""
        language = self._words.language
        match event:
            case events.Streamed():
                yield from self._streamed_step(event)
            case events.Interpreted():
                yield from self._interpreted(event)
            case events.Ordered():
                yield from self._ordered(event)
            case events.Rehearsed():
                yield from self._rehearsed(event)
            case events.ProgramWritten():
                self._programs.add(event.turn)
                yield Line(headline(event, language), "bold", "" if self._plain else "  ")
                yield from (Line(line, lead="") for line in body(event, language))
            case events.ProgramRehearsed():
                values = {"speed": f"{event.top_speed_mps:.2f}", "rate": f"{event.top_rate_radps:.2f}"}
                yield self._predicted(say(language, "program_speeds", **values))
                yield from (Line(line, "red", self._indent) for line in event.problem.splitlines())
            case events.ProgramLog():
                yield Line(f"| {event.text}", "dim")
            case events.Limited() if event.turn:  # a hand at a stick, or another program, sees what it does
                asked, sent = (describe_twist(twist, self._words.say) for twist in (event.asked, event.sent))
                yield _marked("!", "yellow", self._words.say("limited_to", asked=asked, sent=sent))
            case events.Said():
                yield _marked("»", "magenta", event.text, "bold")
            case events.Remembered():
                pose = self._words.pose(event.pose)
                yield _marked("·", "cyan", self._words.say("remembered", place=event.place, pose=pose))
            case events.Paused() if not self._plain:  # there the reply says so
                yield _marked("‖", "yellow", say(language, "paused_now", plan=describe_left(event, language)))
            case events.Notice():
                mark = ("·", "dim") if event.reason.code == "recording" else ("!", "yellow")
                yield _marked(*mark, event.text or render_reason(event.reason, language))
            case events.Result():
                yield from self._result(event)

    def plan(
        self, plan_text: str, rehearsed: events.Rehearsed | None, line_count: int | None = None
    ) -> Iterator[Line]:
        """Give a plan's numbered lines under its predicted length and duration, and what rehearsal found."""
        facts = f"  {self._facts(rehearsed)}" if rehearsed is not None and rehearsed.ok else ""
        yield Line(facts, "dim", f"  {self._words.say('plan')}", "bold")
        lines = folded_plan(plan_text)
        shown = lines if line_count is None or len(lines) <= line_count else lines[: line_count - 1]
        yield from (self._step(number, line) for number, line in shown)
        if len(shown) < len(lines):
            more = self._words.say("plan_more", count=len(lines) - len(shown))
            yield Line(more, "dim", " " * 7)
        yield from self._findings(rehearsed)

    @property
    def _indent(self) -> str:
        return "    " if self._plain else "  "

    def _step(self, number: int, line: str) -> Line:
        return Line(line, PLAN_STYLE, self._indent if self._plain else f"  {number:>3}  ", "dim")

    def _predicted(self, text: str) -> Line:
        return Line(text, "dim", "  ≈ " if self._plain else "  ")

    def _facts(self, rehearsed: events.Rehearsed) -> str:
        figures = (f"{rehearsed.length_m:.2f}", f"{rehearsed.duration_s:.1f}")
        length, duration = (written(one, self._words.language) for one in figures)
        if self._plain:
            return f"{duration} s, {length} m"
        return self._words.say("plan_facts", length=length, duration=duration)

    def _findings(self, rehearsed: events.Rehearsed | None) -> Iterator[Line]:
        """All but the first refusal: that one is the turn's result."""
        refusals = 0
        for finding in rehearsed.findings if rehearsed is not None else ():
            refusals += finding.severity == "refuse"
            if finding.severity != "refuse" or refusals > 1:
                text = render_reason(finding.reason, self._words.language)
                yield _marked(*_FINDINGS[finding.severity], text)

    def _interpreted(self, event: events.Interpreted) -> Iterator[Line]:
        if not event.plan_text or event.turn in self._streamed:
            return  # the reply comes again with the result, and a plan that streamed in is there already
        is_told = event.by == "model" or self._words.language != "en"  # a plan is English already
        if event.reply and (self._plain or is_told or event.reply != describe_text(event.plan_text, "en")):
            yield Line(event.reply, "cyan", "" if self._plain else "  ")
        yield from self._take_plan(event.turn, event.plan_text)

    def _take_plan(self, turn: int, plan_text: str) -> Iterator[Line]:
        """Give a plan's lines at once in the plain form; the console shows them with what rehearsal says."""
        if self._plain:
            yield from (self._step(number, line) for number, line in folded_plan(plan_text))
        elif plan_text:
            self._plans[turn] = plan_text

    def _ordered(self, event: events.Ordered) -> Iterator[Line]:
        code = "program_asked_by" if event.program else "asked_by"
        yield _marked("!", "cyan", self._words.say(code, source=event.source, program=event.program))
        yield from self._take_plan(event.turn, event.plan_text)

    def _rehearsed(self, event: events.Rehearsed) -> Iterator[Line]:
        plan_text = self._plans.pop(event.turn, "")
        if plan_text:
            yield from self.plan(plan_text, event, PLAN_LINES)
            return
        if event.ok and (self._plain or event.turn in self._programs):
            yield self._predicted(self._facts(event))
        yield from self._findings(event)

    def _streamed_step(self, event: events.Streamed) -> Iterator[Line]:
        """Give a step of a plan that is still coming in."""
        if event.turn not in self._streamed and not self._plain:
            yield Line("", lead=f"  {self._words.say('plan')}", lead_style="bold")
        before = self._streamed.get(event.turn, 0)
        self._streamed[event.turn] = before + len(event.plan_text.splitlines())
        yield from (self._step(before + number, line) for number, line in folded_plan(event.plan_text))

    def _result(self, event: events.Result) -> Iterator[Line]:
        self._plans.pop(event.turn, None)
        self._streamed.pop(event.turn, None)
        self._programs.discard(event.turn)
        asks = f" {say(self._words.language, 'yes_or_no')}" if event.proposal is not None else ""
        reply = f"{event.reply}{asks}"
        if self._plain:
            yield Line(reply, lead="")
            return
        yield _marked(*_MARKS[event.outcome], reply)
        if event.has_moved and event.pose is not None:
            pose, duration = self._words.pose(event.pose), f"{event.duration_s:.1f}"
            yield _marked("", "", self._words.say("measured", pose=pose, duration=duration), "dim")
