"""Makes the sentence at the end of a turn: what was measured, and why it ended, in the language of the question."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from chatrobot.core.event import Proposal
from chatrobot.core.events import LEAST_M, LEAST_RAD, Event, Finished, Paused, Result
from chatrobot.core.geometry import Twist, wrap_angle
from chatrobot.core.reason import Reason, fixed, one_line
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import describe_plan, describe_steps, describe_text, render_reason, say
from chatrobot.plan.steps import Face, Go, RawTwist, Step
from chatrobot.plan.text import parse_plan
from chatrobot.reflex import is_release

if TYPE_CHECKING:
    from chatrobot.dialogue.llm.terms import Ended


SHOWN_CHARS = 60
"""A text that is quoted is shortened to this."""
_COMMAND = re.compile(r"/[a-z][a-z-]*\b(?!/)", re.IGNORECASE)

_WAITED = ("canceled", "order_changed")
"""Why an order that waited is not done, while what runs goes on."""
_STOPPED_TWICE = re.compile(r"([.?!。？！])[.。]")
"""A reason that is a sentence of its own has its full stop, or its question mark, already."""


def describe_end(finished: Finished, language: str, steps: Sequence[Step] = ()) -> str:
    """Return what a plan of those steps came to: outcome, measured motion, and the reason if it did not complete."""
    if not finished.measured and finished.outcome != "refused":
        return _ended_once(_commanded(finished, language, steps))
    moved = _measured(finished, language)
    if finished.outcome == "completed":
        done = say(language, "done", moved=moved) if moved else _done_standing(steps, language)
        heading, slowed = _heading_there(finished, steps, language), _slowed(finished, language)
        return " ".join(filter(None, (done, heading, slowed)))
    reason = _why(finished.reason, language)
    if not moved and finished.reason is not None and finished.reason.code in _WAITED:
        return say(language, "not_begun", reason=reason)
    if finished.outcome == "refused":
        refused = " ".join(filter(None, (reason, _free(finished.reason, language))))
        has_moved = moved and finished.path_m
        return say(language, "model_so_far", reason=refused, moved=moved) if has_moved else refused
    code = "stopped_after" if finished.outcome == "stopped" else "failed_after"
    if finished.outcome == "failed" and finished.reason is not None and finished.reason.code == "wire_gone":
        code = "failed_unreached"  # it was told to stop, and cannot have heard that
    return _ended_once(say(language, code, moved=moved or say(language, "nothing_moved"), reason=reason))


def _slowed(finished: Finished, language: str) -> str:
    """That it was slowed because the machine was too busy."""
    return say(language, "was_slowed", late_s=finished.late_s) if finished.late_s else ""


def _commanded(finished: Finished, language: str, steps: Sequence[Step]) -> str:
    """The end of a turn of a robot that measures nothing: what it was sent, never what it did."""
    if finished.outcome != "completed":
        return _stop_sent(finished, _why(finished.reason, language), language)
    if not finished.duration_s:
        return say(language, "done_standing")
    # A raw twist may have been scaled.
    is_known = steps and not any(isinstance(step, RawTwist) for step in steps)
    plan = describe_steps(steps, language) if is_known else _velocities(finished, language)
    return say(language, "commanded", plan=plan)


def _stop_sent(finished: Finished, reason: str, language: str) -> str:
    if not finished.duration_s:
        return say(language, "nothing_commanded", reason=reason)
    return say(language, "stop_unconfirmed", reason=reason, plan=_velocities(finished, language))


def _velocities(finished: Finished, language: str) -> str:
    """How long it was told to move, and how far that would be: all that is known where nothing is measured."""
    way = {"of_m": finished.planned_m, "of_deg": math.degrees(finished.planned_turn_rad)}
    return say(language, "commanded_velocities", duration_s=finished.duration_s, **way)


def _done_standing(steps: Sequence[Step], language: str) -> str:
    """It stood already where it was to go, or as it was to look; else it had something to do that moves nothing."""
    only = steps[0] if len(steps) == 1 else None
    if isinstance(only, Go):
        return say(language, "there_already" if only.place else "there_already_unnamed", place=only.place)
    return say(language, "already_facing" if isinstance(only, Face) else "done_standing")


def describe_left(paused: Paused, language: str) -> str:
    """Return what is left of a paused plan in a few words, and the texts that wait behind it."""
    plan = describe_text(paused.plan_text, language)
    if not paused.waiting:
        return plan
    return say(language, "left_and_waiting", plan=plan, texts=describe_waiting(paused.waiting, language))


def describe_waiting(texts: Sequence[str], language: str) -> str:
    """Return texts that wait, in quotation marks."""
    shown = (say(language, "quoted", text=one_line(text, SHOWN_CHARS)) for text in texts)
    return say(language, "list_comma").join(shown)


def with_offer(reply: str, finished: Finished | None, language: str) -> tuple[str, Proposal | None]:
    """Return the reply with the question whether to do what is possible of a refused plan, and what it offers."""
    proposal = offered(finished, language) if finished is not None else None
    return (f"{reply} {proposal.say}", proposal) if proposal is not None else (reply, None)


def _heading_there(finished: Finished, steps: Sequence[Step], language: str) -> str:
    """How it looks at a place that it was to face the heading of: measured, beside what was asked."""
    last = steps[-1] if steps else None
    if not (isinstance(last, Go) and last.place and last.yaw_rad is not None and finished.measured):
        return ""
    degrees = (fixed(math.degrees(wrap_angle(yaw)), 0) for yaw in (finished.pose.yaw_rad, last.yaw_rad))
    deg, asked_deg = ("180" if each == "-180" else each for each in degrees)
    return say(language, "at_heading", deg=deg, place=last.place, asked_deg=asked_deg)


def offered(finished: Finished, language: str) -> Proposal | None:
    """Return the question whether to do what is possible of a plan that was refused."""
    if not finished.possible:
        return None
    text = describe_plan(parse_plan(finished.possible), language)
    values = finished.reason.values if finished.reason is not None else {}
    limits = [say(language, code, **values) for code in ("limit_m", "limit_s") if code in values]
    return Proposal(finished.possible, " ".join([*limits, say(language, "offer", text=text)]))


def _why(reason: Reason | None, language: str) -> str:
    return render_reason(reason, language) if reason is not None else ""


def _free(reason: Reason | None, language: str) -> str:
    """How far a way is free that is blocked."""
    for code in ("free_m", "free_deg", "short_m"):
        if reason is not None and code in reason.values:
            return say(language, code, **reason.values)
    return ""


def _ended_once(sentences: str) -> str:
    return _STOPPED_TWICE.sub(r"\1", sentences)


def describe_model_end(ended: Ended, language: str) -> str:
    """Return what a turn that a model planned came to."""
    finished, reason = ended.finished, ended.reason
    if ended.outcome == "answered":
        return ended.said or say(language, "done_standing")
    if ended.outcome == "completed":
        return describe_end(finished, language, ended.steps) if finished else say(language, "done_standing")
    why = _why(reason, language)
    if ended.outcome == "refused":
        why = " ".join(filter(None, (why, _free(reason, language))))
    moved = _measured(finished, language) if finished is not None else ""
    if ended.outcome == "stopped" and finished is not None and not finished.measured:
        return _ended_once(_stop_sent(finished, why, language))
    if ended.outcome == "stopped":
        return say(language, "stopped_after", moved=moved or say(language, "nothing_moved"), reason=why)
    if ended.outcome == "failed" and finished is not None and finished.outcome == "failed":
        return describe_end(finished, language)
    if ended.outcome == "unclear":
        why = say(language, "model_no_plan", problem=why, said=ended.said)
    return _ended_once(say(language, "model_so_far", reason=why, moved=moved)) if moved else why


def _measured(finished: Finished, language: str) -> str:
    if not finished.measured:
        plan = _velocities(finished, language) if finished.duration_s else ""
        return say(language, "commanded_so_far", plan=plan) if plan else ""
    parts = []
    if finished.planned_m > LEAST_M or (finished.open_ended and finished.path_m > LEAST_M):
        code = "drove_open" if finished.open_ended else "drove"
        parts.append(say(language, code, drove_m=f"{finished.path_m:.2f}", of_m=f"{finished.planned_m:.2f}"))
    if abs(finished.planned_turn_rad) > LEAST_RAD or abs(finished.turned_rad) > math.radians(3.0):
        parts.append(_turned(math.degrees(finished.turned_rad), language))
    return say(language, "list_comma").join(parts)


def _turned(turned_deg: float, language: str) -> str:
    shown = fixed(turned_deg, 1)
    code = "turned" if not float(shown) else "turned_left" if turned_deg > 0.0 else "turned_right"
    return say(language, code, turned_deg=shown.lstrip("-"))


_LEAST_MPS = 0.005
"""A slower velocity is told as none."""


def describe_twist(twist: Twist, say: Callable[..., str]) -> str:
    """Return how fast it goes and turns, in the words `speed` and `rate` of a face."""
    parts = []
    if twist.speed_mps >= _LEAST_MPS:
        parts.append(say("speed", speed=f"{twist.speed_mps:.2f}"))
    rate = fixed(math.degrees(twist.wz_radps), 0)
    if float(rate):
        parts.append(say("rate", rate=rate))
    return " · ".join(parts) or say("speed", speed="0")


PARTING = "parting"
"""The code of such an interpretation, and of the reason in its result."""
AFTER_GOODBYE = "dropped_by_goodbye"
"""The code of what was said after it."""


def parting(meant: Interpretation) -> Reason | None:
    """Return the reason of a result that ends the conversation; None for any other."""
    return Reason(PARTING) if meant.code == PARTING else None


def is_parting(event: Event) -> bool:
    """Return whether the person has said goodbye, and has been answered."""
    return isinstance(event, Result) and event.reason is not None and event.reason.code == PARTING


def told_at_console(text: str) -> str:
    """Return the phrase that answers what is typed at the terminal console, "" for anything else."""
    if is_release(text):
        return "release_by_command"
    return "command_of_console" if _COMMAND.match(text) else ""
