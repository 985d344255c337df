"""Sees one turn through that a model plans: asked, streamed to Motion, shown what it wants to see, asked again.

Nothing that the model says is trusted: Motion rehearses and governs it like any other plan. What it gets wrong goes
back to it with the error, at most twice; rounds, tokens and time are capped. Belongs to the pumping thread, but for
`cancel`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from chatrobot.core.events import Event, Finished, Interpreted, Looked, Notice, Outcome, Rehearsed
from chatrobot.core.reason import Reason, one_line
from chatrobot.dialogue.llm.looking import ObservationWait, Surroundings
from chatrobot.dialogue.llm.plan_stream import PlanStream
from chatrobot.dialogue.llm.prompt import correction, is_short_form
from chatrobot.dialogue.llm.round import ModelRound
from chatrobot.dialogue.llm.terms import Ended, ModelOptions, Spending
from chatrobot.dialogue.observations import measured, without_pictures
from chatrobot.models.seam import Message, Model
from chatrobot.plan.base import Step
from chatrobot.plan.text import format_step
from chatrobot.robots.profile import EXCEEDED

if TYPE_CHECKING:
    from chatrobot.link.motion_link import MotionLink

MAX_RETRIES = 2
"""A bad reply never causes more further calls than these."""

WORTH_ANOTHER_TRY = frozenset({"plan_text", "model_empty", "model_called_tool"})
"""What a model did, not what became of the call: it may do better when it is told."""

PICTURE_REFUSED = frozenset({"model_rejected", "model_server_error", "model_not_found"})
"""How providers say that a model cannot see: 400, 500 or, with OpenRouter, 404."""

PLAN_REFUSED = frozenset({"lasts_too_long", "plan_too_large", "plan_text"})


class ModelRequest:
    """See the module. `pump` and `hear` until `ended` is there.

    Args:
        messages: what the model is told, the person's words last.
        mode: what the first run does to one that is under way.
        approve, rehearse_only: as in `Options`; either means that a plan goes to Motion as a whole.
        frees_form: what stands wholly in the tutorial's form, and is short, needs no approval.
    """

    def __init__(
        self,
        turn: int,
        messages: list[Message],
        model: Model,
        options: ModelOptions,
        link: MotionLink,
        surroundings: Surroundings,
        emit: Callable[[Event], None],
        mode: Literal["queue", "replace", "append"],
        *,
        pauses: Callable[[], int],
        approve: bool = False,
        frees_form: bool = False,
        rehearse_only: bool = False,
        only_talks: bool = False,
    ) -> None:
        self.turn = turn
        self.ended: Ended | None = None
        self._messages = messages
        self._model = model
        self._options = options
        self._link = link
        self._surroundings = surroundings
        self._emit = emit
        self._comes_whole = approve or rehearse_only or only_talks or not options.streams
        self._frees_form = frees_form
        self._rehearse_only = rehearse_only
        self._only_talks = only_talks
        self._spending = Spending(options)
        self._feed = PlanStream(
            turn, link, emit, mode, approve=approve, rehearse_only=rehearse_only, pauses=pauses
        )
        self._cancelled: Reason | None = None
        self._look: ObservationWait | None = None
        self._total: Finished | None = None
        self._all_done: tuple[Step, ...] = ()
        self._done: tuple[Step, ...] = ()
        self._answers: list[str] = []
        self._begin_round()

    # --- from any thread ---

    def cancel(self, why: Reason) -> None:
        """End the call for a stop, which itself stops what runs in Motion. Returns at once."""
        self._cancelled = why
        self._feed.cancel()
        self._round.call.cancel()

    @property
    def asked_at_s(self) -> float | None:
        """Since when the model is being asked (monotonic); None where it is not."""
        return self._round.call.asked_at_s

    # --- the pumping thread ---

    @property
    def began_s(self) -> float:
        """When the model was first asked (monotonic)."""
        return self._spending.began_s

    @property
    def is_moving(self) -> bool:
        """True while a plan of it is with Motion."""
        return self._feed.is_open

    @property
    def silent_s(self) -> float | None:
        """Return how long the model has said nothing since it was asked, None where it has, or is not being asked."""
        call = self._round.call
        return time.monotonic() - call.began_s if not (call.has_ended or call.text) else None

    def wait(self, timeout_s: float) -> None:
        """Wait until the model says something: where time is simulated, it stands meanwhile."""
        self._round.call.wait(timeout_s)

    def replace(self) -> None:
        """Give way to something else; what runs has been told so, or will be, by Motion."""
        why = Reason("replaced")
        self._feed.close()
        self.cancel(why)
        if not self._feed.is_open:
            self._conclude("stopped", why)

    def pump(self) -> None:
        """Take in what the model has said since."""
        if self.ended is not None:
            return
        if self._cancelled is not None and not self._feed.is_open:
            self._conclude("stopped", self._cancelled)
            return
        call = self._round.call
        had_ended = call.has_ended
        for piece in call.take():
            if self._listens:
                self._take(self._round.reader.feed(piece))
        if call.has_ended and not had_ended:
            self._end_call()
        self._end_look()

    def hear(self, event: Event) -> None:
        """Take in an event of this turn."""
        if self.ended is not None:
            return
        if isinstance(event, Rehearsed) and not event.ok:
            self._round.is_plan_refused = True
            self._round.call.cancel()  # what it would say after this counts no more
        elif isinstance(event, Finished):
            self._end_run(event)
        elif isinstance(event, Looked) and self._look is not None:
            self._look.hear(event)
            self._end_look()

    # --- a round: one call and the run that comes of it ---

    def _begin_round(self) -> None:
        self._spending.calls += 1
        # A model that has been wrong once is read to its end before anything moves.
        self._feed.begin(streams=not self._comes_whole and not self._spending.retries)
        self._round = ModelRound(self._model, self._messages, self._link.wake, self._done)
        if self._cancelled is not None:
            self._round.call.cancel()

    @property
    def _listens(self) -> bool:
        """True while what the model says may still count."""
        return self._cancelled is None and not self._round.is_in_vain

    def _take(self, steps: list[Step]) -> None:
        for step in map(self._surroundings.within_limit, steps):
            self._round.steps.append(step)
            self._feed.take(step)

    def _end_call(self) -> None:
        current = self._round
        if self._listens and current.call_problem is None:
            self._take(current.reader.finish())
        self._note_usage()
        current.forget_what_is_done()
        plan_text = "" if self._only_talks else current.plan_text
        if plan_text:
            self._answers.append(plan_text)
            reply = self._surroundings.describe(tuple(current.steps)) if current.moves else ""
            self._emit(Interpreted(self.turn, "model", plan_text, reply))
        elif current.reader.text:
            self._emit(Interpreted(self.turn, "model", "", one_line(current.reader.text)))
        self._feed.close()
        if not self._feed.is_open and current.run is None and self._may_run:
            free = self._frees_form and is_short_form(current.steps)
            self._feed.send_whole(plan_text, unasked=free)
        if not self._feed.is_open:
            self._end_round()

    def _note_usage(self) -> None:
        called = self._round.call.told(self.turn, self._spending.calls)
        self._spending.note(called)
        self._emit(called)

    @property
    def _may_run(self) -> bool:
        """True where nothing is wrong with a plan that came whole, and it is more than an answer."""
        is_wanted = not self._only_talks and self._cancelled is None
        return is_wanted and self._round.problem is None and self._round.moves

    # --- how a run and a round end ---

    def _end_run(self, finished: Finished) -> None:
        self._feed.end()
        self._round.end_run(finished)
        self._total = finished if self._total is None else self._total.followed_by(finished)
        if self._round.call.has_ended:
            self._end_round()
        elif finished.outcome != "completed":
            self._round.call.cancel()  # the end of the call ends the round

    def _end_round(self) -> None:
        """Go on, or end the turn: the call has ended, and so has its run, if there was one."""
        current, run = self._round, self._round.run
        self._all_done = (*self._all_done, *current.steps_done())
        if run is not None and run.outcome in ("stopped", "failed"):
            self._conclude(run.outcome, run.reason)
        elif self._cancelled is not None:
            self._conclude("stopped", self._cancelled)
        elif run is not None and run.outcome == "refused":
            refused = current.run_problem or Reason("cause_unknown")
            is_the_plans = current.is_plan_refused or refused.code in PLAN_REFUSED
            # A shorter plan than the person asked for is no correction.
            may_retry = is_the_plans and refused.code not in EXCEEDED
            self._retry("refused", refused) if may_retry else self._conclude("refused", refused)
        elif self._only_talks:  # it was only to take note of something
            problem = current.call_problem
            self._conclude("answered" if problem is None else "failed", problem)
        elif (problem := current.problem) is not None:
            self._end_with(problem)
        elif current.reader.looks and not self._rehearse_only:
            self._begin_look()
        elif run is None and self._total is None:
            self._conclude("answered", None)
        else:
            self._feed.say_held()
            self._conclude("completed", None)

    def _end_with(self, problem: Reason) -> None:
        """Go on after a reply that could not be used, or only up to a line."""
        if problem.code == "model_empty" and self._done:
            self._conclude("completed", None)  # nothing is left to do
        elif problem.code in WORTH_ANOTHER_TRY:
            self._retry("unclear", problem)
        elif problem.code in PICTURE_REFUSED and any(message.picture for message in self._messages):
            self._ask_without_pictures()
        else:
            self._conclude("failed", problem)

    def _ask_without_pictures(self) -> None:
        """Ask once more in words alone, and show no other picture: it may be what this model cannot take."""
        self._surroundings.give_up_looking()
        self._emit(Notice(self.turn, Reason("model_cannot_see", {"model": self._model.name})))
        self._messages = without_pictures(self._messages)
        self._begin_round()

    def _retry(self, outcome: Outcome, problem: Reason) -> None:
        """Tell the model what was wrong, and where to go on."""
        if self._spending.retries >= MAX_RETRIES or self._spending.used_up() is not None:
            self._conclude(outcome, problem)
            return
        self._spending.retries += 1
        self._done = (*self._done, *self._round.steps_done())
        done = [format_step(step) for step in self._done]
        tries = {"try": self._spending.retries, "tries": MAX_RETRIES}
        self._emit(Notice(self.turn, Reason("model_corrected", tries)))
        driven = measured(self._total) if self._total is not None else "nothing"
        self._go_on(Message("user", correction(problem, done, driven)))

    def _begin_look(self) -> None:
        self._feed.say_held()
        camera = self._surroundings.camera
        self._look = ObservationWait(self._round.reader.looks, self.turn, self._link, camera)
        self._end_look()

    def _end_look(self) -> None:
        """Tell the model what there is to see, once it has been seen."""
        look = self._look
        if look is None or not look.is_over:
            return
        self._look = None
        spent = self._spending.used_up() or self._spending.rounds_used_up()
        if spent is not None:
            self._conclude("stopped", spent)
            return
        self._done = ()
        looks = self._round.reader.looks
        rounds = {"round": self._spending.rounds + 1, "rounds": self._options.rounds}
        self._emit(Notice(self.turn, Reason("model_looks", {"what": ", ".join(looks), **rounds})))
        self._go_on(self._surroundings.observation(looks, look.scan, self._round.run))

    def _go_on(self, message: Message) -> None:
        said = Message("assistant", self._round.reader.text[:2000] or "# nothing")
        earlier = without_pictures(self._messages) if message.picture is not None else self._messages
        self._messages = [*earlier, said, message]
        self._begin_round()

    def _conclude(self, outcome: Outcome, reason: Reason | None) -> None:
        if self.ended is not None:
            return
        if not self._round.call.has_ended:  # it is given up, and has used something, too
            self._round.call.cancel()
            self._note_usage()
        text = self._round.reader.text
        is_answer = outcome == "answered" and not self._only_talks
        said = self._round.says if is_answer else one_line(text)
        answer = "\n".join(self._answers) or text
        self.ended = Ended(outcome, reason, self._total, self._all_done, answer, said)
