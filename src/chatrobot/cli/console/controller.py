"""One conversation, whatever it is typed into: what a line means, what an event makes the display print.

`enter`, `interrupt` and `leave` belong to the display's thread, `hear` and `lose` to the pumping thread.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.approval import Approval, is_answer
from chatrobot.cli.console.lines import Display, indented, marked, shown
from chatrobot.cli.console.pasted import (
    LONGEST_CHARS,
    MOST_TEXTS,
    Pasted,
    as_goodbye,
    clean,
    cut_at_stop,
    ends_a_paste,
    goes_on_after,
    is_plan,
    must_be_typed,
    quoted,
    takes_turn,
)
from chatrobot.cli.console.status_bar import StatusBar
from chatrobot.cli.console.tables import way_map
from chatrobot.cli.console.words import Words
from chatrobot.cli.lines import GOODBYES, texts_in
from chatrobot.cli.narrator import Narrator
from chatrobot.compose import Connection
from chatrobot.core.clock import Clock
from chatrobot.core.errors import LinkError
from chatrobot.core.events import RELEASED, Event, Notice, Result, Started, Telemetry
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.dialogue.pump import Pump
from chatrobot.dialogue.replies import is_parting
from chatrobot.programs.check import MAX_SOURCE_CHARS
from chatrobot.reflex import is_emergency_stop, is_pause, is_stop, leads_with_stop

if TYPE_CHECKING:
    from chatrobot.cli.console.commands import Command

TWICE_S = 1.5
"""Two Ctrl-C within this time leave."""
ECHO_CHARS = 600


class ChatController:
    """See the module. `display` is attached once it exists; `run_command` does a line that begins with a slash.

    `on_said` are told what was typed, by the number of its turn; `commands` are further ones, those of a lesson."""

    display: Display

    def __init__(
        self,
        connection: Connection,
        words: Words,
        clock: Clock,
        run_command: Callable[[ChatController, str], None],
    ) -> None:
        self._run_command = run_command
        self.connection = connection
        self.session = connection.session
        self.words = words
        self._approval = Approval()
        self.motion_view = self._approval.motion_view
        self.status_bar = StatusBar(self.motion_view, words, connection.world)
        self.narrator = Narrator(words)
        self.pump = Pump(self.session, self._end)
        self.on_said: list[Callable[[int, str], None]] = []
        self.commands: Sequence[Command] = ()
        self.latched = self._release_is_due = False
        self.has_parted = False
        """The person said goodbye in words, and was answered."""
        self._clock = clock
        self._pasted = Pasted()
        self._leaving = self._said_stopped = self._pauses_again = False
        self._interrupted_s = float("-inf")
        self._order = threading.Lock()  # a line is printed before what it brings about

    # --- what a person does ---

    def enter(self, raw: str) -> None:
        """Take a line that was sent, or several that came at once. A stop in it has gone out before this returns."""
        self._said_stopped = False
        cleaned = clean(raw)
        texts = texts_in(cleaned)
        if len(raw) > LONGEST_CHARS:  # it may have been cut: never do a part of it
            self.stop_for_paste(cleaned)
            self.tell("line_too_long", limit=LONGEST_CHARS)
        elif len(texts) == 1:
            self._enter_one(as_goodbye(texts[0], self._may_move))
        elif is_plan(cleaned):
            self.say_plan(cleaned.strip(), cleaned.strip())
        elif texts:
            self._enter_all(texts)

    def stop_for_paste(self, lines: str) -> None:
        """Stop the robot where one of these lines, pasted and not sent yet, says so."""
        if stop := cut_at_stop(texts_in(lines), self._is_stop)[1]:
            self.stop(stop)

    def _enter_one(self, text: str) -> None:
        if text.startswith("/"):
            self._echo(text)
            self._run_command(self, text)
        elif not self._answer(text):
            self._say(text)

    def _enter_all(self, texts: Sequence[str]) -> None:
        """Drop what stands before a stop; do what follows it, or all, one after the other."""
        undone, stop, texts = cut_at_stop(texts, self._is_stop)
        if stop:
            self._enter_one(stop)
            self._tell_undone(undone)
        if len(texts) > MOST_TEXTS:
            self.tell("paste_too_many", count=len(texts), limit=MOST_TEXTS)
            return
        with self._order:
            undone = self._pasted.drop()
            self._pasted.keep(texts)
        self._tell_undone(undone)
        self._say_next()

    def _say_next(self) -> None:
        """Say the next of what was pasted. What is behind a command that takes no turn follows at once."""
        with self._order:
            text = self._pasted.next()
            while text is not None and text.startswith("/") and text != "/undo":
                typed_alone = must_be_typed(text)
                undone = self._pasted.drop() if typed_alone or ends_a_paste(text) else ()
                self._echo(text, anew=True)
                self._tell_undone(undone)
                if not typed_alone and takes_turn(text):
                    self._pasted.follow_command()
                    self._run_command(self, text)
                    return
                self.tell(f"{typed_alone}_alone") if typed_alone else self._run_command(self, text)
                text = self._pasted.next()
            if text is not None:
                self._say_in_order(text if text != "/undo" else self.words.say("undo_words"), is_pasted=True)

    def take_edited(self, edited: str) -> None:
        """Take the plan or the program that `Display.edit` was asked for."""
        is_program = self._approval.edits_program
        text = f"{edited.rstrip()}\n" if is_program else clean(edited).strip()
        limit = MAX_SOURCE_CHARS if is_program else LONGEST_CHARS
        if len(edited) > limit:
            self.tell("line_too_long", limit=limit)
        elif text.strip():
            say, shown = lambda: self._approval.say_edited(self.session, text), self.words.say("edited")
            self.say_as_one(say, shown, text)
        else:
            self.tell("edited_away")

    def say_plan(self, plan_text: str, shown: str = "") -> None:
        """Have a plan driven that is there as text; `shown` is what its line looks like, if it has not been shown."""
        self.say_as_one(lambda: self.session.say_plan(plan_text), shown, plan_text)

    def drop_behind_command(self) -> None:
        """Drop what was pasted behind a command that has ended without a turn."""
        with self._order:
            undone = self._pasted.drop() if self._pasted.is_behind_command else ()
        self._tell_undone(undone)

    def say_as_one(self, say: Callable[[], int], shown: str, text: str) -> None:
        """Say what is one utterance, however many lines it has; it takes the place of what was pasted."""
        with self._order:
            undone = () if self._pasted.is_behind_command else self._pasted.drop()
            self.attempt(lambda: self._note_followed(say(), text))
            if shown:
                self._echo(shown)
        self._tell_undone(undone)

    def interrupt(self) -> None:
        """Ctrl-C: stop the robot; the second one in a row leaves."""
        self.stop("Ctrl-C")
        before_s, self._interrupted_s = self._interrupted_s, self._clock.now_s()
        if self._interrupted_s - before_s <= TWICE_S:
            self.display.leave(0)
            return
        self._leaving = self.has_parted = False
        self.tell("interrupted")

    def leave(self) -> None:
        """Say goodbye: what the robot was told is still done. The second one does not wait to see it."""
        if self._has_nothing_to_do or self._leaving:
            self.display.leave(0)
            return
        self._leaving = True
        if self.session.is_paused:
            self.stop("end of input")  # nobody is left to go on with it
        elif self._approval.turn is not None:
            self.attempt(lambda: self._approval.answer(self.session, False))
        else:
            self.tell("finishing")

    def stop(self, why: str) -> None:
        """Stop the robot now."""
        self.attempt(lambda: self.session.stop(why))
        self._tell_undone(self._pasted.drop())

    def emergency_stop(self, why: str) -> None:
        """Stop the robot and keep it stopped until it is released."""
        self.attempt(lambda: self.session.emergency_stop(why))
        self._tell_undone(self._pasted.drop())
        self.latched, self._release_is_due = True, False
        self.display.refresh()

    def release(self) -> None:
        """Ask Motion to; its notice says what became of it."""
        self._release_is_due = True
        self.attempt(self.session.release)

    def _say(self, text: str) -> None:
        """Say what was typed: it takes the place of all that runs and waits."""
        self.words.follow(text)
        self._pauses_again = is_pause(text) and self.session.is_plan_paused
        if self._is_stop(text):  # waits for no lock: the other thread may hang in a terminal that was halted
            self.attempt(lambda: self.session.say(text))
            undone = self._pasted.drop()
            self._echo(text)
            if text.casefold() in GOODBYES:
                self.tell("how_to_leave")
        else:
            with self._order:
                undone = self._pasted.drop()
                self._say_in_order(text)
        self._tell_undone(undone)
        if is_emergency_stop(text):
            self.latched, self._release_is_due = True, False

    def _say_in_order(self, text: str, *, is_pasted: bool = False) -> None:
        self.words.follow(text)
        self.attempt(lambda: self._note_followed(self.session.say(text), text))
        self._echo(text, anew=is_pasted)

    def _note_followed(self, turn: int, text: str) -> None:
        self._pasted.follow(turn)
        self._interrupted_s = float("-inf")  # it stands between two interrupts
        for note in self.on_said:
            note(turn, text)

    def _is_stop(self, text: str) -> bool:
        return leads_with_stop(text) if self.session.is_moving else is_stop(text)

    def _tell_undone(self, texts: Sequence[str]) -> None:
        if texts:
            self.tell("paste_undone", texts=quoted(texts, self.words.language))

    @property
    def _has_nothing_to_do(self) -> bool:
        return self.session.is_idle and not self._pasted.is_waiting

    def _may_move(self) -> bool:
        return not self._has_nothing_to_do or self.motion_view.is_moving or not self.motion_view.twist.is_zero

    def _answer(self, text: str) -> bool:
        """Answer the question whether to do a plan; False where `text` is no answer to it."""
        if self._approval.turn is None or not is_answer(text):
            return False
        self._echo(text)
        self.attempt(lambda: self._edit(self._approval.take(self.session, text)))
        return True

    def _edit(self, text: str) -> None:
        if text:
            self.display.edit(text)

    def attempt(self, act: Callable[[], object]) -> None:
        """Do something that needs Motion; without it, this conversation is over."""
        try:
            act()
        except LinkError as error:
            self.lose(error)

    # --- what the robot does ---

    def hear(self, event: Event) -> None:
        """Take an event in and show it."""
        asks = self._approval.hear(event)
        if isinstance(event, Notice) and event.reason.code in RELEASED:
            self._hear_release(str(event.reason.values.get("source")))
        if isinstance(event, ObstacleChanged):
            self.status_bar.show_world(self.connection.world)
        with self._order:
            lines: list[RenderableType] = [shown(line) for line in self.narrator.tell(event)]
            if asks:
                question = Text(f"  {self.words.say('ask_approval')}", "bold")
                lines += [way_map(self.motion_view, self.connection.world), question]
            ends_what_moved = self.motion_view.is_moving or self._said_stopped or self.session.is_plan_paused
            if ends_what_moved and not self._pauses_again:
                self._approval.mute_stop(event)  # what was moving says how it ended
            if isinstance(event, Result):
                self._said_stopped = event.outcome == "stopped"
            if lines and not self._approval.is_muted(event):
                self.display.print(*lines)
        if isinstance(event, Result):
            self._go_on_after(event)
            if is_parting(event):
                self.has_parted = True
                self.leave()
            if self._leaving and self._has_nothing_to_do:
                self.display.leave(0)
        kinds = (Started, Result, Telemetry) if self.motion_view.is_moving else (Started, Result)
        if isinstance(event, kinds):
            self.display.refresh()

    def _hear_release(self, by: str) -> None:
        """No alarm goes by a release that was asked for before it was raised."""
        if by != "console" or self._release_is_due:
            self.latched = self._release_is_due = False
            self.display.refresh()

    def _go_on_after(self, result: Result) -> None:
        with self._order:  # whoever says a turn holds it until the number is known
            if not self._pasted.is_after(result.turn):
                return
            undone = () if goes_on_after(result.outcome) else self._pasted.drop()
        self._tell_undone(undone)
        self._say_next()

    def lose(self, error: LinkError) -> None:
        """Tell that Motion is gone, and leave: its guard halts the robot."""
        self.display.print(marked("✗", "bold red", str(error)))
        self.display.leave(1)

    def _end(self, error: Exception) -> None:
        """Leave, for the pumping thread has ended."""
        if not isinstance(error, LinkError):
            self.display.leave(1)
            raise error
        self.lose(error)

    def tell(self, code: str, **values: object) -> None:
        """Print one line of the console's own words."""
        self.display.print(indented(Text(self.words.say(code, **values), "dim")))

    def _echo(self, text: str, *, anew: bool = False) -> None:
        """Show what was sent. `anew`: again, because what it was sent with stands between."""
        if anew or not self.display.echoes:
            shown = (text if len(text) <= ECHO_CHARS else f"{text[:ECHO_CHARS]}…").replace("\n", "\n  ")
            self.display.print(Text("› ", "bold blue").append(shown, "bold"))
