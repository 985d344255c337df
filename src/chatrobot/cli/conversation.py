"""A session as the commands use it: connected, watched over, pumped by the main thread."""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable, Sequence

from chatrobot.cli.approver import Approver
from chatrobot.cli.entry import STOPPED, forget_stdout
from chatrobot.cli.json_lines import Printer
from chatrobot.cli.signals import SignalWatch
from chatrobot.compose import Connection, OnEvent, Setup, connect
from chatrobot.core.errors import LinkError
from chatrobot.core.events import EXIT_CODES, Event, Notice, Result
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import AFTER_GOODBYE, is_parting
from chatrobot.language.interpretation import LanguageCode
from chatrobot.language.typed import speak_for

PUMP_S = 0.1


class Conversation:
    """Enter it to connect; leave it to say goodbye: what is queued is still done unless a signal ended it.

    Only `hear`, `post` and `stop` may be called from other threads. In simulated time Motion lives in the main
    thread, so that these wait for its next step, a matter of milliseconds; in real time they wait for nothing.
    """

    def __init__(
        self,
        setup: Setup,
        printer: Printer,
        approver: Approver,
        meet: Callable[[Setup, OnEvent], Connection] = connect,
    ) -> None:
        self._setup = setup
        self._meet = meet
        self._printer = printer
        self._approver = approver
        self._posted: queue.Queue[Callable[[], object]] = queue.Queue()
        self._watch = SignalWatch(self.stop)
        self._is_cut_off = False
        self._last_turn = 0
        self.has_parted = False
        """The person said goodbye: nothing more is heard, and what runs is still done."""
        self._connection: Connection | None = None

    def __enter__(self) -> Conversation:
        speak_for("lines")
        connection = self._meet(self._setup, self._on_event)
        self.session, self._connection = connection.session, connection
        self._approver.attach(connection.world)
        self._watch.__enter__()
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        if kind is not None:
            with contextlib.suppress(LinkError):
                self.session.stop("chatrobot broke")
        if self._connection is not None:
            self._connection.close()
        self._watch.__exit__()
        if self._printer.is_broken:
            forget_stdout()

    @property
    def is_leaving(self) -> bool:
        """A signal, a stop from the keyboard or a broken pipe has ended this conversation."""
        return self._watch.is_leaving or self._is_cut_off

    @property
    def exit_code(self) -> int:
        """Of the last turn."""
        if self.is_leaving:
            return STOPPED
        results = self.session.results
        return EXIT_CODES[results[self._last_turn or max(results)].outcome] if results else 0

    @property
    def language(self) -> LanguageCode:
        """Of the last question."""
        if self._connection is None:
            return self._setup.options.language  # the first true poses come while it connects
        return self._connection.session.understanding.language

    # --- from any thread ---

    def hear(self, text: str) -> None:
        """Somebody said `text`. A stop is out before this returns, in real time."""
        if self.is_leaving:
            return
        if self._setup.fast:
            self.post(lambda: self.session.say(text))
        else:
            with contextlib.suppress(LinkError):  # Motion is gone: the main thread tells
                self.session.say(text)

    def leave(self) -> None:
        """End here: what was heard before is still done, what is said from now on is not."""
        if self._setup.fast:
            self.post(self.session.end_after)
        else:
            self.session.end_after()
        self.post(self._part)

    def _part(self) -> None:
        self.has_parted = True

    @property
    def is_paused(self) -> bool:
        """A plan is paused."""
        return self._connection is not None and self.session.is_paused

    def stop(self, why: str) -> None:
        """Stop the robot and drop what is queued. Before there is a robot nothing moves, nor will."""
        if self._connection is None:
            return
        if self._setup.fast:
            self.post(lambda: self.session.stop(why))
        else:
            self.session.stop(why)

    def halt(self, why: str) -> None:
        """Stop the robot and end here: what was still to be said is not."""
        with contextlib.suppress(LinkError):  # Motion is gone: the main thread tells
            self.stop(why)
        self._is_cut_off = True

    def post(self, action: Callable[[], object]) -> None:
        """Have `action` done by the main thread."""
        self._posted.put(action)

    # --- the main thread ---

    def do(self, text: str) -> Result:
        """Say it, and see the turn through: its result."""
        return self.see_through_edits(self.session.say(text))

    def do_plan(self, plan_text: str) -> Result:
        """As `do`, for a plan that a person wrote."""
        return self.see_through_edits(self.session.say_plan(plan_text))

    def tell_dropped(self, texts: Sequence[str]) -> None:
        """Say what is not begun, where a stop came while the robot was started, or a goodbye before."""
        code = "dropped_by_stop" if self.is_leaving else AFTER_GOODBYE
        for text in texts if self.is_leaving or self.has_parted else ():
            self.show(Notice(0, Reason(code, {"text": text})))

    def see_through_edits(self, turn: int) -> Result:
        """That turn, and those of what a person made of the plan or program that it asked about."""
        result = self.see_through(turn)
        while (text := self._approver.take_edited()) and not self.is_leaving:
            result = self.see_through(self._approver.say_edited(self.session, text))
        return result

    def see_through(self, turn: int) -> Result:
        """Let things happen until that turn has its result."""
        self._last_turn = turn
        while turn not in self.session.results:
            self.step()
        return self.session.results[turn]

    def finish(self) -> None:
        """See everything through that was heard."""
        while not (self.session.is_idle and self._posted.empty()):
            if self.session.waits_for_a_word and self._posted.empty():
                self._give_up()
            self.step()

    def _give_up(self) -> None:
        """Nobody is left to say yes to what waits for one, or to go on with what is paused."""
        turn = self._approver.turn
        if turn is None:
            self.session.stop("end of input")
        elif self._approver.others_answer:
            self.show(
                Notice(turn, Reason("nobody_approves"), "the input has ended, and nobody is left to say yes")
            )
            self._approver.answer(self.session, False)

    def step(self) -> None:
        """Let things happen for a moment.

        Raises:
            LinkError: Motion is gone.
        """
        self._do_posted()
        if self._printer.is_broken and not self._is_cut_off:
            self._is_cut_off = True
            self.session.stop("nobody reads")
        self._approver.poll(self.session)
        if self._setup.fast and self.session.waits_for_a_word and self._wait_for_posted():
            return  # a virtual half minute is over before a person has read the question: time stands
        self.session.pump(PUMP_S)

    def wait(self) -> None:
        """Nothing is to be done: wait for a moment. Simulated time stands meanwhile."""
        if not self._setup.fast:
            self.step()
        elif self._wait_for_posted():
            self._is_cut_off = self._is_cut_off or self._printer.is_broken

    def _wait_for_posted(self) -> bool:
        """Do what another thread asks for; True where nothing came."""
        try:
            self._posted.get(timeout=PUMP_S)()
        except queue.Empty:
            return True
        return False

    def _do_posted(self) -> None:
        while not self._posted.empty():
            self._posted.get()()

    def show(self, event: Event) -> None:
        """Have it printed."""
        self._printer.show(event, self.language)

    def _on_event(self, event: Event) -> None:
        self._approver.hear(event)
        if is_parting(event):
            self.has_parted = True
            self.session.end_after(event.turn)
        if not self._approver.is_muted(event):
            self.show(event)
