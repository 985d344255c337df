"""Motion's events as lines of a log: the sentences that the console says, with a severity."""

from __future__ import annotations

from typing import NamedTuple

from chatrobot.core.events import RELEASED, Event, Finished, Notice, ProgramLog, Started
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import describe_end
from chatrobot.language.phrases import render_reason, say
from chatrobot.nodes.log import Severity

_GOOD_NEWS = frozenset(
    {"alone_again", "wire_back", "sensor_found", "cmd_vel_type_found", "odom_type_found", *RELEASED}
)
"""Notices that ask nobody to do anything."""
_ORDERED = frozenset({"stopped_by", "paused_by", "replaced", "handed_over", "overtaken"})
"""Ends that somebody has asked for."""


class Line(NamedTuple):
    """One line of a log."""

    severity: Severity
    text: str


def told(event: Event, language: str = "en") -> Line | None:
    """Return the line for that event; None for what a log does without."""
    if isinstance(event, Started) and event.turn:
        return Line("info", say(language, "log_started", turn=event.turn))
    if isinstance(event, Finished):
        text = _sentence(describe_end(event, language))
        if event.turn:  # else it is what others said on chatgpt_node
            text = say(language, "log_turn", turn=event.turn, text=text)
        return Line(_severity_of_end(event), text)
    if isinstance(event, Notice):
        return Line(severity_of(event.reason), _sentence(event.text or render_reason(event.reason, language)))
    if isinstance(event, ProgramLog):
        return Line(_severity_of_program(event.level), event.text)
    return None


def severity_of(reason: Reason) -> Severity:
    """Return the severity of a notice."""
    return "info" if reason.code in _GOOD_NEWS else "warn"


def _severity_of_end(event: Finished) -> Severity:
    if event.outcome == "failed":
        return "error"
    is_ordered = event.reason is not None and event.reason.code in _ORDERED
    return "info" if event.outcome in ("completed", "answered") or is_ordered else "warn"


def _severity_of_program(level: str) -> Severity:
    level = level.casefold()
    return "error" if level in ("error", "fatal") else "warn" if level.startswith("warn") else "info"


def _sentence(text: str) -> str:
    """Complete a reason that begins small: it is half a sentence, for others to stand around it."""
    if not text[:1].islower():
        return text
    return f"{text[0].upper()}{text[1:]}{'' if text.endswith(('.', '?', '!')) else '.'}"
