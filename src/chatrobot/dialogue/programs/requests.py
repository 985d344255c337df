"""The turns of a session that are about a program: begun, rehearsed, sent back to be mended, run, kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.errors import InputError
from chatrobot.core.events import (
    Event,
    Finished,
    Interpreted,
    Notice,
    Outcome,
    ProgramRehearsed,
    Rehearsed,
    Started,
)
from chatrobot.core.reason import Reason
from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.llm.call import ModelCall
from chatrobot.dialogue.programs.authoring import (
    LIMITS,
    MOST_REPAIRS,
    Authoring,
    NotWrittenError,
    Writing,
)
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.phrases import render_reason
from chatrobot.language.program_request import ProgramRequest, read_request
from chatrobot.link.motion_link import MotionLink
from chatrobot.models.seam import Message
from chatrobot.programs.library import clean_name

MENDABLE = frozenset(
    {
        "program_syntax", "program_unreadable", "program_too_long", "import_forbidden", "import_unknown",
        "program_import", "program_forbidden", "program_raised", "program_raised_at_end",
        "program_exit_code",
        "program_waits_for_ever", "program_never_stops", "program_moves_nothing", "program_not_finite",
        "program_other_topic", "program_topic_silent", "program_too_busy", "program_vanished", "limited",
        "would_collide", "leaves_area", "leaves_fence", "outside_area", "outside_fence",
    }
)  # fmt: skip
"""What a model is asked to mend."""


@dataclass
class _Turn:
    draft: Draft
    rehearsed: ProgramRehearsed | None = None
    has_started: bool = False


@dataclass(frozen=True)
class _Asked:
    """A model is being asked; `work` goes on with the call once it has ended. `number` counts the calls of the turn."""

    turn: int
    work: Writing[None]
    call: ModelCall
    number: int


class ProgramRequests:
    """Used by the session's pumping thread, but for `cancel`. At most one program is being written at a time.

    Args:
        is_void_turn: a stop came after that turn was said.
        finish: ends a turn whose program Motion refused, and no model mended.
    """

    def __init__(
        self,
        authoring: Authoring,
        understanding: Understanding,
        book: RequestLog,
        goals: GoalClient,
        link: MotionLink,
        emit: Callable[[Event], None],
        is_void_turn: Callable[[int], bool],
        finish: Callable[[Finished], None],
    ) -> None:
        self.authoring = authoring
        self._understanding = understanding
        self._requests = book
        self._goals = goals
        self._link = link
        self._emit = emit
        self._is_void_turn = is_void_turn
        self._finish = finish
        self._asked: _Asked | None = None
        self._cancels = 0
        self._turns: dict[int, _Turn] = {}
        self._shown: dict[str, Draft] = {}
        self._ran: dict[int, Draft] = {}

    # --- what a model writes ---

    def cancel(self) -> None:
        """End what a model is being asked, from any thread; return at once."""
        self._cancels += 1
        asked = self._asked
        if asked is not None:
            asked.call.cancel()

    @property
    def is_writing(self) -> bool:
        """True while a model writes: what is said then, but for a stop or a pause, waits."""
        return self._asked is not None

    @property
    def asked_at_s(self) -> float | None:
        """Return since when a model is being asked (monotonic), None where none is; from any thread."""
        asked = self._asked
        return asked.call.asked_at_s if asked is not None else None

    def wait(self, timeout_s: float) -> None:
        """Wait until the model says something; where time is simulated, it stands meanwhile."""
        if self._asked is not None:
            self._asked.call.wait(timeout_s)

    def pump(self) -> None:
        """Take in what the model has said."""
        asked = self._asked
        if asked is None:
            return
        asked.call.take()
        if asked.call.has_ended:
            self._emit(asked.call.told(asked.turn, asked.number))
            self._go_on(asked.turn, asked.work, asked.number + 1, asked.call)
            if self._asked is asked:
                self._asked = None

    def _go_on(self, turn: int, work: Writing[None], number: int = 1, ended: ModelCall | None = None) -> None:
        """Go on with a turn's work up to its next question to a model, its call `number`."""
        try:
            messages: Sequence[Message] = next(work) if ended is None else work.send(ended)
        except StopIteration:
            return
        cancels, model = self._cancels, self.authoring.model
        assert model is not None
        call = ModelCall(model, messages, LIMITS, self._link.wake)
        self._asked = _Asked(turn, work, call, number)
        if cancels != self._cancels or self._is_void_turn(turn):
            call.cancel()  # a stop came while it was being asked

    # --- which program, and its run ---

    def begin(self, turn: int, text: str, *, is_asked_for: bool = False, name: str = "") -> bool:
        """Take the turn if it is about a program; `name` is what it is to be called."""
        language = self._understanding.language_of(text)
        told = "" if is_asked_for else self.authoring.told(text, language)
        if told:
            self._tell(turn, text, Interpretation("answered", told, language))
            return True
        try:
            draft = None if is_asked_for else self.authoring.kept(text, language)
        except NotWrittenError as refusal:
            self._refuse(turn, text, refusal, language)
            return True
        if draft is not None:
            self.run(turn, text, draft)
            return True
        request = read_request(text, is_asked_for=is_asked_for)
        if request is None:
            return False
        request = replace(request, name=name or request.name)
        self._go_on(turn, self._write(turn, text, request, language))
        return True

    def _write(self, turn: int, text: str, request: ProgramRequest, language: LanguageCode) -> Writing[None]:
        try:
            draft = yield from self.authoring.write(request, self._understanding.pose, language)
        except NotWrittenError as refusal:
            self._refuse(turn, text, refusal, language)
        else:
            wanted, kept_as = clean_name(request.name), draft.program.name
            if kept_as != wanted and self.authoring.library.find(wanted) is not None:
                self._emit(Notice(turn, Reason("program_name_taken", {"name": wanted, "kept_as": kept_as})))
            yield from self._run(turn, text, draft)

    def _refuse(self, turn: int, text: str, refusal: NotWrittenError, language: LanguageCode) -> None:
        outcome: Literal["unclear", "refused"] = "unclear" if refusal.outcome == "unclear" else "refused"
        self._tell(turn, text, Interpretation(outcome, refusal.reply, language), refusal.outcome)

    def _tell(self, turn: int, text: str, meant: Interpretation, outcome: Outcome = "answered") -> None:
        self._emit(Interpreted(turn, "offline", "", meant.reply))
        self._understanding.note_unmoved(text, meant)
        self._requests.conclude(turn, outcome, meant.reply)

    def run(self, turn: int, text: str, draft: Draft) -> None:
        """Have Motion rehearse and run it, as soon as it can be read at all."""
        self._go_on(turn, self._run(turn, text, draft))

    def _run(self, turn: int, text: str, draft: Draft) -> Writing[None]:
        code = "program_new" if draft.is_new else "program_kept"
        reply = self._understanding.say(code, text, name=draft.program.name)
        self._emit(Interpreted(turn, "model" if draft.by_model else "offline", "", reply))
        self._turns[turn] = about = _Turn(draft)
        self._requests.track(turn, text, Interpretation("plan", reply, self._understanding.language))
        yield from self._send(turn, about)

    def run_edited(self, turn: int, name: str, source: str) -> None:
        """Have a person's edit of the program of that name rehearsed and asked about.

        One that cannot be read leaves the program as it was.
        """
        try:
            before = self._shown.get(name) or self.authoring.draft_of(self.authoring.library.get(name))
        except InputError as error:  # nobody has shown it, nor is it kept
            self._requests.conclude(turn, "refused", str(error))
            return
        draft = self.authoring.edited(before, source)
        unreadable = draft.checked.refusal
        if unreadable is not None and before.checked.refusal is None:
            problem = render_reason(unreadable.reason, self._understanding.language)
            self._emit(Notice(turn, Reason("edit_unreadable", {"problem": problem})))
            draft = self.authoring.edited(before, before.program.source)
        self.run(turn, name, draft)

    def has_run(self, turn: int) -> bool:
        """Tell whether a program was started in that turn."""
        return turn in self._turns and self._turns[turn].has_started

    def run_again(self, turn: int, text: str, of_turn: int) -> None:
        """Have the program that was run in an earlier turn rehearsed and run once more, as one that is kept."""
        draft = self._ran[of_turn]
        kept = self.authoring.library.find(draft.program.name)
        is_same = kept is not None and kept.source == draft.program.source
        program = kept if kept is not None and is_same else draft.program
        self.run(turn, text, replace(draft, program=program, is_new=False, asks=False, diff="", messages=()))

    def hear(self, event: Event) -> bool:
        """Take in Motion's event; True where Motion is done with the turn, and we are not."""
        about = self._turns.get(event.turn)
        if about is None:
            return False
        if isinstance(event, ProgramRehearsed):
            about.rehearsed = event
        elif isinstance(event, Rehearsed) and about.rehearsed is not None:
            self._note_rehearsal(about.draft, about.rehearsed, event)
        elif isinstance(event, Started):
            about.has_started = True
            self._ran[event.turn] = about.draft
        elif isinstance(event, Finished) and about.has_started:
            self.authoring.note_run(about.draft, event)
        elif isinstance(event, Finished):
            return self._send_mended(event, about)
        return False

    def _note_rehearsal(self, draft: Draft, program: ProgramRehearsed, path: Rehearsed) -> None:
        """An edit that rehearsal refuses leaves the version before it, and what is known of that."""
        if path.ok:
            self.authoring.keep(draft)
        if path.ok or not self.authoring.replaces_kept(draft):
            self.authoring.note_rehearsal(draft, program, path)

    def ending(self, turn: int, reply: str) -> str:
        """Return the reply at the end of a program's turn: what was promised and cannot be is said again."""
        about = self._turns.pop(turn, None)
        if about is None or not about.has_started:
            return reply
        language = self._understanding.language
        return " ".join([reply, *(render_reason(promise, language) for promise in about.draft.promises)])

    def _send_mended(self, event: Finished, about: _Turn) -> bool:
        """Have a model mend what Motion refused; False where it may not, so that the turn ends."""
        reason = event.reason
        if reason is None or reason.code not in MENDABLE or self._is_void_turn(event.turn):
            return False
        if not self.authoring.may_mend(about.draft):
            return False
        self._go_on(event.turn, self._mend_refused(event, about, reason), about.draft.version + 1)
        return True

    def _mend_refused(self, event: Finished, about: _Turn, reason: Reason) -> Writing[None]:
        problem = about.rehearsed.problem if about.rehearsed is not None else ""
        if (yield from self._mend(about, reason, problem)):
            yield from self._send(event.turn, about)
        else:
            self._finish(event)

    def _mend(self, about: _Turn, problem: Reason, details: str) -> Writing[bool]:
        """Have the model write the next version; False where there is none."""
        if not self.authoring.may_mend(about.draft):
            return False
        try:
            draft = yield from self.authoring.mend(
                about.draft, problem, details, self._understanding.language
            )
        except NotWrittenError:
            return False  # what was wrong is told all the same
        about.draft, about.rehearsed = draft, None
        return True

    def _send(self, turn: int, about: _Turn) -> Writing[None]:
        """Show this version and hand it to Motion; one that cannot even be read is mended first, or ends the turn."""
        self._show(turn, about.draft)
        while (refusal := about.draft.checked.refusal) is not None:
            if not (yield from self._mend(about, refusal.reason, "")):
                del self._turns[turn]
                reply = render_reason(refusal.reason, self._understanding.language)
                self._requests.conclude(turn, "refused", reply)
                return
            self._show(turn, about.draft)
        draft = about.draft
        if not self.authoring.replaces_kept(draft):
            self.authoring.keep(draft)
        payload = {
            "code": draft.program.source,
            "name": draft.program.name,
            "remap": draft.remap,
            "args": list(draft.args),
            "strict": draft.by_model and draft.version <= MOST_REPAIRS,
        }
        is_led_elsewhere = bool(draft.remap) and not draft.program.runs
        self._goals.program(
            turn,
            payload,
            is_new=draft.is_new,
            by_model=draft.by_model,
            is_led_elsewhere=is_led_elsewhere,
            asks=draft.asks or self._understanding.limit_mps is not None,  # a rehearsal tells how fast it is
        )

    def _show(self, turn: int, draft: Draft) -> None:
        self._shown[draft.program.name] = draft
        self._emit(draft.event(turn))
