"""Keeps what has happened: for `observe`, and for the resources. Heard by the pumping thread, read by the server's."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

from chatrobot.core.events import (
    RELEASED,
    Event,
    Limited,
    Notice,
    Paused,
    ProgramLog,
    Remembered,
    Result,
    Said,
    Started,
    Telemetry,
)
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason, fixed, one_line
from chatrobot.language.phrases import render_reason

KEPT_EVENTS = 10
SAMPLE_S = 0.2
MOST_SAMPLES = 3000
"""Ten minutes of a recording: as long as one text may drive."""
TOLD_CHARS = 240


class Record:
    """The last events in words, where the robot is, and the way of the last motion."""

    def __init__(self) -> None:
        self.telemetry: Telemetry | None = None
        self.heard_at_s = 0.0
        """When telemetry came last (monotonic)."""
        self.last: Result | None = None
        self.emergency: Reason | None = None
        """The emergency stop that refused a motion, until a release is heard of."""
        self.edit: dict[str, Any] | None = None
        """What a person had done in place of the agent's last plan, until the agent's next one."""
        self._events: deque[tuple[float, str]] = deque(maxlen=KEPT_EVENTS)
        self._began_s = 0.0
        self._way: deque[tuple[float, Pose]] = deque(maxlen=MOST_SAMPLES)
        self._is_driven = False

    def hear(self, event: Event, language: str) -> None:
        """Take an event in."""
        now_s = time.monotonic()
        if isinstance(event, Telemetry):
            self.telemetry, self.heard_at_s = event, now_s
            self._sample(event.pose, now_s)
        elif isinstance(event, Started):
            self._began_s, self._is_driven, self.emergency, self.edit = now_s, True, None, None
            self._way.clear()
            self._way.append((0.0, event.pose))
        elif isinstance(event, Result):
            self._end(event, now_s)
        told = words_of(event, language)
        if told:
            self._events.append((now_s, one_line(told, TOLD_CHARS)))
        self._note_emergency(event)

    def note_edit(self, turn: int, plan_text: str, result: Result) -> None:
        """Take note of what became of the plan that a person made of the agent's own of that turn."""
        told = f"a person edited your plan of turn {turn}: {plan_text}"
        self._events.append((time.monotonic(), one_line(f"{told}: {words_of(result, 'en')}", TOLD_CHARS)))
        self.edit = {"of_turn": turn, "plan": plan_text, "result": result.to_json()}

    def _sample(self, pose: Pose, now_s: float) -> None:
        t_s = now_s - self._began_s
        if self._is_driven and self._way and t_s - self._way[-1][0] >= SAMPLE_S:
            self._way.append((t_s, pose))

    def _end(self, result: Result, now_s: float) -> None:
        if self._is_driven or result.outcome not in ("completed", "answered"):
            self.last = result  # and no rehearsal
        if self._is_driven and result.has_moved and result.pose is not None:
            self._way.append((now_s - self._began_s, result.pose))
        self._is_driven = False

    def _note_emergency(self, event: Event) -> None:
        reason = getattr(event, "reason", None)
        if not isinstance(reason, Reason):
            return
        if reason.code == "emergency_stop":
            self.emergency = reason
        elif reason.code in RELEASED:
            self.emergency = None

    def happened(self) -> list[str]:
        """Return the last events, the newest first, each with how long ago it was."""
        now_s = time.monotonic()
        return [f"{now_s - at_s:.0f} s ago: {text}" for at_s, text in reversed(tuple(self._events))]

    def way(self) -> list[dict[str, Any]]:
        """Return the measured way of the last motion."""
        return [
            {
                "t_s": round(t_s, 2),
                "x_m": round(pose.x_m, 3),
                "y_m": round(pose.y_m, 3),
                "yaw_rad": round(pose.yaw_rad, 4),
            }
            for t_s, pose in tuple(self._way)
        ]


def words_of(event: Event, language: str) -> str:
    """Return an event in words; "" for one that nobody need hear of."""
    if isinstance(event, Result):
        return (
            event.reply if event.outcome in ("completed", "answered") else f"{event.outcome}: {event.reply}"
        )
    if isinstance(event, Notice):
        return event.text or render_reason(event.reason, language)
    if isinstance(event, Paused):
        return f"paused: {render_reason(event.reason, language) if event.reason else ''}"
    if isinstance(event, Limited) and event.reason is not None:
        return f"limited: {render_reason(event.reason, language)}"
    if isinstance(event, Remembered):
        x, y = fixed(event.pose.x_m, 2), fixed(event.pose.y_m, 2)
        return f"remembered {event.place} at ({x}, {y}) m"
    if isinstance(event, ProgramLog):
        return f"log, {event.t_s:.1f} s: {event.text}"
    return f"said: {event.text}" if isinstance(event, Said) else ""
