"""What an agent is told of an instruction: what was measured, as structured content, and the same in a few words.

Hints are for the agent, in English: what a reply says to a person does not say what an agent should do about it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from mcp_types import CallToolResult, ContentBlock, TextContent

from chatrobot.core.event import finite
from chatrobot.core.events import ProgramWritten, Rehearsed, Result
from chatrobot.core.geometry import Pose, wrap_angle
from chatrobot.core.reason import Reason, fixed
from chatrobot.language.phrases import render_reason
from chatrobot.link.motion_link import LAPSES_AFTER_S
from chatrobot.mcp_server.calls import Course
from chatrobot.mcp_server.robot import SOURCE
from chatrobot.plan.shown import shown_plan

_PERSON_STOPPED = (
    "A person stopped the robot, and that has priority. Do not move it again unless the person asks you to."
)
_BUDGET = (
    "All your instructions share one motion budget. A person gives more: by a yes to a plan, or by starting this "
    "server with --max-distance and --max-time."
)
_HINTS: Mapping[str, str] = {
    "emergency_stop": (
        "The emergency stop is set, and nothing moves before a person releases it: at the robot's web page "
        "(`chatrobot web`) or console, or by restarting this server where it has none. You cannot; tell them."
    ),
    "outranked": "A person, or another program, is driving. Wait, and use observe.",
    "handed_over": "A person has taken over. Do not move the robot unless they ask you to.",
    "over_shared_distance": _BUDGET,
    "over_shared_time": _BUDGET,
    "max_distance_reached": _BUDGET,
    "max_time_reached": _BUDGET,
    "approval_too_late": "Nobody said yes in time. Ask the person before you try again.",
}
"""What to do about the reason of an end."""
MOST_LOG, MOST_FAULT_CHARS, MOST_SHOWN_CHARS = 20, 1500, 300
NO_PERSON = (
    "This robot moves only after a person's yes, and there is nobody to ask here. Ask the person to run "
    "`chatrobot web` with this robot and let this server attach to it, or to start this server with --yes."
)
UNCLEAR = (
    "Say it in other words, or give `plan` instead: one step a line, such as `drive 1 m`, `turn left 90 deg` (the "
    "prompt plan_language has all of them). The tool places has the names of places."
)
UNCLEAR_PLAN = (
    "Nothing was done. Mend that line and send the whole plan again; the prompt plan_language has all steps."
)
UNCLEAR_PROGRAM = "Write it yourself: give the whole Python program as `text`."
_DROPPED = (
    "Not begun: what was asked for before it was stopped or not done. Look with observe, then ask again."
)
_BUSY = "Not taken: too many instructions wait already. Wait for their ends."


def answer(text: str, data: Mapping[str, Any], *more: ContentBlock, is_error: bool = False) -> CallToolResult:
    """Make a tool's result of a short text and the same as data."""
    content: list[ContentBlock] = [TextContent(type="text", text=text), *more]
    return CallToolResult(content=content, structured_content=finite(dict(data)), is_error=is_error)


def release_refused(*, is_set: bool) -> CallToolResult:
    """Answer an agent that wants to release an emergency stop; `is_set` as far as is known."""
    state = _HINTS["emergency_stop"] if is_set else "None is known to be set: use instruct."
    text = f"Only a person may release an emergency stop. {state}"
    return answer(
        f"refused: {text}", {"outcome": "refused", "reply": text, "reason": {"code": "release_refused"}}
    )


def error(text: str, why: str) -> CallToolResult:
    """Make the result of a call that could not be done at all."""
    return answer(text, {"outcome": "failed", "reply": text, "reason": {"code": why}}, is_error=True)


def pose_told(pose: Pose) -> dict[str, float]:
    """Return a pose in metres and degrees."""
    return {
        "x_m": tidy(pose.x_m, 3),
        "y_m": tidy(pose.y_m, 3),
        "heading_deg": tidy(math.degrees(wrap_angle(pose.yaw_rad)), 1),
    }


def tidy(value: float, decimals: int) -> float:
    """Return `value` rounded; what is rounded to nothing has no sign."""
    return round(value, decimals) + 0.0


def in_words(pose: Mapping[str, float]) -> str:
    """Return a pose of `pose_told` in a few words."""
    at = f"at ({fixed(pose['x_m'], 2)}, {fixed(pose['y_m'], 2)}) m"
    return f"{at}, heading {fixed(pose['heading_deg'], 0)} deg"


def course_told(course: Course, language: str, approval_address: str) -> CallToolResult:
    """Return what came of an instruction."""
    if course.state == "dropped":
        return answer(_DROPPED, {"outcome": "stopped", "reply": _DROPPED, "reason": {"code": "not_begun"}})
    if course.state == "busy":
        return answer(_BUSY, {"outcome": "refused", "reply": _BUSY, "reason": {"code": "busy"}})
    data: dict[str, Any] = {"turn": course.turn}
    if course.interpreted is not None and course.interpreted.plan_text:
        data["plan"] = course.interpreted.plan_text.rstrip()
    if course.rehearsed is not None and (course.rehearse_only or course.state == "waiting"):
        data["rehearsed"] = _rehearsal_told(course.rehearsed, language)
    if course.notes:
        data["notes"] = course.notes
    if course.program is not None:
        data["program"] = _program_told(course, course.program, language)
    if course.state == "waiting":
        return _waiting_told(data, approval_address, is_earlier=course.rehearsed is None)
    if course.state == "paused":
        return _paused_told(course, data, language)
    if course.result is None:  # nobody is left to hear it
        return error("The client has left, and the robot was stopped.", "client_gone")
    return _end_told(course, course.result, data, language)


def _waiting_told(data: dict[str, Any], address: str, *, is_earlier: bool) -> CallToolResult:
    text = (
        f"Not taken: a plan from before still waits for approval at {address}. Only a person says yes there; observe "
        "shows what becomes of it. Then ask again."
        if is_earlier
        else f"Waiting for approval at {address}. Tell the person: without a yes it lapses after "
        f"{LAPSES_AFTER_S:g} s, and nothing moves. observe shows what becomes of it."
    )
    return answer(text, {"outcome": "waiting", "reply": text, "approval_at": address, **data})


def _paused_told(course: Course, data: dict[str, Any], language: str) -> CallToolResult:
    paused = course.paused
    assert paused is not None
    why = render_reason(paused.reason, language) if paused.reason is not None else ""
    by_person = paused.reason is not None and paused.reason.values.get("source") != SOURCE
    hint = "Go on only when the person says so" if by_person else "Go on"
    text = f'Paused ({why}); the plan is kept. {hint}: instruct("continue").'
    left = {"pose": pose_told(paused.pose), "remaining": paused.plan_text.rstrip()}
    return answer(text, {"outcome": "paused", "reply": text, **left, **data})


def _end_told(course: Course, result: Result, data: dict[str, Any], language: str) -> CallToolResult:
    outcome = result.outcome
    hints = _hints(course, result)
    data = {"outcome": outcome, "reply": result.reply, **data}
    why = render_reason(result.reason, language) if result.reason is not None else ""
    if result.reason is not None:
        data["reason"] = {**result.reason.to_json(), "text": why}
    data["measured"] = result.measured
    if result.pose is not None:
        data["pose"] = pose_told(result.pose)
    if result.path_m is not None and result.turned_rad is not None and not course.rehearse_only:
        data |= {
            "path_m": tidy(result.path_m, 3),
            "turned_deg": tidy(math.degrees(result.turned_rad), 1),
            "duration_s": round(result.duration_s, 2),
        }
    if result.proposal is not None:
        data["question"] = {"say": result.proposal.say, "plan": result.proposal.plan_text}
        hints.append('instruct("yes") does what is asked; anything else drops it.')
    if hints:
        data["hint"] = " ".join(hints)
    lines = [
        f"{outcome}: {result.reply}",
        why if outcome == "completed" else "",  # what was left out, say: else the reply tells it
        *_plan_lines(course),
        *_measured_lines(course, result, language),
        *_faults(course),
        *hints,
    ]
    return answer("\n".join(filter(None, lines)), data, is_error=outcome == "failed")


def _plan_lines(course: Course) -> list[str]:
    """Return in one line how words were understood: many clients show their model the text alone."""
    if course.is_plan or course.interpreted is None or not course.interpreted.plan_text:
        return []
    steps = (line.strip() for line in shown_plan(course.interpreted.plan_text).splitlines())
    return [_shortened(f"Plan: {'; '.join(steps)}", MOST_SHOWN_CHARS)]


def _shortened(text: str, limit_chars: int) -> str:
    return text if len(text) <= limit_chars else f"{text[: limit_chars - 1]}…"


def _measured_lines(course: Course, result: Result, language: str) -> list[str]:
    if course.rehearse_only:
        return [_in_words(course.rehearsed, language)] if course.rehearsed is not None else []
    if result.pose is None:
        return ["This robot measures nothing: nobody knows how far it went."]
    if not result.has_moved and result.outcome not in ("completed", "stopped"):
        return course.notes if result.outcome == "answered" else []
    at = in_words(pose_told(result.pose))
    return [f"It moved for {result.duration_s:.1f} s; the robot is now {at}.", *course.notes]


def _faults(course: Course) -> list[str]:
    """Return how a program broke, as Python says it."""
    tried = course.program_rehearsed
    return [tried.problem[-MOST_FAULT_CHARS:].strip()] if tried is not None and tried.problem else []


def _hints(course: Course, result: Result) -> list[str]:
    if course.lacks_person:
        return [NO_PERSON]
    if course.is_emergency and not course.rehearse_only and result.outcome in ("refused", "stopped"):
        return [_HINTS["emergency_stop"]]
    reason: Reason | None = result.reason
    if reason is not None and reason.code in ("stopped_by", "paused_by"):
        return [_PERSON_STOPPED] if reason.values.get("source") != SOURCE else []
    hint = _HINTS.get(reason.code) if reason is not None else None
    if hint is not None:
        return [hint]
    if result.outcome != "unclear" or result.proposal is not None:
        return []
    return [UNCLEAR_PROGRAM if course.is_program else UNCLEAR_PLAN if course.is_plan else UNCLEAR]


def _program_told(course: Course, program: ProgramWritten, language: str) -> dict[str, Any]:
    marks = [
        {"line": mark.step[0] if mark.step else None, "text": render_reason(mark.reason, language)}
        for mark in program.marks
    ]
    told: dict[str, Any] = {"name": program.program, "version": program.version, "marks": marks}
    tried = course.program_rehearsed
    if tried is not None:
        told |= {
            "ended": tried.ended,
            "top_speed_mps": round(tried.top_speed_mps, 3),
            "log": list(tried.log[-MOST_LOG:]),
        }
        if tried.problem:
            told |= {"problem": tried.problem, "line": tried.line or None}
    return told


def _rehearsal_told(rehearsed: Rehearsed, language: str) -> dict[str, Any]:
    found = [
        {"severity": each.severity, "text": render_reason(each.reason, language), "step": list(each.step)}
        for each in rehearsed.findings
    ]
    return {
        "ok": rehearsed.ok,
        "length_m": round(rehearsed.length_m, 3),
        "duration_s": round(rehearsed.duration_s, 2),
        "end": pose_told(rehearsed.end),
        "findings": found,
        "needs_approval": rehearsed.needs_approval,
        "open_ended": rehearsed.open_ended,
    }


def _in_words(rehearsed: Rehearsed, language: str) -> str:
    told = _rehearsal_told(rehearsed, language)
    found = [f"{each['severity']}: {each['text']}" for each in told["findings"]]
    if not rehearsed.ok:  # the reply is the first refusal; nobody drives to an end that was not reached
        refusals = [text for text in found if text.startswith("refuse")]
        return " ".join(text for text in found if text not in refusals[:1])
    open_ended = ", and its end is not known" if rehearsed.open_ended else ""
    way = (
        f"Rehearsed: {told['length_m']:.2f} m in {told['duration_s']:.1f} s{open_ended}, ending "
        f"{in_words(told['end'])}."
    )
    return " ".join([way, *found])
