"""What the server puts into words for a page, in its language: the reasons in events, and why something is refused."""

from __future__ import annotations

import re
from functools import partial
from typing import Any

from chatrobot.core import events
from chatrobot.core.events import Event
from chatrobot.core.reason import fixed
from chatrobot.dialogue.replies import describe_end, describe_left, describe_twist
from chatrobot.language.data_files import filled, load_table
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.phrases import render_reason, say
from chatrobot.reflex import is_release, leads_with_stop
from chatrobot.web.outbox import Message

DROPPABLE = frozenset({"telemetry", "scan"})
"""The next event of that kind says all that this one does."""
PASSING = DROPPABLE | {"progress", "pose", "limited", "obstacle_changed"}
"""What a page that comes later needs not be told."""
_COMMAND = re.compile(r"/[a-z][a-z-]*\b(?!/)", re.IGNORECASE)
UNTOLD = frozenset({"finished"})
"""`result` says the same. An agent's turn has no other end here."""


def web_words(language: LanguageCode, code: str, **values: object) -> str:
    """Return the web console's words of that code, or those that it has in common with the console at a terminal."""
    own = load_table(language, "web")
    words = own[code] if code in own else load_table(language, "console")[code]
    return filled(str(words), language, values)


def told(kind: str, **values: Any) -> Message:
    """Make a message that is the same in every language."""
    return Message(lambda _: {"is": kind, **values})


def noted(code: str, **values: object) -> Message:
    """Make the message of a line in the chat that belongs to no turn."""
    return Message(lambda language: {"is": "note", "text": web_words(language, code, **values)})


def refused(why: str, do: str = "", **values: object) -> Message:
    """Make the message that something was not done: `why` is a code that stays, `do` what was asked."""
    return Message(
        lambda language: {"is": "refused", "why": why, "do": do, "text": web_words(language, why, **values)}
    )


def command_message(text: str) -> Message | None:
    """Return what does at a page what a command of the terminal does; None for what stops, releases or is none."""
    found = _COMMAND.match(text.strip())
    if found is None or leads_with_stop(text) or is_release(text):
        return None
    code = "obstacle_at_page" if found[0].casefold() == "/obstacle" else "command_at_page"
    return noted(code, command=found[0])


def event_message(event: Event) -> Message:
    """Make the message that tells an event. Its `text` is for people, where the event itself has only a code."""
    data = event.to_json()
    if event.name == "scan":
        scan = {key: value for key, value in data.items() if key not in ("event", "turn")}
        return Message(lambda _: {"is": "scan", **scan}, is_droppable=True)

    def make(language: LanguageCode) -> dict[str, Any]:
        text = _text(event, language)
        return {"is": "event", "event": data, **({"text": text} if text is not None else {})}

    return Message(make, is_droppable=event.name in DROPPABLE)


def _text(event: Event, language: LanguageCode) -> str | list[str] | None:
    """A sentence; for what has findings, one for each."""
    if isinstance(event, events.Notice):
        return event.text or render_reason(event.reason, language)
    if isinstance(event, events.FindingSeen):
        return render_reason(event.reason, language)
    if isinstance(event, events.Rehearsed):
        return [render_reason(finding.reason, language) for finding in event.findings]
    if isinstance(event, events.ProgramWritten):
        return [render_reason(mark.reason, language) for mark in event.marks]
    if isinstance(event, events.ProgramRehearsed):
        values = {"speed": f"{event.top_speed_mps:.2f}", "rate": f"{event.top_rate_radps:.2f}"}
        return say(language, "program_speeds", **values)
    if isinstance(event, events.Paused):
        return say(language, "paused_now", plan=describe_left(event, language))
    if isinstance(event, events.Ordered):
        source = load_table(language, "causes")["sources"].get(event.source, event.source)
        code = "program_asked_by" if event.program else "asked_by"
        return web_words(language, code, source=source, program=event.program)
    if isinstance(event, events.Limited):
        return _limited(event, language)
    if isinstance(event, events.Remembered):
        place = f"({fixed(event.pose.x_m, 2)}, {fixed(event.pose.y_m, 2)})"
        return web_words(language, "remembered", place=event.place, pose=place)
    if isinstance(event, events.Finished):
        return describe_end(event, language)
    return event.reply if isinstance(event, events.Result) else None


def _limited(event: events.Limited, language: LanguageCode) -> str:
    asked, sent = (describe_twist(twist, partial(web_words, language)) for twist in (event.asked, event.sent))
    text = web_words(language, "limited_to", asked=asked, sent=sent)
    return f"{text} ({render_reason(event.reason, language)})" if event.reason is not None else text
