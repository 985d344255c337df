"""The question whether to do a rehearsed plan: one piece for the console, the terminal and the nodes.

Motion decides what a yes is worth, and how long (`approval.py`).
"""

from __future__ import annotations

from typing import Protocol

from chatrobot.core.events import Event, Finished, Paused, Rehearsed, Started


class Approving(Protocol):
    """A `Session`, as far as a question needs it."""

    def approve(self, turn: int, yes: bool) -> None: ...


class Question:
    """Knows which plan waits for a person's yes. `hear` every event; answer from any thread."""

    def __init__(self) -> None:
        self._asked: Rehearsed | None = None

    @property
    def turn(self) -> int | None:
        """Of the plan that waits; None where none does."""
        asked = self._asked
        return asked.turn if asked is not None else None

    def hear(self, event: Event) -> bool:
        """Take an event in; True where it is a question."""
        if isinstance(event, Rehearsed) and event.needs_approval:
            self._asked = event
            return True
        if isinstance(event, (Started, Paused, Finished)) and event.turn == self.turn:
            self._asked = None
        return False

    def answer(self, session: Approving, yes: bool) -> bool:
        """Answer it, once; False where nothing waits.

        Raises:
            LinkError: Motion is gone.
        """
        asked, self._asked = self._asked, None
        if asked is None:
            return False
        session.approve(asked.turn, yes)
        return True
