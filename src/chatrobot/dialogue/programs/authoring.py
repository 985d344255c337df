"""Programs on the understanding side: asked for, written (offline or by a model), read through, mended, kept.

Nothing here runs a program: its source goes to Motion, which rehearses it in the sandbox.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from chatrobot.core.events import Finished, Outcome, ProgramRehearsed, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.call import ModelCall
from chatrobot.dialogue.llm.prompt import mend_prompt, program_prompt
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import render_reason, say
from chatrobot.language.program_request import (
    ProgramRequest,
    asks_about_programs,
    may_be_called,
    read_changed_program,
    read_program_name,
)
from chatrobot.models.seam import CallLimits, Message, Model
from chatrobot.plan.context import Impossible, RoutePlanner
from chatrobot.plan.steps import Plan
from chatrobot.programs.check import check
from chatrobot.programs.extract import Extracted, extract
from chatrobot.programs.library import KeptProgram, Library, Provenance, RunRecord, clean_name, today
from chatrobot.programs.writing.program import Wanted, write_program
from chatrobot.robots.profile import RobotProfile

MOST_REPAIRS = 2
LIMITS = CallLimits(reply_tokens=4000)

T = TypeVar("T")
Writing = Generator[Sequence[Message], ModelCall, T]
"""Work that yields what a model is to be asked, and goes on with the call once that has ended."""


class NotWrittenError(Exception):
    """No program came of it; `outcome` and `reply` are the turn's, in the person's language."""

    def __init__(self, outcome: Outcome, reply: str) -> None:
        self.outcome = outcome
        self.reply = reply
        super().__init__(reply)


class Authoring:
    """Writes programs for one robot. Used by the session's pumping thread.

    Args:
        library: where programs are kept.
        interpret: reads a sentence as the session does.
        model: writes what the offline language does not understand; None for no model.
        prefers_model: the model writes all of them.
        routes: makes who finds ways around what is known, for programs that go to places.
    """

    def __init__(
        self,
        profile: RobotProfile,
        library: Library,
        interpret: Callable[[str], Interpretation],
        *,
        model: Model | None = None,
        prefers_model: bool = False,
        routes: Callable[[], RoutePlanner | None] = lambda: None,
    ) -> None:
        self.library = library
        self._profile = profile
        self._interpret = interpret
        self.model = model
        self.prefers_model = prefers_model
        self._routes = routes

    # --- which program ---

    def kept(self, text: str, language: str) -> Draft | None:
        """Return the kept program that `text` asks to run, with the arguments behind a `--`; None where it asks none.

        Raises:
            NotWrittenError: it cannot be given those arguments, or is to run otherwise than it is.
        """
        names = self.library.names()
        if not names:
            return None
        said, _, command_line = text.partition(" -- ")
        name = read_program_name(said, names)
        changed = read_changed_program(said, names) if name is None else None
        if changed is not None:
            raise NotWrittenError("refused", say(language, "program_as_it_is", name=changed))
        if name is None:
            return None
        try:
            return self.draft_of(self.library.get(name)).with_args(shlex.split(command_line))
        except ValueError as error:
            reason = Reason("program_arguments", {"problem": str(error)})
            raise NotWrittenError("refused", render_reason(reason, language)) from error

    def told(self, text: str, language: str) -> str:
        """Return the answer to a question about programs; an empty string where `text` asks none."""
        about, names = asks_about_programs(text), self.library.names()
        if not about:
            return ""
        kept = say(language, "programs_named", names=", ".join(names)) if names else ""
        return say(language, "programs_managed" if about == "managed" else "program_offer", kept=kept).strip()

    def draft_of(self, program: KeptProgram) -> Draft:
        """Return the draft of a program that is there already."""
        checked = check(program.source, self._profile)
        program = replace(program, remap=dict(checked.remap))
        place = self.library.place(program.name)
        return Draft(program, checked, place=place, version=program.provenance.versions)

    def _new(self, program: KeptProgram, request: ProgramRequest, messages: Sequence[Message] = ()) -> Draft:
        draft = self.draft_of(program)
        return replace(draft, is_new=True, promises=request.promises, messages=tuple(messages))

    def draft_of_file(self, path: Path, source: str) -> Draft:
        """Return the draft of a program from a file, which is not kept."""
        program = KeptProgram(path.stem, source, provenance=Provenance(f"from {path.name}"))
        return replace(self.draft_of(program), place=str(path))

    def edited(self, draft: Draft, source: str) -> Draft:
        """Return what a person made of a program that was shown: its next version, or the same where nothing changed.

        It is asked about before it runs. One that came from a file is kept from now on: the file stays as it is.
        """
        if source == draft.program.source:
            return replace(draft, asks=True)
        if draft.place != self.library.place(draft.program.name):
            name = self.library.free_name(draft.program.name)
            draft = replace(draft, program=replace(draft.program, name=name))
        new = draft.next(source, check(source, self._profile))
        return replace(new, asks=True, place=self.library.place(new.program.name))

    # --- writing ---

    def write(self, request: ProgramRequest, pose: Pose, language: str) -> Writing[Draft]:
        """Write the program for a request of somebody whose robot stands at `pose`.

        Raises:
            NotWrittenError: nobody could write it, and why.
        """
        if not may_be_called(request.name):
            raise NotWrittenError("refused", say(language, "program_no_name", name=request.name))
        if self.prefers_model and self.model is not None:
            return (yield from self._by_model(request, language))
        try:
            return self._offline(request, pose, language)
        except NotWrittenError as refusal:
            if self.model is None or refusal.outcome != "unclear":
                raise
            return (yield from self._by_model(request, language))

    def _offline(self, request: ProgramRequest, pose: Pose, language: str) -> Draft:
        plan = self._plan(request, language)
        name = clean_name(request.name) or "program"
        source = self._written(plan, name, request, pose, language)
        kept = self.library.find(name)
        if kept is not None and kept.source != source:
            name = self.library.free_name(name)
            source = self._written(plan, name, request, pose, language)
        program = KeptProgram(name, source, provenance=Provenance(request.text, "offline", "", today()))
        return self._new(program, request)

    def _written(self, plan: Plan, name: str, request: ProgramRequest, pose: Pose, language: str) -> str:
        wanted = Wanted(
            name, request.text, request.topic, request.uses_sleep, request.rest_s, pose, self._routes()
        )
        source = write_program(plan, self._profile, wanted)
        if isinstance(source, Impossible):
            raise NotWrittenError("refused", render_reason(source.reason, language))
        return source

    def _plan(self, request: ProgramRequest, language: str) -> Plan:
        if request.steps:
            return Plan(request.steps)
        meant = self._interpret(request.body) if request.body else None
        if meant is None or meant.outcome in ("unclear", "stop", "answered"):
            raise NotWrittenError(
                "unclear", say(meant.language if meant is not None else language, "program")
            )
        if meant.plan is None:
            raise NotWrittenError("refused", meant.reply)
        return meant.plan

    # --- with a model ---

    def _by_model(self, request: ProgramRequest, language: str) -> Writing[Draft]:
        assert self.model is not None
        messages = [Message("system", program_prompt(self._profile)), Message("user", request.text)]
        found, messages = yield from self._ask(messages, "unclear", language)
        provenance = Provenance(request.text, "model", self.model.name, today())
        name = self.library.free_name(request.name)
        return self._new(KeptProgram(name, found.source, found.description, provenance), request, messages)

    def may_mend(self, draft: Draft) -> bool:
        """Tell whether a model wrote it, and may write a further version."""
        return draft.by_model and draft.version <= MOST_REPAIRS and self.model is not None

    def mend(self, draft: Draft, problem: Reason, details: str, language: str) -> Writing[Draft]:
        """Write the next version of a model's program.

        Raises:
            NotWrittenError: the model did not answer with one.
        """
        told = mend_prompt(render_reason(problem, "en"), details)
        messages = [*draft.messages, Message("user", told)]
        found, messages = yield from self._ask(messages, "failed", language)
        return draft.next(found.source, check(found.source, self._profile), tuple(messages))

    @staticmethod
    def _ask(
        messages: Sequence[Message], without: Outcome, language: str
    ) -> Writing[tuple[Extracted, list[Message]]]:
        """The program that the model answers, and the conversation with it; `without` is the outcome if it has none."""
        call = yield messages
        if call.is_cancelled:
            raise NotWrittenError("stopped", say(language, "stopped_now"))
        found = extract(call.text)
        problem = call.end.problem if call.end is not None else None
        if problem is not None and (found is None or not found.is_closed):
            raise NotWrittenError(
                "failed", render_reason(problem, language)
            )  # half a program is not run, nor blamed
        if found is None:
            reply = call.text.strip()[:200]
            raise NotWrittenError(without, say(language, "no_program_in_reply", reply=reply))
        return found, [*messages, Message("assistant", call.text)]

    # --- what became of it ---

    def keep(self, draft: Draft) -> None:
        """Keep a new program; one that was kept before is left as it is."""
        if draft.is_new:
            self.library.keep(draft.program)

    def replaces_kept(self, draft: Draft) -> bool:
        """Tell whether a person's edit would take the place of another version that is kept."""
        kept = self.library.find(draft.program.name)
        return draft.asks and kept is not None and kept.source != draft.program.source

    def note_rehearsal(self, draft: Draft, program: ProgramRehearsed, path: Rehearsed) -> None:
        """Keep what the last rehearsal of a kept program showed."""
        self.library.note_rehearsal(
            draft.program.name,
            {
                "date": today(),
                "ok": path.ok,
                "duration_s": round(path.duration_s, 2),
                "length_m": round(path.length_m, 3),
                "top_speed_mps": round(program.top_speed_mps, 3),
                "top_rate_radps": round(program.top_rate_radps, 3),
                "ended": program.ended,
                "findings": [found.reason.to_json() for found in path.findings],
            },
        )

    def note_run(self, draft: Draft, finished: Finished) -> None:
        """Keep how a run of a kept program ended."""
        if finished.path_m or finished.duration_s or finished.outcome == "completed":
            self.library.note_run(
                draft.program.name,
                RunRecord(
                    today(),
                    finished.outcome,
                    round(finished.path_m, 3),
                    round(finished.turned_rad, 4),
                    round(finished.duration_s, 2),
                ),
            )
