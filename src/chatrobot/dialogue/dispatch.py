"""Does with one text what is due once its turn has come: answers it, gives it to Motion, or to a model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from chatrobot.core.errors import PlanTextError
from chatrobot.core.events import Event, Interpreted, Notice, Paused
from chatrobot.core.reason import Reason
from chatrobot.dialogue.amending import Amending
from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.llm.requests import ModelRequests
from chatrobot.dialogue.programs.draft import Draft
from chatrobot.dialogue.programs.requests import ProgramRequests
from chatrobot.dialogue.question import Proposals
from chatrobot.dialogue.replies import AFTER_GOODBYE, describe_waiting, parting, told_at_console
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.utterances import Utterance, UtteranceQueue
from chatrobot.dialogue.while_driving import WhileDriving
from chatrobot.language.interpretation import Interpretation, Placement
from chatrobot.language.phrases import render_reason, say
from chatrobot.language.resuming import goes_on_beside, wants_to_resume
from chatrobot.language.shape_parts import asks_for_rest
from chatrobot.link.envelope import MOST_CHARACTERS, OBSTACLE_RADIUS_M
from chatrobot.link.motion_link import MotionLink
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan


@dataclass(eq=False)
class Dispatch:
    """Acts on utterances. Belongs to the pumping thread.

    Args:
        programs: None where programs are neither written nor run.
        emit: hears every event.
        stop: stops the robot and drops what was said, for the reason given.
        hears_robot_soon: waits a moment for the first word of odometry; whether it came.
    """

    _link: MotionLink
    _goals: GoalClient
    _utterances: UtteranceQueue
    _understanding: Understanding
    _requests: RequestLog
    _proposals: Proposals
    _resuming: Resuming
    _llm: ModelRequests
    _programs: ProgramRequests | None
    _while_driving: WhileDriving
    _amending: Amending
    _emit: Callable[[Event], None]
    _stop: Callable[[str], None]
    _hears_robot_soon: Callable[[], bool]
    waiting_turn: int = field(default=0, init=False)
    """The turn that is read again once what is under way has ended."""

    def take(self, utterance: Utterance) -> None:
        """Act on `utterance`, whose turn has come."""
        if self._utterances.is_void(utterance):
            self._drop(utterance)
            return
        if unread := utterance.why_unreadable:
            reply = self._understanding.say(unread, utterance.text, limit=MOST_CHARACTERS)
            self._act_on(utterance, Interpretation("unclear", reply, self._understanding.language))
            return
        answer = self._proposals.answered(utterance, in_turn=self._goals.options.answers_in_turn)
        if answer is not None:
            self._act_on(utterance, answer)
        elif utterance.kind == "resume" or (utterance.kind == "text" and self._goes_on(utterance.text)):
            self._go_on(utterance)
        elif utterance.kind == "text":
            self._understand(utterance)
        elif utterance.kind in ("plan", "edited_plan"):
            self._read_plan(utterance)
        elif utterance.kind in ("program", "draft", "source"):
            self._begin_program(utterance)
        else:
            self._end_stopped(utterance)

    def _end_stopped(self, utterance: Utterance) -> None:
        """Tell of a stop that was sent when it was said; what the text orders beside it is asked about."""
        code = "stopped_now" if utterance.kind != "emergency_stop" else "emergency_stopped"
        reply = self._understanding.say(self._understanding.stop_code(code), utterance.text)
        asked = Interpretation("stop", "", self._understanding.language)
        if utterance.kind == "pause":
            reply = self._told("paused_now", self._resuming.paused)
        else:
            self._understanding.close_question()
        if utterance.kind == "stop" and not self._utterances.is_void_turn(utterance.turn):
            asked = self._while_driving.behind_stop(utterance.text) or asked
        self._emit(Interpreted(utterance.turn, "reflex", "", asked.reply))
        reply = f"{reply} {asked.reply}".rstrip()
        self._requests.conclude(utterance.turn, "stopped", reply, proposal=asked.proposal)

    def texts_behind(self, turn: int) -> tuple[str, ...]:
        """Return what is done after that turn, which is paused: what Motion has already, and what waits here."""
        return (*self._requests.texts_but(turn), *(utterance.text for utterance in self._utterances.held))

    def _drop(self, utterance: Utterance) -> None:
        """End a turn that came after a goodbye, or waited for what was stopped, or paused and not gone on with."""
        if self._utterances.is_after_end(utterance.turn):
            reply = self._understanding.say(AFTER_GOODBYE, utterance.text)
            self._requests.conclude(utterance.turn, "refused", reply, reason=Reason(AFTER_GOODBYE))
            return
        why = self._utterances.why_void(utterance.turn)
        was_held = self._utterances.waited_behind_pause(utterance.turn)
        code = "dropped_behind_pause" if was_held else "dropped_by_stop"
        reason = render_reason(why, self._understanding.language_of(utterance.text))
        reply = self._understanding.say(code, utterance.text, reason=reason)
        self._requests.conclude(utterance.turn, "stopped", reply, reason=why)

    def _goes_on(self, text: str) -> bool:
        """Whether it asks to go on with what was paused or stopped, be there anything or not."""
        may_mean_more = self._resuming.is_about_this or bool(self._utterances.held)
        return wants_to_resume(text, may_mean_more=may_mean_more)

    def _told(self, code: str, paused: Paused | None) -> str:
        """What is left of a paused plan, or else of what was said and had not begun, in the phrase of that code."""
        held = tuple(utterance.text for utterance in self._utterances.held)
        if paused is None and held:
            language = self._understanding.language
            return say(language, code, plan=describe_waiting(held, language))
        if paused is not None:
            paused = replace(paused, waiting=self.texts_behind(paused.turn))
        return self._resuming.told(paused, code)

    def _go_on(self, utterance: Utterance) -> None:
        """Go on with what is paused; what is left of a plan that was stopped is offered."""
        self._understanding.hear_language(utterance.text)
        if self._goals.options.rehearse_only:
            reply = self._told("paused_now", self._resuming.paused)
            self._emit(Interpreted(utterance.turn, "offline", "", reply))
            self._requests.conclude(utterance.turn, "answered", reply)
            return
        paused = self._resuming.take_paused()
        if paused is None and self._utterances.held:
            reply = self._told("goes_on", None)
            self._utterances.release()
            self._emit(Interpreted(utterance.turn, "offline", "", reply))
            self._requests.conclude(utterance.turn, "answered", reply)
            return
        if paused is None:
            meant = self._resuming.offer() or self._rest_of_shape(utterance.text)
            reply = self._understanding.say("nothing_paused", utterance.text)
            self._act_on(utterance, meant or Interpretation("answered", reply, self._understanding.language))
            return
        reply = self._told("goes_on", paused)  # before what waits is released
        self._goals.resume(paused.turn)
        self._utterances.release()
        self._emit(Interpreted(paused.turn, "offline", paused.plan_text, ""))
        self._emit(Interpreted(utterance.turn, "offline", "", reply))
        self._requests.conclude(utterance.turn, "answered", reply)

    def _rest_of_shape(self, text: str) -> Interpretation | None:
        """What `finish it` means where some sides of a shape were driven; None where none were."""
        meant = (
            self._understanding.interpret(text) if asks_for_rest(text, self._understanding.language) else None
        )
        return meant if meant is not None and meant.plan is not None else None

    def _begin_program(self, utterance: Utterance) -> None:
        if self._programs is None:
            reply = self._understanding.say("no_programs_here", utterance.text)
            self._requests.conclude(utterance.turn, "refused", reply)
        elif isinstance(utterance.about, Draft):
            self._programs.run(utterance.turn, utterance.text, utterance.about)
        elif utterance.kind == "source":
            self._programs.run_edited(utterance.turn, utterance.text, utterance.about)
        else:
            self._programs.begin(utterance.turn, utterance.text, is_asked_for=True, name=utterance.about)

    def _changes_speed(self, utterance: Utterance) -> bool:
        """Whether `utterance` changes the speed of what is under way: then that is done."""
        meant = self._while_driving.answer(utterance.text)
        if meant is None:
            return False
        if meant.outcome == "answered" and self._continues_beside(utterance):
            self._go_on(utterance)
        else:
            self._act_on(utterance, meant)
        return True

    def _continues_beside(self, utterance: Utterance) -> bool:
        """Whether it says to go on with what is paused, and something beside it."""
        return self._resuming.paused is not None and goes_on_beside(utterance.text)

    def _amends(self, utterance: Utterance) -> bool:
        """Whether `utterance` changes what is still to be done: then that is done."""
        amendment = self._amending.of(utterance)
        if amendment is None:
            return False
        if amendment.meant is None:
            self._end_turn_before(utterance)
            return True
        for turn in amendment.cancels:
            self._goals.cancel(turn)
        self._act_on(utterance, amendment.meant, amendment.instead_of)
        return True

    def _understand(self, utterance: Utterance) -> None:
        if self._changes_speed(utterance) or self._amends(utterance):
            return
        if (stop := self._while_driving.stop(utterance.text)) is not None:
            self._act_on(utterance, stop)
            return
        if self._programs is not None and self._programs.begin(utterance.turn, utterance.text):
            return
        if self._continues_beside(utterance):  # Motion keeps what is paused, as it is
            reply = self._told("paused_now", self._resuming.paused)
            self._act_on(utterance, Interpretation("unclear", reply, self._understanding.language))
            return
        meant = self._while_driving.interpret(utterance.text)
        if meant.outcome == "unclear" and (code := told_at_console(utterance.text)):  # no model guesses at it
            reply = self._understanding.say(code, utterance.text, command=utterance.text.split()[0])
            self._act_on(utterance, Interpretation("refused", reply, self._understanding.language))
            return
        is_any_under_way = self._requests.is_any_with_motion or self._llm.is_busy
        if is_any_under_way and (meant.is_about_turn_before or self._while_driving.goes_back(meant)):
            self._end_turn_before(utterance)
            return
        if self._runs_programs_again(utterance, meant):
            return
        if meant.outcome == "plan" and meant.walk is None and wants_to_resume(utterance.text):
            meant = self._resuming.more(meant, is_under_way=self._requests.is_any_with_motion)
        if self._understanding.misses_robot(meant) and self._hears_robot_soon():
            meant = self._understanding.interpret(utterance.text)
        if parting(meant) is None and self._llm.wants(utterance.text, meant):
            self._ask_model(utterance, meant)
            return
        self._act_on(utterance, self._llm.without_model(utterance.text, meant))

    def _runs_programs_again(self, utterance: Utterance, meant: Interpretation) -> bool:
        """Whether `meant` does a program again that was undone: it is run, or refused where it was not alone."""
        entry = self._understanding.undone_programs(meant)
        if entry is None or self._programs is None:
            return False
        if entry.turns == 1:
            self._programs.run_again(utterance.turn, utterance.text, entry.programs[0])
        else:
            reply = self._understanding.say("redo_has_program", utterance.text)
            self._act_on(utterance, Interpretation("refused", reply, self._understanding.language))
        return True

    def _end_turn_before(self, utterance: Utterance) -> None:
        """Stop what is under way, because `utterance` is about it; read `utterance` again once that has ended."""
        self._utterances.put_back(utterance)
        self.waiting_turn = utterance.turn
        self._llm.replace()
        self._link.send("stop", utterance.turn - 1, why=utterance.text[:80])

    def _act_on(self, utterance: Utterance, meant: Interpretation, instead_of: int | None = None) -> None:
        """Do what was understood without a model, in the place of a turn that waits."""
        paused = self._resuming.paused
        if paused is not None and self._understanding.tells_it_stands(meant):
            meant = replace(meant, reply=self._told("paused_now", paused))
        elif self._understanding.tells_it_moves(meant):
            meant = replace(meant, reply=self._while_driving.told(meant.language) or meant.reply)
        elif self._goals.options.rehearse_only and meant.teaches:
            meant = replace(meant, reply=say(meant.language, "only_rehearsed"))
            meant = replace(meant, remember_place="", renamed={}, define={})
        elif paused is None and (meant.outcome == "unclear" or meant.proposal is not None):
            asked, meant = meant, self._while_driving.beside(meant)
            self._proposals.is_left_unasked = asked.proposal is not None and meant.proposal is None
        plan_text = format_plan(meant.plan) if meant.plan is not None else ""
        interpreted = Interpreted(utterance.turn, "offline", plan_text, meant.reply)
        if meant.outcome == "plan":
            if meant.append and self._requests.is_any_with_motion:
                interpreted = replace(interpreted, reply=say(meant.language, "after_that", plan=meant.reply))
            # Before it is told: telling takes longer than the way to Motion.
            self._send_plan(utterance, meant, plan_text, instead_of)
            self._understanding.close_question()
            self._emit(interpreted)
            return
        self._emit(interpreted)
        if meant.outcome == "stop":
            self._stop(utterance.text[:80])
            self._understanding.close_question()
            self._requests.conclude(utterance.turn, "stopped", meant.reply, proposal=meant.proposal)
        else:
            for thing in meant.obstacles:
                self._place(thing)
            self._understanding.note_unmoved(utterance.text, meant)
            self._llm.note(utterance.text, "", f"{meant.outcome}: {meant.reply}")
            reason = parting(meant)
            self._requests.conclude(utterance.turn, meant.outcome, meant.reply, None, reason, meant.proposal)

    def _place(self, thing: Placement) -> None:
        """Put it into the simulation or take it away; Motion's notice says what came of it."""
        if thing.at_m is None:
            self._link.send("obstacle", remove=thing.name)
        else:
            self._link.send("obstacle", add=thing.name, circle=[*thing.at_m, OBSTACLE_RADIUS_M])

    def _ask_model(self, utterance: Utterance, meant: Interpretation) -> None:
        options, mode = self._goals.options, self._goals.mode
        if mode == "replace":
            self._llm.replace()
        self._llm.begin(
            utterance.turn,
            utterance.text,
            meant,
            mode,
            approve="all" if options.approve else "models" if options.approve_models else "",
            rehearse_only=options.rehearse_only,
        )
        if self._utterances.is_void_turn(utterance.turn):
            self._llm.cancel(self._utterances.stopped_by)  # a stop came while it was being understood
        if self._utterances.pauses != self._goals.pauses:
            self._llm.cancel_unmoved(Reason("paused_by"))

    def _read_plan(self, utterance: Utterance) -> None:
        try:
            plan = self._plan_in(utterance)
        except PlanTextError as error:
            reply = self._understanding.say("plan_text", utterance.text, problem=str(error))
            self._emit(Interpreted(utterance.turn, "offline", "", ""))
            self._requests.conclude(utterance.turn, "unclear", reply)
            return
        self._act_on(utterance, self._understanding.accept(plan))

    def _plan_in(self, utterance: Utterance) -> Plan:
        """The plan that was said; for an edit that cannot be read the one that it was made of, and a word about it.

        Raises:
            PlanTextError: neither can be read.
        """
        try:
            return parse_plan(utterance.text)
        except PlanTextError as error:
            if not utterance.about:
                raise
            before = parse_plan(str(utterance.about))
            self._emit(Notice(utterance.turn, Reason("edit_unreadable", {"problem": str(error)})))
            return before

    def _send_plan(
        self, utterance: Utterance, meant: Interpretation, plan_text: str, instead_of: int | None
    ) -> None:
        mode = "append" if meant.append else self._goals.mode
        tries = mode == "replace" and not self._llm.is_busy  # a model's turn has been given up by then
        if mode == "replace":
            self._llm.replace()
        if mode == "append" and self._resuming.paused is not None:
            self._emit(Notice(utterance.turn, Reason("waits_behind_pause")))
        self._requests.track(utterance.turn, utterance.text, meant, instead_of)
        asks = utterance.kind == "edited_plan"
        self._goals.plan(utterance.turn, plan_text, mode, asks=asks, instead_of=instead_of, tries=tries)
