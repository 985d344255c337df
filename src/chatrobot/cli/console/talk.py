"""One conversation, whatever it is typed into: what a line means, what an event makes the face print.

`enter`, `interrupt` and `leave` belong to the face's thread, `hear` and `lose` to the pumping thread.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Protocol

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.console.clean import LONGEST_CHARS, clean
from chatrobot.cli.console.lines import indented, marked
from chatrobot.cli.console.maps import way_map
from chatrobot.cli.console.narrator import Narrator
from chatrobot.cli.console.pump import Pump
from chatrobot.cli.console.ride import Ride
from chatrobot.cli.console.strip import Strip
from chatrobot.cli.console.words import Words
from chatrobot.compose import Connection
from chatrobot.core.clock import Clock
from chatrobot.core.errors import JointError
from chatrobot.core.events import Event, Interpreted, Result, Started, Telemetry
from chatrobot.language.consent import read_consent, wants_to_edit
from chatrobot.programs.check import MAX_SOURCE_CHARS
from chatrobot.reflex import is_emergency_stop
from chatrobot.session.question import Question

TWICE_S = 1.5
"""Two Ctrl-C within this time leave."""

ECHO_CHARS = 600


class Face(Protocol):
    """A screen. All of it may be called from any thread."""

    @property
    def echoes(self) -> bool:
        """What was typed stays to be seen without our help."""
        ...

    @property
    def width(self) -> int:
        """Columns."""
        ...

    def print(self, *lines: RenderableType) -> None: ...

    def refresh(self) -> None:
        """Something that the strip shows has changed."""
        ...

    def edit(self, plan_text: str) -> None:
        """Let the person change a plan; it comes back through `Talk.take_edited`."""
        ...

    def leave(self, code: int) -> None:
        """End the conversation; `code` is the exit code."""
        ...


class Talk:
    """See the module. `face` is attached once it exists; `run_command` does a line that begins with a slash."""

    face: Face

    def __init__(
        self,
        connection: Connection,
        words: Words,
        clock: Clock,
        run_command: Callable[[Talk, str], None],
    ) -> None:
        self._run_command = run_command
        self.connection = connection
        self.session = connection.session
        self.words = words
        self.ride = Ride()
        self.strip = Strip(self.ride, words, connection.world)
        self.narrator = Narrator(words)
        self.pump = Pump(self.session, self.lose, lambda: self.face.leave(1))
        self.latched = False
        self._clock = clock
        self._question = Question()
        self._muted: set[int] = set()
        self._leaving = False
        self._interrupted_s = float("-inf")
        self._order = threading.Lock()  # a line is printed before what it brings about

    # --- what a person does ---

    def enter(self, raw: str) -> None:
        """A line was sent. A stop in it has gone out before this returns."""
        text = clean(raw).strip()
        if len(raw) > LONGEST_CHARS:  # it may have been cut: never do a part of it
            self.tell("line_too_long", limit=LONGEST_CHARS)
        elif text.startswith("/"):
            self._echo(text)
            self._run_command(self, text)
        elif text and not self._answer(text):
            self._say(text)

    def take_edited(self, edited: str) -> None:
        """The plan or the program that `Face.edit` was asked for."""
        program = self.ride.program
        text = edited.rstrip() if program is not None else clean(edited).strip()
        if len(edited) > (LONGEST_CHARS if program is None else MAX_SOURCE_CHARS):
            self.tell("line_too_long", limit=LONGEST_CHARS)
        elif text:
            with self._order:
                if program is not None:
                    self.attempt(lambda: self.session.say_source(program.program, f"{text}\n"))
                else:
                    self.attempt(lambda: self.session.say_plan(text))
                self._echo(self.words.say("edited"))

    def interrupt(self) -> None:
        """Ctrl-C: stop the robot; the second one leaves."""
        self.stop("Ctrl-C")
        now_s = self._clock.now_s()
        if now_s - self._interrupted_s <= TWICE_S:
            self.face.leave(0)
            return
        self._interrupted_s = now_s
        self._leaving = False
        self.tell("interrupted")

    def leave(self) -> None:
        """An orderly goodbye: what the robot was told is still done. The second one does not wait to see it."""
        if self.session.is_idle or self._leaving:
            self.face.leave(0)
            return
        self._leaving = True
        if self._question.turn is not None:
            self.attempt(lambda: self._question.answer(self.session, False))
            return
        self.tell("finishing")

    def stop(self, why: str) -> None:
        """Stop the robot now."""
        self.attempt(lambda: self.session.stop(why))

    def emergency_stop(self, why: str) -> None:
        self.attempt(lambda: self.session.emergency_stop(why))
        self.latched = True
        self.face.refresh()

    def release(self) -> None:
        self.attempt(self.session.release)
        self.latched = False
        self.face.refresh()

    def _say(self, text: str) -> None:
        self.words.follow(text)
        with self._order:
            self.attempt(lambda: self.session.say(text))
            self._echo(text)
        if is_emergency_stop(text):
            self.latched = True

    def _answer(self, text: str) -> bool:
        """True if `text` answers the question whether to do a plan."""
        turn, yes, edits = self._question.turn, read_consent(text), wants_to_edit(text)
        if turn is None or (yes is None and not edits):
            return False
        self._echo(text)
        if edits:
            self._muted.add(turn)
            program = self.ride.program
            self.face.edit(program.source if program is not None else self.ride.plan_text)
        self.attempt(lambda: self._question.answer(self.session, yes is True))
        return True

    def attempt(self, act: Callable[[], object]) -> None:
        """Do something that needs Motion; without it, this talk is over."""
        try:
            act()
        except JointError as error:
            self.lose(error)

    # --- what the robot does ---

    def hear(self, event: Event) -> None:
        """Take an event in and show it."""
        self.ride.hear(event)
        with self._order:
            lines: list[RenderableType] = list(self.narrator.tell(event))
            if self._question.hear(event):
                lines += [
                    way_map(self.ride, self.connection.world),
                    Text(f"  {self.words.say('ask_approval')}", "bold"),
                ]
            if isinstance(event, Interpreted) and event.by == "reflex" and self.ride.is_moving:
                self._muted.add(event.turn)  # what was moving is about to say how it ended
            if lines and event.turn not in self._muted:
                self.face.print(*lines)
        if isinstance(event, (Telemetry, Started, Result)) and (
            self.ride.is_moving or not isinstance(event, Telemetry)
        ):
            self.face.refresh()
        if isinstance(event, Result) and self._leaving and self.session.is_idle:
            self.face.leave(0)

    def lose(self, error: JointError) -> None:
        """Motion is gone: its guard has halted the robot; here is nothing left to talk to."""
        self.face.print(marked("✗", "bold red", str(error)))
        self.face.leave(1)

    # --- printing ---

    def tell(self, code: str, **values: object) -> None:
        """One line of the console's own words."""
        self.face.print(indented(Text(self.words.say(code, **values), "dim")))

    def _echo(self, text: str) -> None:
        if not self.face.echoes:
            shown = text if len(text) <= ECHO_CHARS else f"{text[:ECHO_CHARS]}…"
            self.face.print(Text("› ", "bold blue").append(shown, "bold"))
