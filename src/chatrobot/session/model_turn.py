"""One turn that a model plans: asked, streamed to Motion step by step, shown what it wants to see, asked again.

Nothing that the model says is trusted: Motion rehearses and governs it like any other plan. What it gets wrong goes
back to it with the error, at most twice; rounds, tokens and time are capped. Belongs to the pumping thread, but for
`cancel`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from chatrobot.core.events import (
    Event,
    Finished,
    Interpreted,
    Looked,
    ModelCalled,
    Notice,
    Outcome,
    Rehearsed,
    Said,
    Streamed,
)
from chatrobot.core.reason import Reason
from chatrobot.models.seam import Message, Model
from chatrobot.plan.base import Step
from chatrobot.plan.primitives.say import Say
from chatrobot.plan.steps import count_steps
from chatrobot.plan.text import format_step
from chatrobot.session.model_call import CallEnd, ModelCall
from chatrobot.session.model_reply import ReplyReader
from chatrobot.session.model_terms import Ended, ModelOptions, Surroundings, summed, told
from chatrobot.session.observations import without_pictures
from chatrobot.session.prompt import correction
from chatrobot.session.quoting import one_line
from chatrobot.session.tutorial_mode import is_short_form

if TYPE_CHECKING:
    from chatrobot.session.joint import Joint

MAX_RETRIES = 2
"""A bad reply never causes more further calls than these."""

LOOK_S = 3.0
"""How long Motion may take to say what the lidar sees, and the camera to be found and to show something."""

WORTH_ANOTHER_TRY = frozenset({"model_empty", "model_called_tool"})
"""What a model did, not what became of the call: it may do better when it is told."""

PICTURE_REFUSED = frozenset({"model_rejected", "model_server_error", "model_not_found"})
"""How providers say that a model cannot see: 400, 500 or, with OpenRouter, 404."""

PLAN_REFUSED = frozenset({"lasts_too_long", "plan_too_large", "plan_text"})


class ModelTurn:
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
        joint: Joint,
        surroundings: Surroundings,
        emit: Callable[[Event], None],
        mode: Literal["queue", "replace", "append"],
        *,
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
        self._joint = joint
        self._surroundings = surroundings
        self._emit = emit
        self._mode = mode
        self._approve = approve
        self._frees_form = frees_form
        self._rehearse_only = rehearse_only
        self._only_talks = only_talks
        self.began_s = time.monotonic()
        self._round = self._retries = self._tokens = 0
        self._cancelled: Reason | None = None
        self._call: ModelCall | None = None
        self._look_until_s: float | None = None
        self._looked: Looked | None = None
        self._total: Finished | None = None
        self._all_done: tuple[Step, ...] = ()
        self._done: tuple[Step, ...] = ()
        self._answers: list[str] = []
        self._begin_round()

    # --- from any thread ---

    def cancel(self, why: Reason) -> None:
        """A stop: end the call. What runs in Motion is stopped by the stop itself. Returns at once."""
        self._cancelled = why
        call = self._call
        if call is not None:
            call.cancel()

    # --- the pumping thread ---

    @property
    def is_moving(self) -> bool:
        """A plan of it is with Motion."""
        return self._run_open

    @property
    def silent_s(self) -> float | None:
        """How long the model has been silent since it was asked, None where it has spoken or is not being asked."""
        call = self._call
        if call is None or call.has_spoken or call.has_ended:
            return None
        return time.monotonic() - call.began_s

    @property
    def is_calling(self) -> bool:
        return self._call is not None and not self._call.has_ended

    def wait(self, timeout_s: float) -> None:
        """Until the model says something: where time is simulated, it stands meanwhile."""
        if self._call is not None:
            self._call.wait(timeout_s)

    def replace(self) -> None:
        """Something else is to be done instead; what runs has been told so, or will be, by Motion."""
        why = Reason("replaced")
        if self._run_open and not self._is_closed:
            self._send("", more=False)
        self.cancel(why)
        if not self._run_open:
            self._conclude("stopped", why)

    def pump(self) -> None:
        """Take in what the model has said since."""
        if self.ended is not None:
            return
        if self._cancelled is not None and not self._run_open:
            self._conclude("stopped", self._cancelled)
            return
        for item in self._call.take() if self._call is not None else ():
            if isinstance(item, CallEnd):
                self._end_call(item)
            elif self._listens:
                self._take(self._reader.feed(item))
        self._answer_looks_when_seen()

    def hear(self, event: Event) -> None:
        """An event of this turn."""
        if self.ended is not None:
            return
        if isinstance(event, Rehearsed) and not event.ok:
            self._is_plan_refused = True
            if self._call is not None:
                self._call.cancel()  # what it would say after this counts no more
        elif isinstance(event, Finished):
            self._end_run(event)
        elif isinstance(event, Looked) and self._look_until_s is not None:
            self._looked = event
            self._answer_looks_when_seen()

    # --- a round: one call and the run that comes of it ---

    def _begin_round(self) -> None:
        self._round += 1
        self._reader = ReplyReader()
        self._steps: list[Step] = []
        self._held: list[Step] = []
        self._run_open = self._is_closed = self._is_plan_refused = False
        self._run: Finished | None = None
        self._run_problem: Reason | None = None
        self._call_end: CallEnd | None = None
        self._call = ModelCall(self._model, self._messages, self._options.limits, self._joint.wake)
        if self._cancelled is not None:
            self._call.cancel()

    @property
    def _listens(self) -> bool:
        """What the model says now may still count."""
        return self._cancelled is None and self._run_problem is None and not self._is_plan_refused

    @property
    def _streams(self) -> bool:
        """A model that has been wrong once is read to its end before anything moves."""
        whole = self._approve or self._rehearse_only or self._only_talks or self._retries
        return self._options.streams and not whole

    def _take(self, steps: list[Step]) -> None:
        """Send on what is complete; what is only said waits for the first motion: it may be the whole answer."""
        for step in steps:
            self._steps.append(step)
            self._held.append(step)
            if self._streams and (self._run_open or not isinstance(step, Say)):
                held, self._held = self._held, []
                for each in held:
                    self._emit(Streamed(self.turn, format_step(each)))
                self._send("\n".join(map(format_step, held)), more=True)

    def _send(self, plan_text: str, *, more: bool) -> None:
        if self._cancelled is not None:
            return
        mode = "extend" if self._run_open else self._mode
        if not self._run_open and not plan_text:
            return
        self._run_open = True
        self._is_closed = not more
        self._joint.send(
            "plan",
            self.turn,
            plan_text=plan_text,
            mode=mode,
            more=more,
            approve=self._approve and not (self._frees_form and is_short_form(self._steps)),
            rehearse_only=self._rehearse_only,
        )
        self._mode = "queue"  # what comes later in this turn goes on after it

    def _end_call(self, end: CallEnd) -> None:
        self._call_end = end
        usage = end.usage
        self._tokens += usage.prompt_tokens + usage.reply_tokens
        if self._listens and end.problem is None:
            self._take(self._reader.finish())
        self._emit(
            ModelCalled(
                self.turn, self._model.name, self._round, usage.prompt_tokens, usage.cached_tokens,
                usage.reply_tokens, usage.cost_usd, usage.counted, end.duration_s,
            )
        )  # fmt: skip
        self._forget_what_is_done()
        plan_text = "" if self._only_talks else "\n".join(map(format_step, self._steps))
        if plan_text:
            self._answers.append(plan_text)
            moves = any(not isinstance(step, Say) for step in self._steps)
            reply = self._surroundings.describe(tuple(self._steps)) if moves else ""
            self._emit(Interpreted(self.turn, "model", plan_text, reply))
        elif self._reader.text:
            self._emit(Interpreted(self.turn, "model", "", one_line(self._reader.text)))
        if self._run_open and not self._is_closed:
            self._send("", more=False)
        elif not self._run_open and self._run is None and self._may_run:
            self._send(plan_text, more=False)
        if not self._run_open:
            self._end_round()

    @property
    def _may_run(self) -> bool:
        """A plan that came whole: nothing was wrong with it, and it is more than an answer."""
        return (
            self._problem is None
            and not self._only_talks
            and self._cancelled is None
            and any(not isinstance(step, Say) for step in self._steps)
        )

    @property
    def _problem(self) -> Reason | None:
        """What is wrong with the reply."""
        end = self._call_end
        if end is not None and end.problem is not None:
            return end.problem
        if self._reader.error is not None:
            return Reason("plan_text", {"problem": str(self._reader.error)})
        if not self._steps and not self._reader.looks and not self._done:
            return Reason("model_empty", {"model": self._model.name})
        return None

    # --- what was done before a correction ---

    def _forget_what_is_done(self) -> None:
        """A correction that begins with all that is done already is the whole plan once more: that part is left out."""
        count = len(self._done)
        if count and not self._reader.names_rest and tuple(self._steps[:count]) == self._done:
            del self._steps[:count]

    def _count_done(self) -> tuple[Step, ...]:
        """The top-level steps of this round that were done to their end."""
        left = self._run.steps_done if self._run is not None else 0
        done: list[Step] = []
        for step in self._steps:
            left -= count_steps((step,))
            if left < 0:
                break
            done.append(step)
        return tuple(done)

    # --- how a run and a round end ---

    def _end_run(self, finished: Finished) -> None:
        self._run_open = False
        self._run = finished
        self._total = finished if self._total is None else summed(self._total, finished)
        if finished.outcome != "completed":
            self._run_problem = finished.reason or Reason("stopped")
            if self.is_calling:
                assert self._call is not None
                self._call.cancel()
                return  # the end of the call ends the round
        if not self.is_calling:
            self._end_round()

    def _end_round(self) -> None:
        """The call has ended, and so has its run, if there was one."""
        run = self._run
        self._all_done = (*self._all_done, *self._count_done())
        if self._cancelled is not None:
            why = run.reason if run is not None and run.outcome == "stopped" else None
            self._conclude("stopped", why or self._cancelled)
        elif run is not None and run.outcome in ("stopped", "failed"):
            self._conclude(run.outcome, run.reason)
        elif run is not None and run.outcome == "refused":
            refused = self._run_problem or Reason("not_approved")
            is_the_plans = self._is_plan_refused or refused.code in PLAN_REFUSED
            self._retry("refused", refused) if is_the_plans else self._conclude("refused", refused)
        elif self._only_talks:
            self._end_talk()
        elif (problem := self._problem) is not None:
            self._end_with(problem)
        elif self._reader.looks and not self._rehearse_only:
            self._look()
        elif run is None and self._total is None:
            self._conclude("answered", None)
        else:
            self._say_what_is_held()
            self._conclude("completed", None)

    def _end_talk(self) -> None:
        """It was only to take note of something."""
        end = self._call_end
        if end is not None and end.problem is not None:
            self._conclude("failed", end.problem)
        else:
            self._conclude("answered", None)

    def _end_with(self, problem: Reason) -> None:
        """The reply could not be used, or only up to a line."""
        if problem.code == "plan_text" or problem.code in WORTH_ANOTHER_TRY:
            if problem.code == "model_empty" and self._done:
                self._conclude("completed", None)  # nothing is left to do
            else:
                self._retry("unclear", problem)
        elif problem.code in PICTURE_REFUSED and any(message.picture for message in self._messages):
            self._ask_without_pictures()
        else:
            self._conclude("failed", problem)

    def _ask_without_pictures(self) -> None:
        """It may be the picture that this model cannot take: ask once more in words alone, and show it no other."""
        self._surroundings.give_up_looking()
        self._emit(Notice(self.turn, Reason("model_cannot_see", {"model": self._model.name})))
        self._messages = without_pictures(self._messages)
        self._begin_round()

    def _retry(self, outcome: Outcome, problem: Reason) -> None:
        """Tell the model what was wrong, and where to go on."""
        if self._retries >= MAX_RETRIES or self._spent() is not None:
            self._conclude(outcome, problem)
            return
        self._retries += 1
        self._done = (*self._done, *self._count_done())
        done = [format_step(step) for step in self._done]
        self._emit(Notice(self.turn, Reason("model_corrected", {"try": self._retries, "tries": MAX_RETRIES})))
        words = correction(told(problem), done, self._surroundings.measured(self._total))
        self._go_on(Message("user", words))

    def _look(self) -> None:
        self._say_what_is_held()
        self._look_until_s, self._looked = time.monotonic() + LOOK_S, None
        if "scan" in self._reader.looks:
            self._joint.send("look", self.turn)
        if "camera" in self._reader.looks:
            self._surroundings.begin_looking()
        self._answer_looks_when_seen()

    def _answer_looks_when_seen(self) -> None:
        if self._look_until_s is None:
            return
        looks = self._reader.looks
        waits = ("scan" in looks and self._looked is None) or (
            "camera" in looks and not self._surroundings.has_picture
        )
        if not waits or time.monotonic() > self._look_until_s:
            self._answer_looks(self._looked)

    def _answer_looks(self, looked: Looked | None) -> None:
        self._look_until_s = None
        spent = self._spent() or self._spent_rounds()
        if spent is not None:
            self._conclude("stopped", spent)
            return
        self._done = ()
        looks = self._reader.looks
        at: dict[str, float | int | str] = {
            "what": ", ".join(looks),
            "round": self._round - self._retries + 1,
            "rounds": self._options.rounds,
        }
        self._emit(Notice(self.turn, Reason("model_looks", at)))
        self._go_on(self._surroundings.observation(looks, looked, self._run))

    def _go_on(self, message: Message) -> None:
        seen = without_pictures(self._messages) if message.picture is not None else self._messages
        self._messages = [
            *seen,
            Message("assistant", self._reader.text[:2000] or "# nothing"),
            message,
        ]
        self._begin_round()

    def _say_what_is_held(self) -> None:
        for step in self._held if self._streams else ():
            if isinstance(step, Say):
                self._emit(Said(self.turn, step.text))

    def _spent_rounds(self) -> Reason | None:
        if self._round - self._retries >= self._options.rounds:
            return Reason("model_rounds_used", {"rounds": self._options.rounds})
        return None

    def _spent(self) -> Reason | None:
        """Which of what the person allows is used up."""
        options = self._options
        if self._tokens >= options.budget_tokens:
            return Reason("model_tokens_used", {"tokens": self._tokens, "budget": options.budget_tokens})
        if time.monotonic() - self.began_s >= options.budget_s:
            return Reason("model_time_used", {"budget_s": options.budget_s})
        return None

    def _conclude(self, outcome: Outcome, reason: Reason | None) -> None:
        if self.ended is not None:
            return
        says = "\n".join(step.text for step in self._steps if isinstance(step, Say))
        is_answer = outcome == "answered" and not self._only_talks
        said = says if is_answer else one_line(self._reader.text)
        answer = "\n".join(self._answers) or self._reader.text
        self.ended = Ended(outcome, reason, self._total, self._all_done, answer, said)
