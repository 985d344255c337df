"""The turns of a session that are about a program: begun, rehearsed, sent back to be mended, run, kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.core.events import (
    Event,
    Finished,
    Interpreted,
    ModelCalled,
    Notice,
    ProgramRehearsed,
    Rehearsed,
    Started,
)
from chatrobot.core.reason import Reason
from chatrobot.dialogue.goal_client import GoalClient
from chatrobot.dialogue.programs.authoring import MOST_REPAIRS, Authoring, NotWrittenError
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.request_log import RequestLog
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.normalise import has_chinese
from chatrobot.language.phrases import render_reason
from chatrobot.language.program_request import ProgramRequest

MENDABLE = frozenset(
    {
        "program_syntax", "program_unreadable", "program_too_long", "import_forbidden", "import_unknown",
        "program_import", "program_forbidden", "program_raised", "program_raised_at_end",
        "program_exit_code",
        "program_waits_for_ever", "program_never_stops", "program_moves_nothing", "program_not_finite",
        "program_other_topic", "program_topic_silent", "program_too_busy", "program_vanished", "limited",
        "would_collide", "leaves_area", "leaves_fence",
    }
)  # fmt: skip
"""What a model is asked to mend."""


@dataclass
class _Turn:
    draft: Draft
    rehearsed: ProgramRehearsed | None = None
    has_started: bool = False


class ProgramRequests:
    """Used by the session's pumping thread.

    Args:
        is_void_turn: a stop came after that turn was said.
    """

    def __init__(
        self,
        authoring: Authoring,
        understanding: Understanding,
        book: RequestLog,
        goals: GoalClient,
        emit: Callable[[Event], None],
        is_void_turn: Callable[[int], bool],
    ) -> None:
        self.authoring = authoring
        self._understanding = understanding
        self._requests = book
        self._goals = goals
        self._emit = emit
        self._is_void_turn = is_void_turn
        self._turns: dict[int, _Turn] = {}
        self._shown: dict[str, Draft] = {}
        self._ran: dict[int, Draft] = {}

    def begin(self, turn: int, text: str, *, is_asked_for: bool = False, name: str = "") -> bool:
        """Take the turn if it is about a program; `name` is what it is to be called.

        Blocks while a model writes; a stop ends that.
        """
        language: LanguageCode = "zh" if has_chinese(text) else "en"
        try:
            draft = None if is_asked_for else self.authoring.kept(text, language)
            if draft is None:
                request = self.authoring.request(text, is_asked_for=is_asked_for)
                if request is None:
                    return False
                draft = self._write(turn, replace(request, name=name or request.name), language)
        except NotWrittenError as refusal:
            self._emit(Interpreted(turn, "offline", "", refusal.reply))
            outcome: Literal["unclear", "refused"] = "unclear" if refusal.outcome == "unclear" else "refused"
            meant = Interpretation(outcome, refusal.reply, language)
            self._understanding.note_unmoved(text, meant)
            self._requests.conclude(turn, refusal.outcome, refusal.reply)
            return True
        self.run(turn, text, draft)
        return True

    def _write(self, turn: int, request: ProgramRequest, language: LanguageCode) -> Draft:
        try:
            return self.authoring.write(request, self._understanding.pose, language)
        finally:
            self._tell_spent(turn, 1)

    def run(self, turn: int, text: str, draft: Draft) -> None:
        """Have Motion rehearse and run it, as soon as it can be read at all."""
        code = "program_new" if draft.is_new else "program_kept"
        reply = self._understanding.say(code, text, name=draft.program.name)
        self._emit(Interpreted(turn, "model" if draft.by_model else "offline", "", reply))
        self._turns[turn] = about = _Turn(draft)
        self._requests.track(turn, text, Interpretation("plan", reply, self._understanding.language))
        self._send(turn, about)

    def run_edited(self, turn: int, name: str, source: str) -> None:
        """Have a person's edit of the program of that name rehearsed and asked about.

        One that cannot be read leaves the program as it was.
        """
        before = self._shown[name]
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
            self.authoring.note_rehearsal(about.draft, about.rehearsed, event)
        elif isinstance(event, Started):
            about.has_started = True
            self._ran[event.turn] = about.draft
        elif isinstance(event, Finished) and about.has_started:
            self.authoring.note_run(about.draft, event)
        elif isinstance(event, Finished):
            return self._send_mended(event, about)
        return False

    def ending(self, turn: int, reply: str) -> str:
        """Return the reply at the end of a program's turn: what was promised and cannot be is said again."""
        about = self._turns.pop(turn, None)
        if about is None or not about.has_started:
            return reply
        language = self._understanding.language
        return " ".join([reply, *(render_reason(promise, language) for promise in about.draft.promises)])

    def _send_mended(self, event: Finished, about: _Turn) -> bool:
        reason = event.reason
        if reason is None or reason.code not in MENDABLE or self._is_void_turn(event.turn):
            return False
        problem = about.rehearsed.problem if about.rehearsed is not None else ""
        if not self._mend(event.turn, about, reason, problem):
            return False
        self._send(event.turn, about)
        return True

    def _send(self, turn: int, about: _Turn) -> None:
        """Show this version and hand it to Motion; one that cannot even be read is mended first, or ends the turn."""
        self._show(turn, about.draft)
        while (refusal := about.draft.checked.refusal) is not None:
            if not self._mend(turn, about, refusal.reason, ""):
                del self._turns[turn]
                reply = render_reason(refusal.reason, self._understanding.language)
                self._requests.conclude(turn, "refused", reply)
                return
            self._show(turn, about.draft)
        self.authoring.keep(about.draft)
        draft = about.draft
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
            asks=draft.asks,
        )

    def _show(self, turn: int, draft: Draft) -> None:
        self._shown[draft.program.name] = draft
        self._emit(draft.event(turn))

    def _tell_spent(self, turn: int, call: int) -> None:
        """Tell what a model has used, as for plans; `call` counts those of the turn."""
        for spent in self.authoring.take_spent():
            usage = spent.usage
            self._emit(
                ModelCalled(
                    turn, spent.model, call, usage.prompt_tokens, usage.cached_tokens, usage.reply_tokens,
                    usage.cost_usd, usage.counted, spent.duration_s,
                )
            )  # fmt: skip

    def _mend(self, turn: int, about: _Turn, problem: Reason, details: str) -> bool:
        """Have the model write the next version; False where there is none."""
        try:
            draft = self.authoring.mend(about.draft, problem, details, self._understanding.language)
        except NotWrittenError:
            return False  # what was wrong is told all the same
        finally:
            self._tell_spent(turn, about.draft.version + 1)
        if draft is None:
            return False
        about.draft, about.rehearsed = draft, None
        return True
