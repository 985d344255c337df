"""What happened, a row each: words, what was understood, verdicts, limits, programs, model calls, stops, results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from chatrobot.cli.console.words import Words
from chatrobot.cli.narrator import Narrator
from chatrobot.cli.report.drive import Drive
from chatrobot.core import events
from chatrobot.core.events import Event

MOST_ROWS = 4000
"""More of them would make a page that no phone opens; the recording has all."""
MOST_CHARS = 6000
"""Of one row, such as the source of a program."""
_SHOWN_LOGS = 200

_KINDS = {
    "ordered": "ordered", "interpreted": "understood", "program_written": "program", "program_rehearsed": "program",
    "limited": "limited", "model_called": "model", "paused": "paused", "said": "speech", "remembered": "remembered",
    "notice": "notice",
}  # fmt: skip
"""The kind of a row for each event that is told as it is."""


@dataclass
class Row:
    """One row. Numbers are None where there is nothing to tell; `more` is text that is shown on request."""

    t_s: float
    kind: str
    text: str
    turn: int = 0
    told_m: float | None = None
    measured_m: float | None = None
    duration_s: float | None = None
    token_count: int | None = None
    cost_usd: float | None = None
    more: str = ""


class Timeline:
    """Makes the rows of a drive, in the language of its report."""

    def __init__(self, drive: Drive, say: Callable[..., str]) -> None:
        self._drive, self._say = drive, say
        self._narrator = Narrator(Words(drive.language), plain=True)
        self._logs: dict[int, Row] = {}
        self._log_counts: dict[int, int] = {}
        self._limits = {id(event): count for _, event, count in drive.limited}

    def rows(self) -> list[Row]:
        """Return every row, in the order of time."""
        rows = [Row(t_s, "heard", text[:MOST_CHARS], turn) for t_s, turn, text in self._drive.heard]
        for t_s, event in self._drive.events:
            rows += self._rows_of(t_s, event)
        rows += [self._result(t_s, result) for t_s, result in self._drive.results]
        return sorted(rows, key=lambda row: (row.t_s, row.turn))

    def _rows_of(self, t_s: float, event: Event) -> Iterator[Row]:
        text = "\n".join(line.text for line in self._narrator.tell(event))
        if isinstance(event, events.Rehearsed):
            yield self._verdict(t_s, event, text)
        elif isinstance(event, (events.Result, events.Finished)):
            return  # the drive has the ends, of agents' turns, too
        elif isinstance(event, events.ModelCalled):
            yield self._model(t_s, event)
        elif isinstance(event, events.ProgramLog):
            yield from self._log(t_s, event)
        elif isinstance(event, events.Limited):
            if (count := self._limits.get(id(event), 0)) > 1:
                text = self._say("listed", name=text, count=count)
            if count:
                yield Row(t_s, "limited", text, event.turn)
        elif event.name in _KINDS and text:
            yield _row(t_s, _KINDS[event.name], text, event.turn)

    def _verdict(self, t_s: float, event: events.Rehearsed, text: str) -> Row:
        was_driven = event.turn in self._drive.driven_turns
        kind = (
            "refused" if not event.ok else "approved" if was_driven or not event.needs_approval else "asked"
        )
        return Row(t_s, kind, text, event.turn, event.length_m or None, None, event.duration_s or None)

    @staticmethod
    def _result(t_s: float, event: events.Result) -> Row:
        measured_m = event.path_m if event.has_moved else None
        return Row(
            t_s,
            event.outcome,
            event.reply[:MOST_CHARS],
            event.turn,
            None,
            measured_m,
            event.duration_s or None,
        )

    def _model(self, t_s: float, event: events.ModelCalled) -> Row:
        values = {"prompt": event.prompt_tokens, "reply": event.reply_tokens}
        text = self._say("model_call", model=event.model, round=event.round, **values)
        text = text if event.counted else f"{text} {self._say('estimated')}"
        return Row(
            t_s, "model", text, event.turn, duration_s=event.duration_s,
            token_count=event.prompt_tokens + event.reply_tokens, cost_usd=event.cost_usd,
        )  # fmt: skip

    def _log(self, t_s: float, event: events.ProgramLog) -> Iterator[Row]:
        """Give one row for all that the program of a turn logged; the rest of it is shown on request."""
        count = self._log_counts[event.turn] = self._log_counts.get(event.turn, 0) + 1
        row = self._logs.get(event.turn)
        if row is None:
            row = self._logs[event.turn] = Row(t_s, "log", event.text[:MOST_CHARS], event.turn)
            yield row
        elif count <= _SHOWN_LOGS and len(row.more) < MOST_CHARS:
            row.more += f"{event.t_s:.2f} s  {event.text[:MOST_CHARS]}\n"


def _row(t_s: float, kind: str, text: str, turn: int) -> Row:
    """Make a row of a text; of a long one its first line, and the rest on request."""
    lines = text[:MOST_CHARS].splitlines()
    if len(lines) <= _SHOWN_LINES:
        return Row(t_s, kind, "\n".join(lines), turn)
    return Row(t_s, kind, lines[0], turn, more="\n".join(lines[1:]))


_SHOWN_LINES = 8
