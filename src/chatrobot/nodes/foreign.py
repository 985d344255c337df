"""Text on `chatgpt_node` from somebody who is none of ours: the tutorial's lines, and short plans.

It has the lowest priority: it never interrupts a plan of ours, and gives way to one. It carries no heartbeat, so what
it may do is bounded: a line moves the robot for one second, a plan for ten at most.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from chatrobot.core.clock import LOCAL_TERM_S
from chatrobot.core.errors import PlanTextError
from chatrobot.core.process import own_identity
from chatrobot.core.reason import Reason
from chatrobot.link.envelope import Envelope
from chatrobot.link.motion_link import Sender
from chatrobot.link.topic_link import CHATGPT_NODE
from chatrobot.motion.runner import MotionRunner
from chatrobot.plan.steps import Plan, RawTwist
from chatrobot.plan.text import ImpossibleTwistError, format_plan, parse_plan, read_tutorial_line

LONGEST_S = 10.0
MAX_CHARACTERS = 2000
MAX_WAITING = 10
TURN = 0
"""Its events belong to nobody's turn."""
_SHOWN = 80


class Foreign:
    """Judges such text, and beats its lease from Motion's own control loop while it moves the robot.

    Args:
        is_busy: whether a plan of ours runs or waits.
    """

    def __init__(self, runner: MotionRunner, is_busy: Callable[[], bool]) -> None:
        self._runner = runner
        self._is_busy = is_busy
        self._sender = Sender(CHATGPT_NODE)
        self._process = own_identity()
        self._lock = threading.Lock()
        self._waiting = 0

    @property
    def has_work(self) -> bool:
        """Something of it runs or waits."""
        return self._waiting > 0

    def hear(self, text: str) -> None:
        """Take in a text; returns at once."""
        stops = self._runner.motion.stops
        self._runner.in_background(lambda: self._judge(text, stops))

    def beat(self) -> None:
        """With every tick of the control loop: if that freezes, the guard halts the robot."""
        if self.has_work:
            self._runner.receive(self._beat_envelope())

    def _beat_envelope(self) -> Envelope:
        return self._sender.envelope("beat", term_s=LOCAL_TERM_S, process=self._process)

    def note_finished(self) -> None:
        """Note that one plan of it has ended."""
        with self._lock:
            self._waiting = max(0, self._waiting - 1)

    def _judge(self, text: str, stop_count: int) -> None:
        shown = text.strip()[:_SHOWN]
        try:
            plan_text = read_foreign(text)
        except ImpossibleTwistError as error:
            self._runner.notice(Reason(error.code, {"part": shown}))
            return
        if plan_text is None:
            self._runner.notice(Reason("foreign_ignored", {"text": shown}))
        elif self._is_busy():
            self._runner.notice(Reason("foreign_busy", {"text": shown}))
        elif self._waiting >= MAX_WAITING:
            self._runner.notice(Reason("foreign_full", {"text": shown, "limit": MAX_WAITING}))
        elif stop_count == self._runner.motion.stops:
            with self._lock:
                self._waiting += 1
            self._runner.receive(self._beat_envelope())
            plan = {"plan_text": plan_text, "mode": "queue", "longest_s": LONGEST_S}
            self._runner.receive(self._sender.envelope("plan", TURN, **plan), said_in_epoch=stop_count)


def read_foreign(text: str) -> str | None:
    """Return the plan text that `text` comes to: lines of the tutorial's form alone, or plan text; None for the rest.

    Raises:
        ImpossibleTwistError: a velocity of the tutorial's form that cannot be.
    """
    if len(text) > MAX_CHARACTERS:
        return None
    lines = [line for line in text.splitlines() if line.strip()]
    twists = [twist for twist in map(read_tutorial_line, lines) if isinstance(twist, RawTwist)]
    if twists and len(twists) == len(lines):
        return format_plan(Plan(tuple(twists)))
    try:
        return format_plan(parse_plan(text))
    except PlanTextError:
        return None
