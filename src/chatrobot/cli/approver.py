"""Who says yes to a rehearsed plan: a person at the terminal, the program that reads our events, or nobody."""

from __future__ import annotations

import contextlib
import queue
import sys
import threading
from collections.abc import Callable

from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.editing import Edited, edited_text
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event, Result
from chatrobot.dialogue.question import Question
from chatrobot.dialogue.session import Session
from chatrobot.language.consent import read_consent, wants_to_edit
from chatrobot.sim.world import World

SayEdited = Callable[[Session], int]
"""Says what a person made of a plan or a program; gives the number of its turn."""


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
        self._motion_view = MotionView()
        self._world: World | None = None
        self._edited: SayEdited | None = None
        self._edit_of = Edited()
        self._withdrawn: set[int] = set()
        self._typed: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.editing = threading.Lock()
        """Held while an editor has the terminal."""

    def attach(self, world: World) -> None:
        """Note the world, to draw the way in."""
        self._world = world

    @property
    def is_waiting(self) -> bool:
        """A plan waits for an answer."""
        return self._question.turn is not None

    def is_withdrawn(self, event: Event) -> bool:
        """Tell whether `event` only says that a plan was not done which is being edited: that is asked about anew."""
        has_moved = isinstance(event, Result) and event.has_moved
        return event.turn in self._withdrawn and not has_moved

    def hear(self, event: Event) -> None:
        """Take an event in."""
        self._motion_view.hear(event)
        self._edit_of.hear(event)
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
                "chatrobot: Approval needed, but stdin is not a terminal. Pass --yes to skip it.",
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
        """Take a typed line: no answer where no question is shown. From any thread."""
        if self._has_asked and self.is_waiting:
            self._typed.put(line)

    def lose_keyboard(self) -> None:
        """Nothing more will be typed: that is a no. From any thread."""
        self.type("")
        self._can_ask = False

    def take(self, session: Session, answer: str) -> None:
        """Take what the person typed: anything but a yes is none."""
        turn, program, plan_text = self._question.turn, self._motion_view.program, self._motion_view.plan_text
        self.give(session, read_consent(answer) is True)
        if not wants_to_edit(answer) or turn is None or not (program or plan_text):
            return
        text = self._edit(self._edit_of.begin(plan_text, program), ".py" if program else ".txt", turn)
        self._edited = (lambda session: self._edit_of.say(session, text)) if text else None

    def take_edited(self) -> SayEdited | None:
        """Return what says next, once, the plan or program that was edited, or the same where the editor failed."""
        say, self._edited = self._edited, None
        return say

    def _edit(self, text: str, suffix: str, turn: int) -> str:
        """Return `text` as the person leaves it, as it was where the editor fails; "" where nothing is left."""
        self._withdrawn.add(turn)
        with self.editing:
            try:
                edited = edited_text(text, suffix)
            except UsageError as error:
                print(f"chatrobot: {error}", file=sys.stderr)
                return text
        if not edited.strip():
            self._withdrawn.discard(turn)
            return ""
        return edited

    def _draw_way(self) -> None:
        from rich.console import Console

        from chatrobot.cli.console.tables import way_map

        if self._world is not None and len(self._motion_view.path) > 1:
            Console(stderr=True, highlight=False).print(way_map(self._motion_view, self._world))
