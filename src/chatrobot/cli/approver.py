"""Who says yes to a rehearsed plan: a person at the terminal, the program that reads our events, or nobody."""

from __future__ import annotations

import select
import sys

from chatrobot.cli.console.ride import Ride
from chatrobot.cli.editor import edited
from chatrobot.core.events import Event, Finished, Rehearsed
from chatrobot.session.session import Session
from chatrobot.sim.world import World

_EDIT = frozenset({"e", "edit", "修改", "改"})
_YES = frozenset({"y", "yes", "ok", "是", "好", "好的", "行", "可以", "对"})


class Approver:
    """Hears the events of a session and answers those that ask.

    Args:
        can_ask: a person sits at standard input and has nothing else to type there.
        others_answer: whoever reads our events answers; see `talk`.
    """

    def __init__(self, *, can_ask: bool, others_answer: bool = False) -> None:
        self._can_ask = can_ask
        self._others_answer = others_answer
        self._turn: int | None = None
        self._has_asked = False
        self._ride = Ride()
        self._world: World | None = None
        self._edited: str | None = None

    def attach(self, world: World) -> None:
        """What to draw the way in."""
        self._world = world

    @property
    def is_waiting(self) -> bool:
        """A plan waits for an answer."""
        return self._turn is not None

    def hear(self, event: Event) -> None:
        self._ride.hear(event)
        if isinstance(event, Rehearsed) and event.needs_approval:
            self._turn, self._has_asked = event.turn, False
        elif isinstance(event, Finished) and event.turn == self._turn:
            self._turn = None

    def answer(self, session: Session) -> None:
        """Answer what waits, if there is an answer by now. Never blocks."""
        if self._turn is None:
            return
        if self._can_ask:
            self._ask(session)
        elif not self._others_answer:
            print(
                "chatrobot: --approve needs a terminal to ask at; --yes does each plan unasked",
                file=sys.stderr,
            )
            self.give(session, False)

    def give(self, session: Session, yes: bool) -> None:
        """Answer the plan that waits."""
        if self._turn is not None:
            session.approve(self._turn, yes)
            self._turn = None

    def _ask(self, session: Session) -> None:
        if not self._has_asked:
            self._draw_way()
            print("Do it (e edits it first)? [y/N] ", end="", file=sys.stderr, flush=True)
            self._has_asked = True
        if select.select([sys.stdin], [], [], 0.0)[0]:
            said = sys.stdin.readline().strip().casefold()
            self.give(session, said in _YES)
            if said in _EDIT:
                self._edited = edited(self._ride.plan_text)

    def take_edited(self) -> str | None:
        """The plan as the person has changed it; it is rehearsed and asked about like a new one."""
        text, self._edited = self._edited, None
        return text

    def _draw_way(self) -> None:
        from rich.console import Console

        from chatrobot.cli.console.maps import way_map

        if self._world is not None and len(self._ride.path) > 1:
            Console(stderr=True, highlight=False).print(way_map(self._ride, self._world))
