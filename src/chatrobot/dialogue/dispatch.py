"""What is done with one text once its turn has come: it is answered, given to Motion, or given to a model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from chatrobot.core.errors import PlanTextError
from chatrobot.core.events import Event, Interpreted, Notice, Paused
from chatrobot.core.reason import Reason
from chatrobot.dialogue.goal_client import GoalClient
from chatrobot.dialogue.llm.thinking import Thinking
from chatrobot.dialogue.parting import parting
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.programs.program_turns import ProgramTurns
from chatrobot.dialogue.proposals import Proposals
from chatrobot.dialogue.replies import describe_waiting
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.said import Said, SaidTexts
from chatrobot.dialogue.turn_book import TurnBook
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import say
from chatrobot.language.resuming import wants_to_resume
from chatrobot.link.joint import Joint
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan


class Dispatch:
    """Belongs to the pumping thread.

    Args:
        programs: None where programs are neither written nor run.
        emit: hears every event.
        stop: stops the robot and drops what was said, for the reason given.
        hears_robot_soon: waits a moment for the first word of odometry; whether it came.
    """

    def __init__(
        self,
        joint: Joint,
        goals: GoalClient,
        said: SaidTexts,
        understanding: Understanding,
        book: TurnBook,
        proposals: Proposals,
        resuming: Resuming,
        thinking: Thinking,
        programs: ProgramTurns | None,
        emit: Callable[[Event], None],
        stop: Callable[[str], None],
        hears_robot_soon: Callable[[], bool],
    ) -> None:
        self._joint = joint
        self._goals = goals
        self._said = said
        self._understanding = understanding
        self._book = book
        self._proposals = proposals
        self._resuming = resuming
        self._thinking = thinking
        self._programs = programs
        self._emit = emit
        self._stop = stop
        self._hears_robot_soon = hears_robot_soon
        self.waits_for_end = 0
        """The turn that is read again once what is under way has ended."""

    def take(self, said: Said) -> None:
        if self._said.is_void(said):
            self._drop(said)
            return
        answer = self._proposals.answered(said)
        if answer is not None:
            self._act_on(said, answer)
        elif said.kind == "resume" or (said.kind == "text" and self._goes_on(said.text)):
            self._go_on(said)
        elif said.kind == "text":
            self._understand(said)
        elif said.kind in ("plan", "edited_plan"):
            self._read_plan(said)
        elif said.kind in ("program", "draft", "source"):
            self._begin_program(said)
        else:
            code = "stopped_now" if said.kind != "emergency_stop" else "emergency_stopped"
            code = code if self._understanding.is_measured else f"{code}_unmeasured"
            reply = self._understanding.say(code, said.text)
            if said.kind == "pause":
                reply = self._told("paused_now", self._resuming.paused)
            self._emit(Interpreted(said.turn, "reflex", "", ""))
            self._book.conclude(said.turn, "stopped", reply)

    def texts_behind(self, turn: int) -> tuple[str, ...]:
        """What is done after that turn, which is paused: what Motion has already, and what waits here."""
        return (*self._book.texts_but(turn), *(said.text for said in self._said.held))

    def _drop(self, said: Said) -> None:
        """End a turn that waited for what was stopped, or paused and not gone on with."""
        why = self._said.why_void(said.turn)
        code = "dropped_behind_pause" if self._said.waited_behind_pause(said.turn) else "dropped_by_stop"
        reply = self._understanding.say_because(code, said.text, why)
        self._book.conclude(said.turn, "stopped", reply, reason=why)

    def _goes_on(self, text: str) -> bool:
        """Whether it asks to go on with what was paused or stopped, be there anything or not."""
        return wants_to_resume(text, may_mean_more=self._resuming.is_about_this or bool(self._said.held))

    def _told(self, code: str, paused: Paused | None) -> str:
        """What is left of a paused plan, or else of what was said and had not begun, in the phrase of that code."""
        held = tuple(said.text for said in self._said.held)
        if paused is None and held:
            language = self._understanding.language
            return say(language, code, plan=describe_waiting(held, language))
        if paused is not None:
            paused = replace(paused, waiting=self.texts_behind(paused.turn))
        return self._resuming.told(paused, code)

    def _go_on(self, said: Said) -> None:
        """Go on with what is paused; what is left of a plan that was stopped is offered."""
        self._understanding.hear_language(said.text)
        paused = self._resuming.take_paused()
        self._goals.is_paused = False
        if paused is None and self._said.held:
            reply = self._told("goes_on", None)
            self._said.release()
            self._emit(Interpreted(said.turn, "offline", "", reply))
            self._book.conclude(said.turn, "answered", reply)
            return
        if paused is None:
            meant = self._resuming.offer()
            reply = self._understanding.say("nothing_paused", said.text)
            self._act_on(said, meant or Interpretation("answered", reply, self._understanding.language))
            return
        reply = self._told("goes_on", paused)  # before what waits is released
        self._goals.resume(paused.turn)
        self._said.release()
        self._emit(Interpreted(paused.turn, "offline", paused.plan_text, ""))
        self._emit(Interpreted(said.turn, "offline", "", reply))
        self._book.conclude(said.turn, "answered", reply)

    def _begin_program(self, said: Said) -> None:
        if self._programs is None:
            self._book.conclude(said.turn, "refused", self._understanding.say("no_programs_here", said.text))
        elif isinstance(said.about, Draft):
            self._programs.run(said.turn, said.text, said.about)
        elif said.kind == "source":
            self._programs.run_edited(said.turn, said.text, said.about)
        else:
            self._programs.begin(said.turn, said.text, is_asked_for=True, name=said.about)

    def _understand(self, said: Said) -> None:
        if self._programs is not None and self._programs.begin(said.turn, said.text):
            return
        meant = self._understanding.interpret(said.text, self._book.under_way)
        is_any_under_way = self._book.is_any_with_motion or self._thinking.is_busy
        if is_any_under_way and meant.is_about_turn_before:
            self._end_turn_before(said)
            return
        if self._runs_programs_again(said, meant):
            return
        if meant.outcome == "plan" and meant.walk is None and wants_to_resume(said.text):
            meant = self._resuming.more(meant, is_under_way=self._book.is_any_with_motion)
        if self._understanding.misses_robot(meant) and self._hears_robot_soon():
            meant = self._understanding.interpret(said.text)
        if parting(meant) is None and self._thinking.wants(said.text, meant):
            self._ask_model(said, meant)
            return
        self._act_on(said, self._thinking.without_model(said.text, meant))

    def _runs_programs_again(self, said: Said, meant: Interpretation) -> bool:
        """Whether `meant` does a program again that was undone: it is run, or refused where it was not alone."""
        entry = self._understanding.undone_programs(meant)
        if entry is None or self._programs is None:
            return False
        if entry.turns == 1:
            self._programs.run_again(said.turn, said.text, entry.programs[0])
        else:
            reply = self._understanding.say("redo_has_program", said.text)
            self._act_on(said, Interpretation("refused", reply, self._understanding.language))
        return True

    def _end_turn_before(self, said: Said) -> None:
        """Stop what is under way, because `said` is about it; read `said` again once that has ended."""
        self._said.put_back(said)
        self.waits_for_end = said.turn
        self._thinking.replace()
        self._joint.send("stop", said.turn - 1, why=said.text[:80])

    def _act_on(self, said: Said, meant: Interpretation) -> None:
        """Do what was understood without a model."""
        paused = self._resuming.paused
        if paused is not None and self._understanding.tells_it_stands(meant):
            meant = replace(meant, reply=self._told("paused_now", paused))
        elif self._understanding.tells_it_moves(meant):
            meant = replace(meant, reply=self._told_under_way(meant) or meant.reply)
        plan_text = format_plan(meant.plan) if meant.plan is not None else ""
        interpreted = Interpreted(said.turn, "offline", plan_text, meant.reply)
        if meant.outcome == "plan":
            # Before it is told: telling takes longer than the way to Motion.
            self._send_plan(said, meant, plan_text)
            self._emit(interpreted)
            return
        self._emit(interpreted)
        if meant.outcome == "stop":
            self._stop(said.text[:80])
            self._book.conclude(said.turn, "stopped", meant.reply)
        else:
            self._understanding.note_unmoved(said.text, meant)
            self._thinking.note(said.text, "", f"{meant.outcome}: {meant.reply}")
            self._book.conclude(said.turn, meant.outcome, meant.reply, None, parting(meant), meant.proposal)

    def _told_under_way(self, meant: Interpretation) -> str:
        """The motion that runs and what is left of it; an empty string where no plan of ours runs."""
        running = self._book.first_with_motion
        if running is None or running[1].meant.plan is None:
            return ""
        steps = running[1].meant.plan.steps
        return self._resuming.under_way.told(running[0], steps, meant.language, self._understanding.speed_mps)

    def _ask_model(self, said: Said, meant: Interpretation) -> None:
        options, mode = self._goals.options, self._goals.mode
        if mode == "replace":
            self._thinking.replace()
        self._thinking.begin(
            said.turn,
            said.text,
            meant,
            mode,
            approve="all" if options.approve else "models" if options.approve_models else "",
            rehearse_only=options.rehearse_only,
        )
        if self._said.is_void_turn(said.turn):
            self._thinking.cancel(self._said.stopped_by)  # a stop came while it was being understood
        if self._said.pauses != self._goals.pauses:
            self._thinking.cancel_unmoved(Reason("paused_by"))

    def _read_plan(self, said: Said) -> None:
        try:
            plan = self._plan_in(said)
        except PlanTextError as error:
            self._emit(Interpreted(said.turn, "offline", "", ""))
            self._book.conclude(
                said.turn, "unclear", self._understanding.say("plan_text", said.text, problem=str(error))
            )
            return
        meant = self._understanding.accept(plan)
        plan_text = format_plan(plan)
        self._emit(Interpreted(said.turn, "offline", plan_text, ""))
        self._send_plan(said, meant, plan_text)

    def _plan_in(self, said: Said) -> Plan:
        """The plan that was said; for an edit that cannot be read the one that it was made of, and a word about it.

        Raises:
            PlanTextError: neither can be read.
        """
        try:
            return parse_plan(said.text)
        except PlanTextError as error:
            if not said.about:
                raise
            before = parse_plan(str(said.about))
            self._emit(Notice(said.turn, Reason("edit_unreadable", {"problem": str(error)})))
            return before

    def _send_plan(self, said: Said, meant: Interpretation, plan_text: str) -> None:
        mode = "append" if meant.append else self._goals.mode
        if mode == "replace":
            self._thinking.replace()
        if mode == "append" and self._resuming.paused is not None:
            self._emit(Notice(said.turn, Reason("waits_behind_pause")))
        self._book.track(said.turn, said.text, meant)
        self._goals.plan(said.turn, plan_text, mode, asks=said.kind == "edited_plan")
