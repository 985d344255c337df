"""Who says yes to a rehearsed plan: a person at the terminal, the program that reads our events, or nobody."""

from __future__ import annotations

import contextlib
import queue
import sys
import threading

from chatrobot.cli.approval import Approval, edited_text
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event
from chatrobot.dialogue.session import Session
from chatrobot.sim.world import World


class Approver(Approval):
    """Hears the events of a session and answers those that ask.

    Args:
        can_ask: a person sits at a `Keyboard`, which hands on what is typed by `type`.
        others_answer: whoever reads our events answers; see `talk`.
    """

    prompt = "Do it (e edits it first)? [y/N] "

    def __init__(self, *, can_ask: bool, others_answer: bool = False) -> None:
        super().__init__()
        self._can_ask = can_ask
        self.others_answer = others_answer
        self._has_asked = False
        self._world: World | None = None
        self._edited = ""
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.editing = threading.Lock()
        """Held while an editor has the terminal."""

    def attach(self, world: World) -> None:
        """Note the world, to draw the way in."""
        self._world = world

    def hear(self, event: Event) -> bool:
        """Take an event in; return whether it is a question."""
        asks = super().hear(event)
        if asks:
            self._has_asked = False
            self._lines = queue.SimpleQueue()
        return asks

    def poll(self, session: Session) -> None:
        """Answer what waits, if there is an answer by now. Never blocks."""
        if self.turn is None:
            return
        if self._can_ask or not self._lines.empty():  # an answer may be the last that was typed
            self._ask(session)
        elif not self.others_answer:
            print(
                "chatrobot: Approval needed, but stdin is not a terminal. Pass --yes to skip it.",
                file=sys.stderr,
            )
            self.answer(session, False)

    def _ask(self, session: Session) -> None:
        if not self._has_asked:
            self._draw_way()
            print(self.prompt, end="", file=sys.stderr)
            self._has_asked = True  # before it is seen: who sees it may answer at once
            sys.stderr.flush()
        with contextlib.suppress(queue.Empty):
            self._take(session, self._lines.get_nowait())

    def type(self, line: str) -> bool:
        """Take a typed line; false where no question is shown that it could answer. From any thread."""
        is_asking = self._has_asked and self.turn is not None
        if is_asking:
            self._lines.put(line)
        return is_asking

    def lose_keyboard(self) -> None:
        """Nothing more will be typed: that is a no. From any thread."""
        self.type("")
        self._can_ask = False

    def _take(self, session: Session, answer: str) -> None:
        turn, before = self.turn, self.take(session, answer)
        if not before or turn is None:
            return
        self._edited = self._edit(before)
        if not self._edited.strip():
            self._edited = ""
            self._muted.discard(turn)

    def take_edited(self) -> str:
        """Return, once, the plan or program that was edited, or the same where the editor failed; "" for none."""
        text, self._edited = self._edited, ""
        return text

    def _edit(self, text: str) -> str:
        """Return `text` as the person leaves it, as it was where the editor fails."""
        with self.editing:
            try:
                return edited_text(text, ".py" if self.edits_program else ".txt")
            except UsageError as error:
                print(f"chatrobot: {error}", file=sys.stderr)
                return text

    def _draw_way(self) -> None:
        from rich.console import Console

        from chatrobot.cli.console.tables import way_map

        if self._world is not None and len(self.motion_view.path) > 1:
            Console(stderr=True, highlight=False).print(way_map(self.motion_view, self._world))
