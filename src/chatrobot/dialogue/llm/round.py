"""Keeps one round of a turn that a model plans: one call, what the model said in it, and what became of its run."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from chatrobot.core.events import Finished
from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.call import ModelCall
from chatrobot.dialogue.llm.reply_reader import ReplyReader
from chatrobot.models.seam import CallLimits, Message, Model
from chatrobot.plan.base import Step
from chatrobot.plan.primitives.no_motion import Say
from chatrobot.plan.steps import count_steps
from chatrobot.plan.text import format_step


class ModelRound:
    """Begins the call at once. Belongs to the pumping thread, but for the call's `cancel`.

    Args:
        done: the steps of earlier rounds that this one corrects, and that are not to be done again.
        wake: called when the model has said something.
    """

    def __init__(
        self,
        model: Model,
        messages: Sequence[Message],
        wake: Callable[[], None],
        done: tuple[Step, ...],
    ) -> None:
        self._model_name = model.name
        self._done = done
        self.reader = ReplyReader()
        self.steps: list[Step] = []
        self.run: Finished | None = None
        self.run_problem: Reason | None = None
        """Why its run did not come to its end."""
        self.is_plan_refused = False
        self.call = ModelCall(model, messages, CallLimits(), wake)

    @property
    def is_in_vain(self) -> bool:
        """True once its run is over: what the model says from now on counts no more."""
        return self.run_problem is not None or self.is_plan_refused

    @property
    def moves(self) -> bool:
        """True where it is more than an answer."""
        return any(not isinstance(step, Say) for step in self.steps)

    @property
    def says(self) -> str:
        """Return what it says to the person, a line each."""
        return "\n".join(step.text for step in self.steps if isinstance(step, Say))

    @property
    def plan_text(self) -> str:
        """Return its steps as plan text."""
        return "\n".join(map(format_step, self.steps))

    @property
    def call_problem(self) -> Reason | None:
        """Return what went wrong in the call."""
        return self.call.end.problem if self.call.end is not None else None

    @property
    def problem(self) -> Reason | None:
        """Return what is wrong with the reply."""
        if self.call_problem is not None:
            return self.call_problem
        if self.reader.error is not None:
            return Reason("plan_text", {"problem": str(self.reader.error)})
        if not self.steps and not self.reader.looks and not self._done:
            return Reason("model_empty", {"model": self._model_name})
        return None

    def end_run(self, finished: Finished) -> None:
        """Take in that Motion has ended its run."""
        self.run = finished
        if finished.outcome != "completed":
            self.run_problem = finished.reason or Reason("cause_unknown")

    def forget_what_is_done(self) -> None:
        """Leave out what is done already where a correction begins with all of it: it is the whole plan once more."""
        count = len(self._done)
        if count and not self.reader.names_rest and tuple(self.steps[:count]) == self._done:
            del self.steps[:count]

    def steps_done(self) -> tuple[Step, ...]:
        """Return the top-level steps that were done to their end."""
        left = self.run.steps_done if self.run is not None else 0
        done: list[Step] = []
        for step in self.steps:
            left -= count_steps((step,))
            if left < 0:
                break
            done.append(step)
        return tuple(done)
