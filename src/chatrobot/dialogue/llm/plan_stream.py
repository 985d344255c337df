"""Sends a model's plan to Motion: step by step as the model says it, or as a whole once all is said."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from chatrobot.core.events import Event, Said, Streamed
from chatrobot.plan.base import Step
from chatrobot.plan.primitives.say import Say
from chatrobot.plan.text import format_step

if TYPE_CHECKING:
    from chatrobot.link.motion_link import MotionLink


class PlanStream:
    """Plans of one turn, one after the other. Belongs to the pumping thread, but for `cancel`.

    Args:
        mode: what the first plan does to one that is under way; those after it go on where it ended.
        pauses: how many there were by now; a plan that was begun before the last one is not driven.
    """

    def __init__(
        self,
        turn: int,
        link: MotionLink,
        emit: Callable[[Event], None],
        mode: Literal["queue", "replace", "append"],
        *,
        approve: bool,
        rehearse_only: bool,
        pauses: Callable[[], int],
    ) -> None:
        self._turn = turn
        self._link = link
        self._emit = emit
        self._mode = mode
        self._approve = approve
        self._rehearse_only = rehearse_only
        self._pauses = pauses
        self._is_cancelled = False
        self.is_open = False
        """Motion has the plan, and has not told its end."""
        self.begin(streams=False)

    def cancel(self) -> None:
        """Send nothing more. From any thread."""
        self._is_cancelled = True

    def begin(self, *, streams: bool) -> None:
        """Begin another plan; `streams`: its steps go to Motion as they come."""
        self._streams = streams
        self._pauses_before = self._pauses()
        self._held: list[Step] = []
        self.is_open = self._is_closed = False

    def take(self, step: Step) -> None:
        """Send it on where steps stream; what is only said waits for the first motion: it may be the whole answer."""
        self._held.append(step)
        if self._streams and (self.is_open or not isinstance(step, Say)):
            lines = [format_step(held) for held in self._held]
            self._held = []
            for line in lines:
                self._emit(Streamed(self._turn, line))
            self._send("\n".join(lines), more=True)

    def send_whole(self, plan_text: str, *, unasked: bool = False) -> None:
        """Send all of it at once, where nothing of it has been sent. `unasked`: this one needs no approval."""
        if plan_text:
            self._send(plan_text, more=False, unasked=unasked)

    def close(self) -> None:
        """Tell Motion that no more steps will come."""
        if self.is_open and not self._is_closed:
            self._send("", more=False)

    def end(self) -> None:
        """Note that Motion has told its end."""
        self.is_open = False

    def say_held(self) -> None:
        """Say what waited for a motion that did not come."""
        for step in self._held if self._streams else ():
            if isinstance(step, Say):
                self._emit(Said(self._turn, step.text))

    def _send(self, plan_text: str, *, more: bool, unasked: bool = False) -> None:
        if self._is_cancelled:
            return
        mode = "extend" if self.is_open else self._mode
        self.is_open = True
        self._is_closed = not more
        self._link.send(
            "plan", self._turn, plan_text=plan_text, mode=mode, more=more, approve=self._approve and not unasked,
            rehearse_only=self._rehearse_only, pauses=self._pauses_before,
        )  # fmt: skip
        self._mode = "queue"  # what comes later in this turn goes on after it
