"""Who says yes to a rehearsed plan: a person at the terminal, the program that reads our events, or nobody."""

from __future__ import annotations

import contextlib
import queue
import sys
import threading

from chatrobot.cli.console.ride import Ride
from chatrobot.cli.editor import edited_text
from chatrobot.core.events import Event
from chatrobot.language.consent import read_consent, wants_to_edit
from chatrobot.session.question import Question
from chatrobot.session.session import Session
from chatrobot.sim.world import World


class Approver:
    """Hears the events of a session and answers those that ask.

    Args:
        can_ask: a person sits at a `Keyboard`, which hands on what is typed by `type`.
        others_answer: whoever reads our events answers; see `talk`.
    """

    prompt = "Do it (e edits it first)? [y/N] "

    def __init__(self, *, can_ask: bool, others_answer: bool = False) -> None:
        self._can_ask = can_ask
        self._others_answer = others_answer
        self._question = Question()
        self._has_asked = False
        self._ride = Ride()
        self._world: World | None = None
        self._edited_plan: str | None = None
        self._typed: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.editing = threading.Lock()
        """Held while an editor has the terminal."""

    def attach(self, world: World) -> None:
        """What to draw the way in."""
        self._world = world

    @property
    def is_waiting(self) -> bool:
        """A plan waits for an answer."""
        return self._question.turn is not None

    def hear(self, event: Event) -> None:
        self._ride.hear(event)
        if self._question.hear(event):
            self._has_asked = False
            self._typed = queue.SimpleQueue()

    def answer(self, session: Session) -> None:
        """Answer what waits, if there is an answer by now. Never blocks."""
        if not self.is_waiting:
            return
        if self._can_ask:
            self._ask(session)
        elif not self._others_answer:
            print(
                "chatrobot: this wants a yes, and there is no terminal to ask at; --yes does it unasked",
                file=sys.stderr,
            )
            self.give(session, False)

    def give(self, session: Session, yes: bool) -> None:
        """Answer the plan that waits."""
        self._question.answer(session, yes)

    def _ask(self, session: Session) -> None:
        if not self._has_asked:
            self._draw_way()
            print(self.prompt, end="", file=sys.stderr, flush=True)
            self._has_asked = True
        with contextlib.suppress(queue.Empty):
            self.take(session, self._typed.get_nowait())

    def type(self, line: str) -> None:
        """A line was typed: no answer where no question is shown. From any thread."""
        if self._has_asked and self.is_waiting:
            self._typed.put(line)

    def lose_keyboard(self) -> None:
        """Nothing more will be typed: that is a no. From any thread."""
        self.type("")
        self._can_ask = False

    def take(self, session: Session, answer: str) -> None:
        """What the person typed: anything but a yes is none."""
        self.give(session, read_consent(answer) is True)
        if wants_to_edit(answer) and self._ride.plan_text and self._ride.program is None:
            with self.editing:
                self._edited_plan = edited_text(self._ride.plan_text, ".txt").strip() or None

    def take_edited(self) -> str | None:
        """The plan as the person has changed it; it is rehearsed and asked about like a new one."""
        text, self._edited_plan = self._edited_plan, None
        return text

    def _draw_way(self) -> None:
        from rich.console import Console

        from chatrobot.cli.console.maps import way_map

        if self._world is not None and len(self._ride.path) > 1:
            Console(stderr=True, highlight=False).print(way_map(self._ride, self._world))
